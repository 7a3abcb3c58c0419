"""The sessions kept in git. A failure here is meant to be looked at: `berth replay FILE --component C --check` shows
what has changed; if it was meant to change, `recordings/make.sh` records anew.
"""

import itertools
import json
from pathlib import Path

import pytest
import typer

from cli.info import info
from report.page import write
from report.session import read
from runtime.findings import Examination
from runtime.mend import mend
from runtime.recorded_launch import number_of
from runtime.recording import Recording
from runtime.replay import replay
from schemas.percept_pb2 import Percept
from schemas.trial_pb2 import Trial
from tests.runtime.offline import rewritten, without

FOLDER = Path(__file__).parent.parent / "recordings"
NAMES = ("docking", "reverse", "lost", "cut")
FOLDS = ("vision", "head", "tracker", "pilot", "learner", "grasper", "base")
"""Not the simulator: whoever improves it need not record anew."""


def recording(name: str) -> Recording:
    return Recording(FOLDER / f"{name}.mcap")


@pytest.mark.parametrize("component", FOLDS)
@pytest.mark.parametrize("name", NAMES)
def test_every_component_says_again_what_it_said(name, component):
    report = replay(recording(name), component)
    assert not report.differs, f"recordings/{name}.mcap: {report.first[0]}"
    torn = name == "cut"
    assert all(("without a stop" in outcome.words) is torn for outcome in report.runs)
    assert report.is_lossy is torn


@pytest.mark.parametrize("name", NAMES)
def test_each_is_small(name):
    assert (FOLDER / f"{name}.mcap").stat().st_size < 2_000_000


def test_a_file_that_ends_well_but_is_damaged_within_is_not_called_complete(tmp_path, capsys):
    data = bytearray((FOLDER / "docking.mcap").read_bytes())
    at = len(data) // 2
    data[at : at + 64] = bytes(64)
    (tmp_path / "spoilt.mcap").write_bytes(data)
    with pytest.raises(typer.Exit) as end:
        info(tmp_path / "spoilt.mcap", as_json=True)
    assert end.value.exit_code == 3
    assert json.loads(capsys.readouterr().out)["state"].startswith("byte ")


@pytest.mark.parametrize("launch", [{"components": None}, {"components": ["a"]}, {"components": [{"params": None}]}])
def test_a_report_needs_no_good_launch_file(tmp_path, launch):
    file = rewritten(
        FOLDER / "docking.mcap", tmp_path / "odd.mcap", lambda _, m: m, attach=lambda _: json.dumps(launch).encode()
    )
    assert number_of(read(file).launch, "edge_offset_m", 0.05) == 0.05
    write(read(file), tmp_path / "odd.html")
    assert (tmp_path / "odd.html").exists()


@pytest.mark.parametrize("name", ["docking", "reverse", "lost"])
def test_the_whole_ones_are_healthy(name):
    assert Examination(recording(name)).run() == []


def trials(name: str) -> list[Trial]:
    return [logged.decoded() for logged in recording(name).messages(["pilot/trial"])]


def test_one_holds_a_docking_and_a_pick_up():
    (trial,) = read(FOLDER / "docking.mcap").trials
    assert trial.docked
    assert trial.picked


def test_one_holds_a_failure_a_reverse_and_another_trial():
    modes = [(trial.mode, trial.number) for trial in trials("reverse")]
    assert Trial.SINK in {trial.outcome for trial in trials("reverse")}
    assert modes.index((Trial.APPROACH, 0)) < modes.index((Trial.REVERSE, 0)) < modes.index((Trial.APPROACH, 1))


def test_one_loses_the_object_more_than_once():
    assert Trial.LOST in {trial.outcome for trial in trials("lost")}
    seen = [Percept.FromString(logged.payload).visible for logged in recording("lost").messages(["tracker/percept"])]
    losses = sum(before and not now for before, now in itertools.pairwise(seen))
    assert losses >= 3


def test_one_is_torn_and_can_be_mended(tmp_path):
    torn = recording("cut")
    assert not torn.whole()
    assert {finding.kind for finding in Examination(torn).run()} == {"file", "journal"}
    mended = mend(torn, tmp_path / "mended.mcap")
    assert mended.lost == {}
    assert mended.messages > 1000
    assert Recording(tmp_path / "mended.mcap").whole()
    assert not replay(Recording(tmp_path / "mended.mcap"), "base").differs


@pytest.mark.parametrize("name", NAMES)
def test_info_says_complete_or_torn(name, capsys):
    with pytest.raises(typer.Exit) as end:
        info(FOLDER / f"{name}.mcap", as_json=True)
    found = json.loads(capsys.readouterr().out)
    assert end.value.exit_code == (3 if name == "cut" else 0)
    assert found["state"].startswith("torn; byte ") if name == "cut" else found["state"] == "complete"
    images = next(topic for topic in found["topics"] if topic["topic"] == "camera/image")
    assert images["hz"] == pytest.approx(8.0, rel=0.05)
    assert images["gaps"] == 0


def test_info_names_what_was_lost_and_on_which_topic(tmp_path, capsys):
    change = without("vision/view", sequences=range(100, 103))
    with pytest.raises(typer.Exit) as end:
        info(rewritten(FOLDER / "reverse.mcap", tmp_path / "lossy.mcap", change), as_json=True)
    found = json.loads(capsys.readouterr().out)
    assert end.value.exit_code == 3
    assert found["state"] == "3 lost on vision/view"
    assert (found["lost"], found["robot_minutes"], found["trials"]) == (3, 0.5, 2)
    assert next(topic["gaps"] for topic in found["topics"] if topic["topic"] == "vision/view") == 1
