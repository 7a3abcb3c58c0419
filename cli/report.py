"""`berth report FILE` or `berth report A B`: one HTML page about a session, or about two."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.doing import QUIET, doing
from runtime.params import ConfigurationError

if TYPE_CHECKING:
    from report.comparison import Comparison
    from report.session import Session

FILES = Annotated[list[Path], typer.Argument(help="Recording (MCAP), or two to compare.", metavar="FILE [OTHER]")]
OUTPUT = Annotated[Path | None, typer.Option("-o", "--output", help="Page to write; default: beside the recording.")]
POSTER = Annotated[Path | None, typer.Option(help="Also draw one picture of the session: a PNG to write.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]


def report(
    files: FILES, output: OUTPUT = None, poster: POSTER = None, quiet: QUIET = False, as_json: JSON = False
) -> None:
    """Write a page: did it learn, does it dock, what went wrong. Example: berth report recordings/sim.mcap."""
    if len(files) > 2 or (len(files) == 2 and poster is not None):
        raise ConfigurationError("berth report: must have one recording, or two and no --poster")
    with doing(f"reading {' and '.join(map(str, files))}", quiet=quiet or as_json):
        if len(files) == 1:
            page, found = write_report(files[0], output, poster)
        else:
            page, found = write_versus(files[0], files[1], output)
    text = json.dumps({"report": str(page), **found}) if as_json else str(page)
    sys.stdout.write(text + "\n")


def write_report(file: Path, output: Path | None = None, poster: Path | None = None) -> tuple[Path, dict[str, Any]]:
    """Read the session and write its page; numba is imported only here, matplotlib only for a poster.

    Raises:
        ConfigurationError: the file is no session of ours, or the page can not be written.
    """
    from report.page import numbers, write  # noqa: PLC0415

    page = output or file.with_suffix(".html")
    session, comparison = _read(file)
    if poster is not None and comparison is None:
        raise ConfigurationError(f"{file}: must hold a policy to draw a poster of")
    try:
        write(session, page, comparison)
        if poster is not None and comparison is not None:
            from report.poster import write as write_poster  # noqa: PLC0415

            write_poster(session, comparison, poster)
    except OSError as error:
        raise _unwritable(error, page) from None
    return page, dict(numbers(session))


def write_versus(first: Path, second: Path, output: Path | None = None) -> tuple[Path, dict[str, Any]]:
    """Read two sessions and write the page that compares them.

    Raises:
        ConfigurationError: as `write_report`.
    """
    from report.versus import Side, numbers, write  # noqa: PLC0415

    page = output or first.with_name(f"{first.stem}-against-{second.stem}.html")
    sides = Side(*_read(first)), Side(*_read(second))
    try:
        write(sides, page)
    except OSError as error:
        raise _unwritable(error, page) from None
    return page, numbers(sides)


def _read(file: Path) -> tuple[Session, Comparison | None]:
    from report.comparison import compare  # noqa: PLC0415
    from report.session import read  # noqa: PLC0415
    from runtime.recorded_launch import number_of  # noqa: PLC0415

    session = read(file)
    if not session.policies:
        return session, None
    height_m = number_of(session.launch, "camera_up_m", 0.45)
    return session, compare(session.policies, session.launch.get("task", {}), height_m)


def _unwritable(error: OSError, page: Path) -> ConfigurationError:
    return ConfigurationError(f"{error.filename or page}: can not be written: {error.strerror}")
