"""`berth calibrate colour`: the eyes learn the object's colour, and the stripe's, by being pointed at them."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Annotated, Any

import cv2
import numpy as np
import typer
from numpy.typing import NDArray

from cli.correction import Correction, lines, write
from cli.inspection import of_run
from cli.inspection_report import load_table
from cli.intake.picture import BYTES_MAX, PictureError, as_jpeg
from components.vision import jpeg, pointing
from components.vision.core import Eyes, Sight
from components.vision.params import Params
from components.vision.pointing import Colour, Region, UnclearError
from runtime.launch import load
from runtime.params import ConfigurationError
from runtime.recording import Recording

Image = NDArray[np.uint8]

SOURCE = Annotated[Path, typer.Argument(metavar="FRAME", help="Picture (JPEG, PNG) or recording (.mcap).")]
THING = Annotated[
    str, typer.Option("--object", metavar="U,V[,W,H]", help="Point at the object: column,row from the upper left.")
]
STRIPE = Annotated[
    str, typer.Option("--table", metavar="U,V[,W,H]", help="Point at the stripe on the table's edge, if there is one.")
]
AT = Annotated[float, typer.Option("--at", help="Session second of the frame in a recording.")]
OUTPUT = Annotated[Path | None, typer.Option("-o", "--output", help="Picture to write: the frame and what is seen.")]
LAUNCH = Annotated[Path | None, typer.Option("--launch", help="Launch file that the colours are for.")]
WRITE = Annotated[bool, typer.Option("--write", help="Put the colours into the launch file.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]
_SCHEMA = "foxglove.CompressedImage"
_REGION = re.compile(r"\d{1,5},\d{1,5}(,\d{1,5},\d{1,5})?")

calibrate = typer.Typer(
    help="Let the eyes learn from what they see.", no_args_is_help=True, rich_markup_mode=None, add_completion=False
)


@calibrate.callback()
def _calibrate() -> None:
    """One verb alone would not be named."""


@calibrate.command("colour")
def colour(
    source: SOURCE,
    thing: THING = "",
    stripe: STRIPE = "",
    at_s: AT = 0.0,
    output: OUTPUT = None,
    launch: LAUNCH = None,
    into_launch: WRITE = False,
    as_json: JSON = False,
) -> None:
    """Learn the colours from one frame, best under a lamp of some 4000 K; no --object, only -o: write the frame.

    Example: berth calibrate colour frame.jpg --object 160,120 --table 80,170 --launch launch/sim.toml --write.
    """
    _check_options(thing, stripe, output, launch, at_s, into_launch=into_launch)
    image = _frame(source, at_s)
    if not thing:
        _draw(output, image, None)
        return
    learned = _learned(image, thing, stripe)
    changes = _changes(launch, learned)
    sight = Eyes(_params(image, learned)).look(image)
    _draw(output, image, sight)
    _print(launch, learned, changes, sight, as_json=as_json)
    if into_launch and launch is not None:
        write(launch, changes)
    raise typer.Exit(0 if sight.spot is not None else 1)


def _check_options(
    thing: str, stripe: str, output: Path | None, launch: Path | None, at_s: float, *, into_launch: bool
) -> None:
    if not thing and (stripe or output is None):
        raise ConfigurationError("--object must be given; without it -o writes the frame to point into")
    if into_launch and launch is None:
        raise ConfigurationError("--write must stand with --launch")
    if not 0.0 <= at_s < 1e9:
        raise ConfigurationError(f"--at must be >= 0 and finite; got {at_s}")


def _frame(source: Path, at_s: float) -> Image:
    if source.suffix == ".mcap":
        data = _recorded(source, at_s)
    else:
        try:
            if source.stat().st_size > BYTES_MAX:
                raise ConfigurationError(f"{source}: must be a picture of at most {BYTES_MAX} bytes")
            data = source.read_bytes()
        except OSError as error:
            raise ConfigurationError(f"{source}: can not be read: {error.strerror}") from None
    try:
        size, data = as_jpeg(data)
        return jpeg.decode(data, *size)
    except (PictureError, jpeg.JpegError) as error:
        raise ConfigurationError(f"{source}: must be a picture that the eyes can take: {error}") from None


def _recorded(file: Path, at_s: float) -> bytes:
    for row in Recording(file).messages():
        if row.schema == _SCHEMA and row.capture_ns >= round(at_s * 1e9):
            message = row.decoded()
            if message is not None:
                return bytes(message.data)
    raise ConfigurationError(f"{file}: must hold an image at second {at_s:g} or later; there is none")


def _learned(image: Image, thing: str, stripe: str) -> dict[str, Colour]:
    learned = {"object_colour": _pointed(image, thing, "--object")}
    if stripe:
        learned["table_colour"] = _pointed(image, stripe, "--table")
        try:
            pointing.check_apart(learned["object_colour"], learned["table_colour"])
        except UnclearError as error:
            raise ConfigurationError(f"--table {stripe}: {error}") from None
    return learned


def _pointed(image: Image, where: str, option: str) -> Colour:
    if not _REGION.fullmatch(where):
        raise ConfigurationError(f"{option} must be U,V or U,V,WIDTH,HEIGHT in whole pixels; got {where[:40]!r}")
    numbers = [int(word) for word in where.split(",")]
    region = Region(*numbers) if len(numbers) == 4 else pointing.around(numbers[0], numbers[1], image.shape[1])
    try:
        return pointing.colour(image, region)
    except UnclearError as error:
        raise ConfigurationError(f"{option} {where}: {error}") from None


def _params(image: Image, learned: dict[str, Colour]) -> Params:
    height, width, _ = image.shape
    edge = "stripe" if "table_colour" in learned else "hough"
    return Params(width_px=width, height_px=height, edge=edge, **learned)  # type: ignore[arg-type]


def _changes(launch: Path | None, learned: dict[str, Colour]) -> list[Correction]:
    if launch is None:
        return []
    spec = of_run(load(launch), "components.vision")
    if spec is None:
        raise ConfigurationError(f"{launch}: must have a component that runs components.vision")
    return [Correction(spec.name, name, list(value)) for name, value in learned.items()]


def _draw(output: Path | None, image: Image, sight: Sight | None) -> None:
    """The frame, with a cross on the object and a line on the edge."""
    if output is None:
        return
    drawn = image.copy()
    height, width, _ = image.shape
    middle, half = 0.5 * (width - 1), 0.5 * (height - 1)
    if sight is not None and sight.spot is not None:
        at = (round(middle + sight.spot.u_px), round(half + sight.spot.v_px))
        cv2.drawMarker(drawn, at, (255, 0, 255), cv2.MARKER_CROSS, 20, 2)
    if sight is not None and sight.border is not None:
        column = sight.spot.u_px if sight.spot is not None else 0.0
        rows = [half + sight.border.v_px + sight.border.slope * (u - column) for u in (-middle, middle)]
        ends = [(column, round(min(max(row, -1e4), 1e4))) for column, row in zip((0, width - 1), rows, strict=True)]
        cv2.line(drawn, ends[0], ends[1], (255, 0, 255), 1)
    done, data = cv2.imencode(".png", drawn)
    try:
        if done:
            output.write_bytes(data.tobytes())
    except OSError as error:
        raise ConfigurationError(f"-o {output}: can not be written: {error.strerror}") from None


def _print(
    launch: Path | None, learned: dict[str, Colour], changes: list[Correction], sight: Sight, *, as_json: bool
) -> None:
    if as_json:
        table: dict[str, Any] = {
            **{name: list(value) for name, value in learned.items()},
            "object": sight.spot and sight.spot._asdict(),
            "edge": sight.border and sight.border._asdict(),
        }
        sys.stdout.write(json.dumps(table) + "\n")
        return
    shown = "is not found again" if sight.spot is None else f"is found, {sight.spot.pixels} px"
    sys.stdout.write(f"with these colours the object {shown}, the edge {'is' if sight.border else 'is not'}\n")
    if launch is not None:
        sys.stdout.write(f"{launch} should say:\n\n{lines(load_table(launch), changes)}\n")
    else:
        sys.stdout.write("".join(f"--set 'vision.{name}={list(value)}'\n" for name, value in learned.items()))
