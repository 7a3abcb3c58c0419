"""Trials are judged by the truth, whatever the pilot believes."""

import math

from docking.score import Frame, Scorer, outcomes

STILL = Frame(0.0, "EVALUATE", "APPROACH", 0, 0, "NONE", False, "greedy", -1.5, 0.0, 0.0, 0.1, 0.0, 0.0, 1.5, 0.0, 1.2,
              False, False)  # fmt: skip


def run(*changes, **options):
    scorer = Scorer(**options)
    for index, change in enumerate(changes):
        scorer.frame(STILL._replace(time_s=index * 0.125, **change))
    return scorer


GRASPING = {"mode": "GRASP", "v_mps": 0.0, "goal_reached": True, "gripper_longitudinal_m": 0.0}
ENDED = {"mode": "PLACE", "ended": 1, "outcome": "PICKED"}


def test_docked_is_within_2_cm_and_4_degrees_at_rest():
    good = run({}, {**GRASPING, "gripper_lateral_m": 0.0199, "heading_rad": math.radians(3.9)}, ENDED).trials[0]
    assert good.docked
    aside = run({}, {**GRASPING, "gripper_lateral_m": 0.0201}, ENDED).trials[0]
    turned = run({}, {**GRASPING, "heading_rad": math.radians(-4.1)}, ENDED).trials[0]
    moving = run({}, {**GRASPING, "v_mps": 0.05}, ENDED).trials[0]
    assert not any(trial.docked for trial in (aside, turned, moving))


def test_what_the_pilot_believes_does_not_count():
    trial = run({}, {**GRASPING, "gripper_lateral_m": 0.3}, ENDED).trials[0]
    assert trial.outcome == "PICKED"
    assert not trial.picked
    assert not trial.docked
    assert trial.reached


def test_picked_is_the_object_held_and_lifted():
    assert run({}, {**GRASPING, "holding": True}, ENDED).trials[0].picked


def test_collisions_are_counted_once_each():
    scorer = run({}, {"collided": True}, {"collided": True}, {}, {"collided": True})
    assert scorer.collisions == 2


def test_outcomes_are_counted_apart():
    scorer = run({}, {"collided": True}, {"mode": "PLACE", "ended": 1, "outcome": "COLLIDED"})
    assert dict(outcomes(scorer.trials)) == {
        "reached": 0, "docked": 0, "picked": 0, "collided": 1, "lost": 0, "timed out": 0,
    }  # fmt: skip


def test_a_trial_knows_where_and_when_it_began():
    trial = run({"beta_rad": 0.3, "d_axle_m": 1.7}, {}, {}, ENDED).trials[0]
    assert trial.start == (0.3, 0.0, 1.7)
    assert (trial.began_s, trial.ended_s) == (0.0, 0.375)
    assert len(trial.path) == 3


def test_a_session_of_hours_keeps_the_way_of_its_newest_trial_alone():
    trials = [{}, {}, ENDED, {"number": 1, "ended": 1}, {"number": 1, "ended": 1}, {**ENDED, "ended": 2}]
    assert [len(trial.path) for trial in run(*trials).trials] == [2, 2]
    assert [len(trial.path) for trial in run(*trials, keeps_paths=False).trials] == [0, 2]


def test_the_last_trial_counts_once_though_the_session_finishes_with_it():
    last = {**GRASPING, "ended": 1, "outcome": "PICKED"}
    assert len(run({}, GRASPING, last, {**last, "phase": "FINISHED"}, {**last, "phase": "FINISHED"}).trials) == 1
