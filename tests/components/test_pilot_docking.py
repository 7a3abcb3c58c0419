"""The pilot on a perfect plant: what reaches the goal cell, and what arrives."""

from collections import Counter

import numpy as np
import pytest

from components.pilot.ports import Params
from schemas.trial_pb2 import Trial
from tests.components.piloting_world import DEG, EXACT, drive

TRIALS = 100
HOME = (0.3, 0.2, 1.7)


def demo_start(number):
    """|beta| <= 45 deg, |alpha| <= 30 deg, 1.5 to 2 m."""
    beta, alpha, d = np.random.default_rng([7, number]).uniform((-45, -30, 1.5), (45, 30, 2.0))
    return beta * DEG, alpha * DEG, d


def evaluated(noise_deg=0.0, **changes):
    """The last frame of every evaluation trial."""
    changes = {"pick_up": False, **changes}
    params = Params(task=EXACT, train_s=0.0, evaluation_trials=TRIALS, evaluation_controller="lc", **changes)
    ends, before = [], 0
    generator = np.random.default_rng(3)
    for seen in drive(params, 1, HOME, 60_000, noise_deg=noise_deg, generator=generator, starts=demo_start):
        if seen.trial.ended > before:
            ends.append(seen)
        before = seen.trial.ended
    assert seen.ended
    return ends


def docked(ends):
    return [e for e in ends if e.gripper_error_m <= 0.02 and e.heading_error_rad <= 4 * DEG]


@pytest.mark.parametrize("noise_deg", [0.0, 0.5])
def test_from_demo_starts_most_reach_the_goal_cell_and_the_servo_brings_those_within_2_cm_and_4_deg(noise_deg):
    ends = evaluated(noise_deg)
    reached = [end for end in ends if end.trial.goal_reached]
    assert len(ends) == TRIALS
    assert len(reached) >= 0.65 * TRIALS
    assert len(docked(reached)) >= 0.95 * len(reached)
    assert {end.trial.outcome for end in reached} == {Trial.ARRIVED}


def test_of_a_law_that_comes_in_at_an_angle_steering_docks_all_and_driving_straight_on_few():
    """The gains of an approach that enters the goal cell far out, at its corner."""
    approach = {"k_beta_per_s": 8.0, "k_alpha_per_s": 2.0}
    steered = [e for e in evaluated(**approach) if e.trial.goal_reached]
    straight = [
        e for e in evaluated(servo_k_beta_per_s=0.0, servo_k_alpha_per_s=0.0, **approach) if e.trial.goal_reached
    ]
    assert len(docked(steered)) >= 0.95 * len(steered)
    assert len(docked(straight)) < 0.5 * len(straight)


def test_every_trial_is_placed_once_at_its_own_start_with_the_robot_at_rest():
    params = Params(task=EXACT, train_s=0.0, evaluation_trials=5, evaluation_controller="lc", pick_up=False)
    placed = [s for s in drive(params, 1, HOME, 5000, starts=demo_start) if s.trial.place]
    assert [s.trial.start for s in placed] == [s.trial.number for s in placed] == [0, 1, 2, 3, 4]
    assert all(s.trial.mode == Trial.PLACE and s.drive.v_mps == 0.0 == s.drive.omega_radps for s in placed)


def test_the_session_ends_once_after_its_trials():
    params = Params(task=EXACT, train_s=5.0, evaluation_trials=3, evaluation_controller="lc", pick_up=False)
    seen = list(drive(params, 1, HOME, 5000, starts=demo_start))
    phases = [s.trial.phase for s in seen]
    assert phases == sorted(phases)
    assert phases.count(Trial.TRAIN) == 5 * 8
    assert [s.ended for s in seen].count(True) == 1
    assert seen[-1].trial.phase == Trial.FINISHED
    assert not seen[-1].drive.engaged
    assert seen[-1].trial.ended == 3


def test_a_trial_takes_its_modes_in_order():
    params = Params(task=EXACT, train_s=0.0, evaluation_trials=1, evaluation_controller="lc", pick_up=False)
    seen = list(drive(params, 1, HOME, 5000, starts=lambda _: (0.2, 0.1, 1.8)))
    modes = [s.trial.mode for s in seen[:-1]]
    assert list(dict.fromkeys(modes)) == [Trial.PLACE, Trial.WAIT, Trial.APPROACH, Trial.SERVO]
    assert Counter(s.trial.goal_reached for s in seen if s.trial.mode == Trial.SERVO) == {
        True: modes.count(Trial.SERVO)
    }


def test_the_servo_never_drives_faster_than_the_task_says():
    params = Params(task=EXACT, train_s=0.0, evaluation_trials=4, evaluation_controller="lc", pick_up=False)
    for s in drive(params, 1, HOME, 5000, starts=demo_start):
        assert abs(s.drive.v_mps) <= params.task.speed_mps
        assert abs(s.drive.omega_radps) <= params.task.turn_rate_radps


def test_training_ends_a_trial_in_the_goal_cell_and_drives_back():
    params = Params(task=EXACT, train_s=1e6, controller="lc")
    seen = list(drive(params, 1, (0.2, 0.1, 1.8), 400))
    end = next(i for i, s in enumerate(seen) if s.trial.ended == 1)
    assert seen[end].trial.outcome == Trial.REACHED
    assert seen[end].trial.mode == Trial.APPROACH
    assert seen[end].drive.v_mps == 0.0
    assert seen[end + 1].trial.mode == Trial.REVERSE
    assert not any(s.trial.place or s.trial.mode == Trial.SERVO for s in seen)
