"""`launch/sim2.toml` on two machines with keys: the robot drives, the laptop learns and records, the link is cut."""

import subprocess
from collections import Counter
from collections.abc import Iterator
from datetime import datetime
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from benchmarks.account import account
from benchmarks.halves import APPROACH, FRAME_NS, Echo, Halves, awaits_run_file, echoed, start
from benchmarks.watched import START_S, command_line, wait_until
from runtime.recording import Recording
from tests.keys import made
from tests.machines import ROOT, Cable, two_machines

pytestmark = pytest.mark.xdist_group("live")
CUT_FRAMES = 24
"""Three seconds."""
HOLE_FRAMES = 8
"""Of a machine that is too busy for real time (seen: 4); a router that waits for a dead link makes one of 14."""
BACK_S = 3.0
SLACK_S = 3.0
"""A test machine may be busy."""
OVERHEAD_BYTES = 300
"""Of each message: key, attachment, encoding, TLS, TCP."""
LEARNED_S = 60.0
"""Until the robot has learned something new: it may be driving back first."""


class Story(NamedTuple):
    """A session whose link was cut while the robot was on its way."""

    summaries: list[dict[str, Any]]
    laptop: Recording
    robot: Recording
    cut_frame: int
    mended_frame: int
    words: list[str]
    connections: list[int]
    link_bytes: int
    versions: list[int]
    """Of the policy that the robot used: at the cut, at the mending, at the end."""


@pytest.fixture(scope="module")
def story(tmp_path_factory) -> Iterator[Story]:
    directory = tmp_path_factory.mktemp("story")
    with two_machines(directory) as cable:
        halves = start(cable, directory, keys=made(directory / "keys", "robot", "laptop"))
        awaits_run_file(cable.robot)
        cable.robot.berth("record", "-o", str(directory / "robot.mcap"))
        awaits_run_file(cable.laptop)
        cable.laptop.berth("topic", "echo", "preview/image", "--json", output=subprocess.DEVNULL)
        with echoed(cable.robot, "pilot/trial", directory / "trials.jsonl") as trials:
            yield tell(cable, halves, trials, directory)


def tell(cable: Cable, halves: Halves, trials: Echo, directory: Path) -> Story:
    def learns() -> bool:
        trial = trials.last()
        return trial.get("mode") == APPROACH and trial["policy_version"] >= 3

    assert wait_until(lambda: learns() or not halves.alive(), START_S)
    assert halves.alive(), [half.communicate() for half in halves if half.poll() is not None]
    connections = [machine.connections() for machine in (cable.robot, cable.laptop)]
    link_bytes = cable.robot.sent_bytes()
    before = trials.last()
    cable.cut()
    assert wait_until(lambda: trials.last()["frame"] >= before["frame"] + CUT_FRAMES or not halves.alive(), 20)
    mended = trials.last()
    cable.mend()
    learned = mended["policy_version"]
    assert wait_until(lambda: trials.last()["policy_version"] > learned or not halves.alive(), LEARNED_S), (
        cable.robot.words()
    )
    versions = [before["policy_version"], learned, trials.last()["policy_version"]]
    halves.interrupt()
    summaries = halves.summaries()
    assert wait_until((directory / "robot.mcap").exists, 5)
    words = cable.robot.words()
    files = [Recording(directory / f"{name}.mcap") for name in ("laptop", "robot")]
    return Story(summaries, *files, before["frame"], mended["frame"], words, connections, link_bytes, versions)


def test_the_laptop_s_policies_drive_the_robot(story):
    assert story.versions[0] >= 3
    assert {spec for spec in Counter(m.topic for m in story.laptop.messages()) if spec.startswith("learner/")}


def test_the_robot_keeps_its_policy_and_its_pace_while_the_link_is_down(story):
    assert story.versions[1] - story.versions[0] <= 2, "what was under way at the cut"
    commands = [(m.capture_ns / FRAME_NS, m.decoded()) for m in story.robot.messages({"base/actuate"})]
    during = [(frame, command) for frame, command in commands if story.cut_frame <= frame <= story.mended_frame]
    holes = [after - before for (before, _), (after, _) in pairwise(during)]
    assert sum(holes) > CUT_FRAMES - HOLE_FRAMES
    assert max(holes) < HOLE_FRAMES, "a link that blocks its publishers makes a hole of the length of the cut"
    assert sum(command.v_mps != 0.0 for _, command in during) > len(during) / 2


def test_the_session_says_that_the_link_was_down_and_is_back_in_time(story):
    said = [line.partition(" ") for line in story.words]
    texts = [text for _, _, text in said]
    assert texts[:3] == ["laptop is there", "laptop is away; robot goes on without it", "laptop is back"]
    away, back = (datetime.fromisoformat(said[i][0]) for i in (1, 2))
    cut_s = (story.mended_frame - story.cut_frame) / 8
    assert (back - away).total_seconds() < cut_s + BACK_S + SLACK_S


def test_after_the_link_is_back_the_robot_gets_new_policies_and_nobody_was_restarted(story):
    assert story.versions[2] > story.versions[1]
    runs = Counter(topic for topic, _ in {(m.topic, m.run) for m in story.robot.messages({"learner/policy"})})
    assert runs == {"learner/policy": 1}


def test_what_was_lost_is_counted_and_has_gap_records(story):
    gaps = [m.decoded() for m in story.laptop.messages({"recorder/gap"})]
    percepts = [gap for gap in gaps if gap.key == "tracker/percept"]
    assert sum(gap.count for gap in percepts) == pytest.approx(CUT_FRAMES, abs=24)
    assert story.summaries[1]["lost"] == sum(gap.count for gap in gaps)
    assert story.laptop.whole()


def test_what_the_laptop_s_recording_lacks_is_in_its_gap_records_message_by_message(story):
    found = account(story.robot, story.laptop)
    assert found.wrong == 0
    assert found.lacking == found.told
    assert found.sent > 0


def test_both_halves_end_together(story):
    assert [summary["exit_reason"] for summary in story.summaries] == ["interrupted", "robot has ended"]
    last = [m.decoded() for m in story.laptop.messages({"base/actuate"})][-1]
    assert (last.v_mps, last.omega_radps) == (0.0, 0.0)


def test_the_hosts_share_one_connection_and_one_copy_of_each_image(story):
    """Recorder and a bystander on the laptop look at the images."""
    assert story.connections == [1, 1]
    from_robot = [m for m in story.laptop.messages() if not m.topic.startswith(("learner/", "recorder/"))]
    before = [m for m in from_robot if m.capture_ns <= story.cut_frame * FRAME_NS]
    images = sum(len(m.payload) for m in before if m.topic == "preview/image")
    once = sum(len(m.payload) + OVERHEAD_BYTES for m in before)
    assert images < story.link_bytes < once + 0.9 * images
    assert "camera/image" not in {topic.topic for topic in story.laptop.topics()}


def test_lockstep_over_the_link_loses_nothing(tmp_path):
    with two_machines(tmp_path) as cable:
        halves = start(cable, tmp_path, "--clock", "lockstep", "--set", "pilot.train_s=20", "--duration", "30")
        summaries = halves.summaries()
    assert [summary["lost"] for summary in summaries] == [0, 0]
    assert summaries[1]["exit_reason"] in {"duration", "robot has ended"}
    recording = Recording(tmp_path / "laptop.mcap")
    assert recording.whole()
    assert {m.topic for m in recording.messages()} >= {"preview/image", "learner/policy", "base/actuate"}


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--host", "robot", "--listen", "tcp/0.0.0.0:7447"), "--listen must be on loopback, or stand with --keys"),
        (("--host", "robot"), "--host robot must come with --listen or --connect: laptop runs the rest"),
        (("--listen", "tcp/127.0.0.1:7447"), "--listen and --connect must stand with --host"),
        (("--host", "laptop", "--in-process"), "--in-process must stand without --host"),
        (("--host", "moon", "--listen", "tcp/127.0.0.1:7447"), "--host must be one of laptop, robot; got 'moon'"),
    ],
)
def test_a_mistake_is_one_line_and_exit_code_2(tmp_path, words, says):
    machine = ["run", str(ROOT / "launch" / "sim2.toml"), *words]
    result = subprocess.run(
        [*command_line(*machine)], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False
    )
    assert result.returncode == 2
    assert result.stdout == ""
    assert says in result.stderr
    assert result.stderr.count("\n") == 1
