"""Robots that are built alike: what one has seen the others know, at their own speed and turn rate."""

import zlib
from dataclasses import replace

import numpy as np
import pytest

from components.learner.frame import Frame, Percept, Progress
from components.learner.methods.perceptual import PerceptualMethod
from components.learner.motion_memory import MotionMemory
from components.learner.perceptual import LONGEST_STRETCH, Perceptual, Planning, Seen
from components.learner.ports import Params
from components.learner.regression import ALIKE, Scale, best_fit, scales_evidence
from components.learner.settings import PERCEPTUAL
from components.learner.structure import STRUCTURES
from docking.angles import DEG
from docking.arrays import pack, unpack
from docking.policy import UNKNOWN
from experiments.robot import ROBOTS, Robot
from tests.components.test_learner_perceptual import ACTIONS, LIMITS, PERIOD_S, frames

SLOW, FAST = Robot(speed_gain=0.92, turn_gain=1.06), Robot(speed_gain=1.07, turn_gain=0.94)
STATES = np.concatenate([frames(Robot(), seed)[0] for seed in range(5)])[::7]


def alike(count, method="structure-learned", memory_s=600.0):
    memories = []
    for _ in range(count):
        MotionMemory(STRUCTURES[method], PERIOD_S, memory_s, 9.0, alike=memories)
    return memories


def error_radps(memory, robot):
    """Root mean square over states and actions, of the largest of beta, alpha, ln d: against what the robot does."""
    true = MotionMemory(STRUCTURES["structure-given"], PERIOD_S, 600.0, 9.0)
    for seed in range(4):
        true.learn(*frames(robot, seed))
    commands = [np.tile(action, (len(STATES), 1)) for action in ACTIONS]
    errors = [memory.model.rates(STATES, each) - true.model.rates(STATES, each) for each in commands]
    return float(np.sqrt(np.mean(np.square(errors), axis=(0, 1))).max())


@pytest.mark.parametrize("method", PERCEPTUAL)
def test_one_form_is_learned_from_two_robots_and_each_has_its_own_speed_and_turn_rate(method):
    slow, fast = alike(2, method)
    for seed in range(4):
        slow.learn(*frames(SLOW, 20 + seed))
        fast.learn(*frames(FAST, 30 + seed))
    assert error_radps(slow, SLOW) < 0.03 * 10 * DEG
    assert error_radps(fast, FAST) < 0.03 * 10 * DEG
    assert fast.fit.structure.name == STRUCTURES[method][0].name


def test_a_robot_knows_after_seconds_what_another_has_learned_in_a_minute():
    slow, fast = alike(2)
    (alone,) = alike(1)
    for seed in range(5):
        slow.learn(*frames(SLOW, 20 + seed))
    for memory in (fast, alone):
        memory.learn(*frames(FAST, 3, 40))
    assert error_radps(fast, FAST) < 0.05 * 10 * DEG
    assert error_radps(alone, FAST) > 4.0 * error_radps(fast, FAST)


def test_what_is_not_known_of_a_robots_own_scale_is_doubted():
    slow, fast = alike(2, "structure-given")
    noise = (2 * DEG, 1 * DEG, 0.05)
    for seed in range(4):
        slow.learn(*frames(replace(SLOW, noise=noise), 20 + seed))
    fast.learn(*frames(replace(FAST, noise=noise), 3, 24))
    doubt, settled = (np.sqrt(np.diag(one.fit.covariance)) / np.abs(one.fit.mean) for one in (fast, slow))
    assert len(fast.fit.mean) == len(slow.fit.mean)
    assert doubt[0] > 1.3 * settled[0]
    assert doubt[0] > 0.8 * ALIKE


@pytest.mark.parametrize(
    ("mean", "share", "expected"),
    [((1.0, 1.0), 1.0, 0.0), ((1.0, 1.0), 0.01, -np.log(100.0)), ((1.0 + ALIKE, 1.0 - ALIKE), 1.0, -1.0)],
)
def test_scales_cost_evidence_as_far_as_they_are_known_and_off(mean, share, expected):
    scale = Scale(np.array(mean), np.eye(2) * share * ALIKE**2)
    assert scales_evidence([scale]) == pytest.approx(expected)
    assert scales_evidence([scale] * 3) == pytest.approx(3.0 * expected)


def test_that_there_are_two_robots_is_less_likely_than_that_one_has_seen_all_of_it():
    first, second = alike(2, "structure-given", 1e9)
    (one,) = alike(1, "structure-given", 1e9)
    for seed in range(6):
        (first, second)[seed % 2].learn(*frames(Robot(), seed))
        one.learn(*frames(Robot(), seed))
    assert first.fit.mean == pytest.approx(one.fit.mean, abs=0.01)
    assert first.fit.log_evidence < one.fit.log_evidence - 4.0


def test_one_robot_alone_is_fitted_to_its_own_sums():
    (memory,) = alike(1)
    memory.learn(*frames(SLOW, 1))
    assert (memory.fit.mean == best_fit([memory.sums], memory.structures).mean).all()


def test_a_robot_that_has_changed_learns_as_if_it_were_alone_and_the_others_go_on():
    changing, other = alike(2)
    (alone,) = alike(1)
    aside = ROBOTS["camera aside"]
    for seed in range(4):
        other.learn(*frames(Robot(), 30 + seed))
        for memory in (changing, alone):
            memory.learn(*frames(Robot(), 20 + seed))
    for seed in range(4):
        for memory in (changing, alone):
            memory.learn(*frames(aside, 40 + seed))
    assert error_radps(changing, aside) == pytest.approx(error_radps(alone, aside), rel=0.05)
    assert error_radps(other, Robot()) < 0.03 * 10 * DEG


def coarse(kin=None):
    return Perceptual(Planning("structure-given", angle_step_rad=6 * DEG, d_share=0.5), LIMITS, ACTIONS, kin)


def test_those_who_share_learn_as_often_as_one_does_by_the_frames_of_all():
    first = coarse()
    second = coarse(first)
    percepts, commands = frames(Robot(), 1, LONGEST_STRETCH)
    for k in range(LONGEST_STRETCH // 2 + 1):
        second.feed(Seen(tuple(percepts[k].tolist()), tuple(commands[k].tolist())), 0)
    assert (first.memory.samples, second.memory.samples) == (0, LONGEST_STRETCH // 2)


def driven(method, robots, begin=0, end=120):
    """A frame of each in turn."""
    ways = [frames(robot, number, 120) for number, robot in enumerate(robots)]
    for k in range(begin, end):
        for number, (percepts, commands) in enumerate(ways):
            beta, alpha, log = percepts[k].tolist()
            percept = Percept(True, 0, beta, alpha, False, float(np.arctan(np.exp(-log))))
            progress = Progress(training=True, learning=True, began_ns=0, ended=k // 60)
            method.feed(Frame(k * 125_000_000, percept, progress, 0, tuple(commands[k].tolist())), number)
    return method


def new_method():
    params = Params(method="structure-given", goal="cell", grid_angle_rad=6 * DEG, grid_distance_share=0.9)
    return PerceptualMethod(params.task, params, PERIOD_S)


@pytest.mark.parametrize("cut", [30, 63, 119])
def test_saved_and_loaded_they_go_on_as_if_nothing_had_happened(cut):
    robots = [SLOW, FAST, Robot()]
    whole, again = driven(new_method(), robots), new_method()
    again.load(driven(new_method(), robots, end=cut).save())
    driven(again, robots, begin=cut)
    assert again.save() == whole.save()
    assert again.digest() == whole.digest()


def test_no_robot_is_fitted_again_while_only_others_learn(monkeypatch):
    first = coarse()
    second = coarse(first)
    percepts, commands = frames(Robot(), 1, 60)
    ways = [Seen(tuple(p.tolist()), tuple(c.tolist())) for p, c in zip(percepts, commands, strict=True)]
    for seen in ways:
        first.feed(seen, 0)
    first.close()
    first.planner.finish()
    for seen in ways:
        second.feed(seen, 0)
    second.close()
    fits = []
    monkeypatch.setattr("components.learner.motion_memory.best_fit", lambda *_: fits.append(1))
    first.advance(1)
    assert fits == []


def test_each_has_a_plan_of_its_own():
    method = driven(new_method(), [SLOW, FAST])
    slow, fast = (method.table(1, robot) for robot in (0, 1))
    assert (slow.action != UNKNOWN).any()
    assert slow.table_sha256 != fast.table_sha256
    assert slow.fine.model.theta == pytest.approx(fast.fine.model.theta, rel=0.3, abs=0.05)
    assert np.abs(slow.fine.model.theta - fast.fine.model.theta).max() > 0.05


def test_a_state_with_a_damaged_robot_is_refused():
    method = driven(new_method(), [SLOW, FAST])
    before = method.save()

    header, arrays = unpack(zlib.decompress(before), "perceptual learner")
    first = header["robots"][0]
    for robots in (None, [first, 5], [{**first, "suspicion": []}], [first, first], [{**first, "robot": 4}]):
        with pytest.raises(ValueError, match="learner state"):
            method.load(zlib.compress(pack("perceptual learner", {**header, "robots": robots}, arrays)))
    assert method.save() == before
