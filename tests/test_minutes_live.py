"""The learner of our own in the whole system: camera, bytes, motors that lag. `benchmarks minutes_live` is longer."""

from pathlib import Path

from benchmarks.trials import watched
from docking.score import brier
from runtime.launch import load
from runtime.lockstep import Lockstep

LAUNCH = Path(__file__).parent.parent / "launch" / "minutes.toml"
AT_THE_ENDS_OF_THE_RANGES = ("pilot.first_start=7", "pilot.evaluation_trials=2")
"""62 deg beside the table's normal, and 59 deg off the axis."""


def test_after_a_robot_minute_it_docks_from_starts_whose_way_leads_out_of_the_ranges_and_has_said_so():
    overrides = ("task.action_set=two-speeds", "pilot.train_s=60", *AT_THE_ENDS_OF_THE_RANGES)
    scorer = watched(Lockstep(load(LAUNCH, overrides, seed=1)))
    trials = scorer.last(2, "EVALUATE")
    assert [trial.docked for trial in trials] == [True, True]
    assert scorer.collisions == 0
    square, told = brier(trials)
    assert told == 2
    assert square < 0.25
