"""The cable is pulled while the robot moves: what the robot drives by itself goes on, what the laptop drives stops."""

import json
import time
from collections.abc import Iterator
from typing import NamedTuple

import pytest

from benchmarks.halves import APPROACH, FRAME_NS, LAUNCH, Echo, Halves, awaits_run_file, echoed, start
from benchmarks.watched import START_S, wait_until
from runtime.recording import Logged, Recording
from tests.machines import Cable, Machine, two_machines
from tests.runtime.parts.commander.component import SPEED_MPS

pytestmark = pytest.mark.xdist_group("live")
WITH_COMMANDER = (
    LAUNCH.replace('device = "simulator/base" }', 'device = "simulator/base", teleop = "commander/drive" }')
    + """
[component.commander]
run = "tests.runtime.parts.commander"
host = "laptop"
inputs = { base = "base/state", trial = "pilot/trial" }
"""
)
SETTINGS = (
    "pilot.train_s=0",
    "pilot.evaluation_controller=lc",
    # Straight ahead and near, so that the docking takes ten seconds.
    "simulator.starts=full",
    "pilot.first_start=734",
)
BRAKE_NS = 300_000_000
"""`max_age_s` of base."""
BUSY_NS = 150_000_000
"""A test machine may be busy: base's tick comes late."""
OLD_NS = 1_000_000_000
"""What waited for the link is older; what a busy recorder took late is not."""
TRIAL_S = 90.0
DRIVEN_FRAMES, AWAY_FRAMES = 12, 16


class Story(NamedTuple):
    """A session with two cuts; times of the session, on the robot."""

    robot: Recording
    docked: dict[str, object]
    """The trial of the first cut, when it had ended."""
    first: tuple[int, int]
    """Frames between which the cable was out while the pilot drove."""
    cut_ns: int
    """When the cable was pulled while the laptop drove."""
    mended_ns: int


def session_ns(robot: Machine) -> int:
    """Session time of the robot, now."""
    (file,) = robot.home.glob("berth/logs/*/session.json")
    return time.monotonic_ns() - int(json.loads(file.read_text(encoding="utf-8"))["origin_ns"])


@pytest.fixture(scope="module")
def story(tmp_path_factory) -> Iterator[Story]:
    directory = tmp_path_factory.mktemp("cut")
    with two_machines(directory) as cable:
        words = [word for setting in SETTINGS for word in ("--set", setting)]
        halves = start(cable, directory, *words, launch=WITH_COMMANDER, record=False)
        awaits_run_file(cable.robot)
        recorder = cable.robot.berth("record", "-o", str(directory / "robot.mcap"))
        trials = echoed(cable.robot, "pilot/trial", directory / "trials.jsonl")
        applied = echoed(cable.robot, "base/applied", directory / "applied.jsonl")
        with trials as trial, applied as command:
            docked, first, cut_ns, mended_ns = tell(cable, halves, trial, command)
            recorder.wait(30)  # it ends with the session
            yield Story(Recording(directory / "robot.mcap"), docked, first, cut_ns, mended_ns)


def tell(
    cable: Cable, halves: Halves, trial: Echo, command: Echo
) -> tuple[dict[str, object], tuple[int, int], int, int]:
    """All of a story but its recording."""

    def happens(condition, seconds: float) -> None:
        assert wait_until(lambda: condition() or not halves.alive(), seconds), (trial.last(), command.last())
        assert halves.alive(), [half.communicate() for half in halves if half.poll() is not None]

    happens(lambda: trial.last().get("mode") == APPROACH and "laptop is there" in said(cable.robot), START_S)
    first = trial.last()["frame"]
    cable.cut()
    happens(lambda: trial.last()["ended"] == 1, TRIAL_S)
    docked = trial.last()
    cable.mend()
    happens(lambda: command.last()["commander"] == "teleop", 30.0)
    driven = command.last()["frame"]
    happens(lambda: command.last()["frame"] >= driven + DRIVEN_FRAMES, 30.0)
    cut_ns = session_ns(cable.robot)
    cable.cut()
    away = trial.last()["frame"]
    happens(lambda: trial.last()["frame"] >= away + AWAY_FRAMES, 30.0)
    mended_ns = session_ns(cable.robot)
    cable.mend()
    happens(lambda: drives_in_frame(command.last()) > away + AWAY_FRAMES, 30.0)
    halves.interrupt()
    halves.outputs()
    return docked, (first, docked["frame"]), cut_ns, mended_ns


def drives_in_frame(applied: dict[str, object]) -> int:
    """The frame in which the laptop moved the robot; -1 if it did not."""
    return int(str(applied["frame"])) if applied["commander"] == "teleop" and applied["v_mps"] else -1


def said(robot: Machine) -> list[str]:
    return [line.partition(" ")[2] for line in robot.words()]


def applied(story: Story) -> list[Logged]:
    """What base carried out, in the order of its arrival at the robot's recorder."""
    return sorted(story.robot.messages({"base/applied"}), key=lambda message: message.time_ns)


def moves(message: Logged) -> bool:
    command = message.decoded()
    return command.v_mps != 0.0 or command.omega_radps != 0.0


def test_the_docking_that_the_pilot_had_begun_is_completed_without_the_link(story):
    assert story.docked["outcome"] == "PICKED"
    first, last = story.first
    alone = {m.decoded().commander for m in applied(story) if first < m.capture_ns / FRAME_NS < last}
    assert {"pilot", "grasper"} <= alone
    assert "gone" not in alone


def test_the_robot_brakes_in_time_when_the_laptop_drove_it(story):
    """By base's own clock: it stamps a stop between frames with its time."""
    before = [m for m in applied(story) if m.time_ns < story.cut_ns and moves(m)]
    assert (before[-1].decoded().commander, before[-1].decoded().v_mps) == ("teleop", pytest.approx(SPEED_MPS))
    away = [m for m in applied(story) if story.cut_ns < m.capture_ns < story.mended_ns]
    moved = max((i for i, m in enumerate(away) if moves(m)), default=-1)
    stop = away[moved + 1]
    assert stop.decoded().commander == "stale"
    assert stop.capture_ns < story.cut_ns + BRAKE_NS + BUSY_NS, "nor does the pilot take over"


def test_no_command_moves_the_robot_that_answers_an_old_frame(story):
    """Whatever the link held back and delivers when it is mended."""
    assert max(m.time_ns - m.capture_ns for m in applied(story) if moves(m)) < OLD_NS


def test_the_laptop_drives_again_when_the_link_is_back(story):
    after = [m for m in applied(story) if m.time_ns > story.mended_ns and moves(m)]
    assert {m.decoded().commander for m in after} == {"teleop"}
