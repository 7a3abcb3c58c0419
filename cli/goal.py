"""`berth goal teach`: show the pick-up pose once; where the object is seen there becomes the goal, a task file."""

from __future__ import annotations

import json
import os
import sys
import tempfile
from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from threading import Event
from typing import Annotated

import typer

from cli.doing import QUIET, doing
from cli.keys import pressed
from cli.session import now, recording_name
from cli.sight import Eye, Frame, eye_of, eye_started, loaded_eyes, recorded_frames, recorded_task, task_of
from docking.angles import DEG
from docking.showing import FEWEST_FRAMES, NotShownError, Showing
from docking.task import Task
from docking.task_file import FIELDS, offset_lines, showing_lines, task_text
from runtime.launch import load
from runtime.params import ConfigurationError
from runtime.recording import Recording
from runtime.runfile import find

LAUNCH = Annotated[
    Path | None, typer.Argument(help="Launch file: only what sees is started. None: a system that runs already.")
]
FROM = Annotated[Path | None, typer.Option("--from", help="Recording in which the robot stands in the pick-up pose.")]
AT = Annotated[float | None, typer.Option("--at", help="Session second to begin at; default: the recording's end.")]
OUTPUT = Annotated[Path, typer.Option("-o", "--output", help="Task file to write.")]
FRAMES = Annotated[int, typer.Option(help="Frames to average.", min=FEWEST_FRAMES)]
HEADING = Annotated[
    float | None,
    typer.Option("--heading-deg", help="The robot's heading there, left positive; 0 = square to the table."),
]
NOW = Annotated[bool, typer.Option("--now", help="The robot stands there already: wait for no key.")]
REALM = Annotated[str, typer.Option(help="Which running system, if there is more than one.")]
SET = Annotated[list[str] | None, typer.Option("--set", help="As for `berth run`.")]
NO_RECORD = Annotated[bool, typer.Option("--no-record", help="Record nothing of what is shown.")]
JSON = Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")]

goal = typer.Typer(
    help="Show the pose in which the object can be picked up.",
    no_args_is_help=True,
    rich_markup_mode=None,
    add_completion=False,
)


@goal.callback()
def _goal() -> None:
    """One verb alone would not be named."""


@dataclass(frozen=True)
class _Shown:
    """Frames of a robot in the pick-up pose."""

    frames: Sequence[Frame]
    base: Task
    """Of the system that saw them."""
    source: str
    """Where they come from, in words."""

    @property
    def at_s(self) -> float:
        """Session time of the first."""
        return self.frames[0].capture_ns / 1e9 if self.frames else 0.0


@dataclass(frozen=True)
class _Wish:
    """What is asked of who looks."""

    count: int
    """Frames."""
    at_once: bool
    """Without waiting for a key."""
    quiet: bool


@goal.command()
def teach(
    launch: LAUNCH = None,
    recording: FROM = None,
    at_s: AT = None,
    output: OUTPUT = Path("goal.toml"),
    frames: FRAMES = 40,
    heading_deg: HEADING = None,
    at_once: NOW = False,
    realm: REALM = "",
    overrides: SET = None,
    no_record: NO_RECORD = False,
    quiet: QUIET = False,
    as_json: JSON = False,
) -> None:
    """Put robot and object into the pick-up pose and press a key; the goal is written to a task file.

    Example: berth goal teach launch/sim.toml -o goal.toml
    berth run launch/sim.toml --set pilot.task=goal.toml
    """
    _check_options(launch, recording, at_s, realm, overrides)
    if output.exists():
        raise ConfigurationError(f"-o {output}: must not exist yet")
    try:
        if recording is not None:
            shown = _recorded(recording, at_s, frames)
        elif launch is not None:
            file = None if no_record else recording_name(Path("goal"), now())
            shown = _started(launch, overrides or [], file, _Wish(frames, at_once, quiet or as_json))
        else:
            shown = _watched(realm, _Wish(frames, at_once, quiet or as_json))
        showing = Showing.of([frame.percept for frame in shown.frames])
        task = showing.task(shown.base, None if heading_deg is None else heading_deg * DEG)
    except (NotShownError, KeyboardInterrupt) as reason:
        raise ConfigurationError(f"no goal: {str(reason) or 'interrupted'}") from None
    source = f"from {shown.source}, session second {shown.at_s:.9f} on"
    _write(output, task_text(task, showing, [f"Taught {now().isoformat(timespec='seconds')}", source]))
    _print(output, shown, showing, task, as_json=as_json)


def _check_options(
    launch: Path | None, recording: Path | None, at_s: float | None, realm: str, overrides: list[str] | None
) -> None:
    if recording is not None and (launch is not None or realm):
        raise ConfigurationError("--from must stand alone: a recording needs no launch file and no running system")
    if recording is None and at_s is not None:
        raise ConfigurationError("--at must stand with --from")
    if at_s is not None and not 0.0 <= at_s < 1e9:
        raise ConfigurationError(f"--at must be >= 0 and finite; got {at_s}")
    if overrides and launch is None:
        raise ConfigurationError("--set must stand with a launch file")


def _recorded(file: Path, at_s: float | None, count: int) -> _Shown:
    recording = Recording(file)
    return _Shown(recorded_frames(recording, at_s, count), recorded_task(recording), str(file))


def _started(launch: Path, overrides: list[str], file: Path | None, wish: _Wish) -> _Shown:
    system = loaded_eyes(launch, overrides, file)
    frames = _collect(eye_started(system), wish)
    return _Shown(frames, task_of(system), str(file or launch))


def _watched(realm: str, wish: _Wish) -> _Shown:
    run = find(realm)
    return _Shown(_collect(eye_of(run), wish), task_of(load(run.launch)), run.realm)


def _collect(opened: AbstractContextManager[Eye], wish: _Wish) -> list[Frame]:
    came = Event()
    with pressed(lambda _: came.set()) as terminal:
        if not (terminal or wish.at_once):
            raise ConfigurationError("a key must be pressed on a terminal; without one use --now")
        with opened as eye:
            if not wish.at_once:
                sys.stderr.write("Put robot and object into the pick-up pose, then press any key.\n")
                eye.wait(came.is_set)
            with doing("looking at the object", quiet=wish.quiet):
                return eye.frames(wish.count)


def _write(file: Path, text: str) -> None:
    """All of it or nothing."""
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile("w", encoding="utf-8", dir=file.parent, delete=False) as draft:
            draft.write(text)
            draft.flush()
            os.fsync(draft.fileno())
        Path(draft.name).chmod(0o644)
        Path(draft.name).replace(file)
    except OSError as error:
        raise ConfigurationError(f"-o {file}: can not be written: {error.strerror}") from None


def _print(output: Path, shown: _Shown, showing: Showing, task: Task, *, as_json: bool) -> None:
    if as_json:
        table = {
            "file": str(output),
            "from": shown.source,
            "at_s": shown.at_s,
            "mean": showing.mean._asdict(),
            "spread": showing.spread._asdict(),
            "seen": showing.seen,
            "frames": showing.frames,
            "task": {name: getattr(task, name) for name in FIELDS},
            "camera": {"left_of_axis_per_height": task.offset.left, "yaw_rad": task.offset.yaw_rad},
        }
        sys.stdout.write(json.dumps(table) + "\n")
        return
    lines = [*showing_lines(showing), *offset_lines(task), f"written to {output}, seen in {shown.source}"]
    sys.stdout.write("".join(f"{line}\n" for line in lines))
