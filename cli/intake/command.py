"""`berth import BAG -o SESSION.mcap`: a ROS 2 bag or a folder of images becomes a session to try the eyes on."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from cli.doing import QUIET, doing
from cli.exit_codes import GOOD, LOSSY
from cli.intake import bag, folder
from cli.intake.session import Intake, write
from runtime.mcap_items import Fault
from runtime.params import ConfigurationError

SOURCE = Annotated[Path, typer.Argument(metavar="BAG", help="ROS 2 bag (MCAP file or its folder), or image folder.")]
OUTPUT = Annotated[Path, typer.Option("-o", "--output", help="Session to write.")]
IMAGE = Annotated[str, typer.Option(help="Topic of the images, if the bag has several.")]
ODOMETRY = Annotated[str, typer.Option(help="Topic of the odometry, if the bag has several.")]
HZ = Annotated[float, typer.Option(help="Rate of the images of a folder.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]


def intake(
    source: SOURCE,
    output: OUTPUT,
    image: IMAGE = "",
    odometry: ODOMETRY = "",
    hz: HZ = 8.0,
    quiet: QUIET = False,
    as_json: JSON = False,
) -> None:
    """Make a session of a ROS 2 bag or a folder of images; exit code 3 if something had to be left out.

    Example: berth import bag.mcap -o session.mcap
    berth replay session.mcap --component vision -o seen.mcap
    """
    if not 0.01 <= hz <= 1000.0:
        raise ConfigurationError(f"--hz must be between 0.01 and 1000; got {hz}")
    faults: list[Fault] = []
    with doing(f"reading {source}", quiet=quiet or as_json):
        made = _made(source, output, image, odometry, hz, faults)
    table = _table(made, output, faults)
    text = json.dumps(table) if as_json else "\n".join(f"{name:12} {value}" for name, value in table.items())
    sys.stdout.write(text + "\n")
    raise typer.Exit(LOSSY if made.skipped or faults else GOOD)


def _made(source: Path, output: Path, image: str, odometry: str, hz: float, faults: list[Fault]) -> Intake:
    """The session; what is wrong with the bag is appended to `faults`."""
    if source.is_dir() and not bag.files_of(source):
        return write(folder.read(folder.images(source), hz), output, source)
    if source.suffix == ".db3":
        raise ConfigurationError(f"{source}: must be a bag in MCAP; see `ros2 bag convert`")
    files = bag.files_of(source)
    topics = bag.chosen(bag.topics_of(files), image, odometry, source)
    return write(bag.read(files, topics, faults), output, source)


def _table(made: Intake, output: Path, faults: list[Fault]) -> dict[str, object]:
    return {
        "session": str(output),
        "images": made.images,
        "size_px": f"{made.size[0]}x{made.size[1]}",
        "odometry": made.poses,
        "session_s": round(made.session_s, 3),
        "skipped": dict(made.skipped.most_common(20)),
        "faults": [f"byte {fault.offset}: {fault.words}" for fault in faults[:5]],
    }
