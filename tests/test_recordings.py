"""The sessions kept in git. A failure here is meant to be looked at: `berth replay FILE --component C --check` shows
what has changed; if it was meant to change, `recordings/make.sh` records anew.
"""

import itertools
from pathlib import Path

import pytest

from report.session import read
from runtime.findings import Examination
from runtime.mend import mend
from runtime.recording import Recording
from runtime.replay import replay
from schemas.percept_pb2 import Percept
from schemas.trial_pb2 import Trial

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
