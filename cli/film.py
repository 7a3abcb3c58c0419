"""`berth film FILE`: a session in 24 seconds."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from cli.doing import QUIET, doing
from runtime.params import ConfigurationError

FILE = Annotated[Path, typer.Argument(help="Recording (MCAP) of a session that learned, in simulation.")]
OUTPUT = Annotated[Path | None, typer.Option("-o", "--output", help="Film to write; default: FILE.webp.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]
POLICIES = 40
"""Points of the learning curve."""


def film(file: FILE, output: OUTPUT = None, quiet: QUIET = False, as_json: JSON = False) -> None:
    """Make a short film of a session; an animated WebP, which any browser shows.

    Example: berth film recordings/sim.mcap -o learning.webp
    """
    from report.reel import read  # noqa: PLC0415  (numpy: not for --help)

    target = output or file.with_suffix(".webp")
    reel = read(file)
    if not reel.policies:
        raise ConfigurationError(f"{file}: must hold a policy to make a film of")
    from report import film as drawing  # noqa: PLC0415  (matplotlib, numba)
    from report.comparison import compare  # noqa: PLC0415
    from report.screenplay import cues  # noqa: PLC0415

    some = reel.policies[:: -(-len(reel.policies) // POLICIES)]
    script = cues(reel)
    with doing(f"drawing {target}", quiet=quiet or as_json) as told:
        comparison = compare([*some[:-1], reel.policies[-1]], reel.launch.get("task", {}))
        try:
            drawing.film(reel, comparison, script, target, told)
        except OSError as error:
            raise ConfigurationError(f"-o {target}: can not be written: {error.strerror or error}") from None
    table = {"film": str(target), "pictures": len(script), "bytes": target.stat().st_size}
    sys.stdout.write(json.dumps(table) + "\n" if as_json else f"{target}\n")
