"""`berth recover FILE`: mend a torn recording."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import typer

from cli.doing import QUIET, doing
from cli.exit_codes import GOOD, LOSSY
from runtime.mend import Mended, mend
from runtime.recording import Recording

FILE = Annotated[Path, typer.Argument(help="Recording (MCAP), torn or damaged.")]
OUTPUT = Annotated[Path | None, typer.Option("-o", "--output", help="File to make; default: FILE-recovered.mcap.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]


def recover(file: FILE, output: OUTPUT = None, quiet: QUIET = False, as_json: JSON = False) -> None:
    """Mend a recording; what can be read goes into a new, finished file; exit code 3 if something is lost.

    Example: berth recover recordings/torn.mcap.
    """
    target = output or file.with_name(f"{file.stem}-recovered.mcap")
    with doing(f"reading {file}", quiet=quiet or as_json):
        mended = mend(Recording(file), target)
    if as_json:
        sys.stdout.write(json.dumps(_table(mended, target)) + "\n")
    else:
        sys.stdout.write("".join(f"{line}\n" for line in _lines(mended, target)))
    raise typer.Exit(LOSSY if mended.is_lossy else GOOD)


def _table(mended: Mended, target: Path) -> dict[str, object]:
    return {
        "output": str(target),
        "messages": mended.messages,
        "until_s": mended.until_ns / 1e9,
        "faults": [fault._asdict() for fault in mended.faults],
        "lost": mended.lost,
    }


def _lines(mended: Mended, target: Path) -> Iterator[str]:
    yield f"{target}: {mended.messages} messages, until {mended.until_ns / 1e9:.3f} s"
    for fault in mended.faults:
        yield f"lost at byte {fault.offset}: {fault.words}"
    for topic, count in mended.lost.items():
        yield f"lost: {count} of {topic}"
    if not mended.is_lossy:
        yield "nothing is lost"
