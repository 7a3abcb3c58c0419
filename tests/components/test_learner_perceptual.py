"""Our own learner: what it finds out from a robot's frames, against the numbers that the robot was built with."""

import math

import numpy as np
import pytest

from components.learner import motion_memory
from components.learner.motion_memory import MotionMemory
from components.learner.normal_equations import in_force
from components.learner.perceptual import Perceptual, Planning, Seen
from components.learner.smoother import smoothed
from components.learner.structure import STRUCTURES
from docking.angles import DEG
from docking.arrays import pack, unpack
from docking.levels import Limits
from experiments.problem import Problem
from experiments.robot import HEIGHT_M, ROBOTS, Drivetrain, Robot, poses_of

PERIOD_S = 0.125
ACTIONS = Problem().actions
LIMITS = Limits(0.05, 0.05, 65 * DEG, 80 * DEG, 0.5, 4.5, 0.62, False, 0.04, 0.07)


def frames(robot, seed, count=100):
    """Percepts and commands of a robot that turns left and right at random, each way for half a second and more."""
    rng = np.random.default_rng(seed)
    pose, drivetrain = poses_of(rng.uniform((-0.8, -0.6, 1.6), (0.8, 0.6, 2.0))[None]), Drivetrain(robot, 1)
    percepts, commands, action = [], [], 0
    for k in range(count):
        action = int(rng.integers(2)) if k % 5 == 0 else action
        percepts.append(robot.percepts(pose, drivetrain.motions, rng)[0])
        commands.append(ACTIONS[action])
        pose = drivetrain.drive(pose, np.array([ACTIONS[action]]), PERIOD_S)
    return np.array(percepts), np.array(commands)


def learned(robot, method="structure-given", stretches=4):
    memory = MotionMemory(STRUCTURES[method], PERIOD_S, 600.0, 9.0)
    for seed in range(stretches):
        memory.learn(*frames(robot, seed))
    return memory


def test_the_numbers_of_a_robot_are_found_where_its_form_is_given():
    fit = learned(Robot()).fit
    w_x, w_y, c = fit.mean
    assert fit.structure.name == "given, mirrored"
    assert (w_x, w_y, c) == pytest.approx((1.0 / HEIGHT_M, 0.0, 1.0), abs=0.01)


@pytest.mark.parametrize("samples", [0.0, 1.0, 1.25, 3.0])
def test_the_delay_of_a_command_is_found(samples):
    assert learned(Robot(delay_samples=samples)).fit.delay == pytest.approx(samples, abs=0.25)


def test_the_mirror_is_found_and_switched_off_where_the_wheels_are_unequal():
    memory = learned(Robot(drift_radpm=0.25))
    assert memory.fit.structure.name == "given, not mirrored"
    still = memory.model.rates(np.array([[0.0, 0.0, 2.0]]), np.array([[0.1, 0.0]]))
    assert still[0, 1] == pytest.approx(-0.025, abs=0.002)


def test_bearing_and_beta_are_found_to_share_a_function_where_nothing_is_given():
    assert learned(Robot(), "structure-learned", 4).fit.structure.name.startswith("shared")


@pytest.mark.parametrize("stretches", [2, 3, 4])
def test_what_no_structure_can_say_makes_a_rich_one_no_likelier(stretches):
    """Its percepts run ahead while it turns: an error in a row, not one of each sample."""
    fit = learned(ROBOTS["focal length x1.3"], "structure-learned", stretches).fit
    assert fit.structure.name == "shared, mirrored"


def test_rates_are_learned_without_a_form_within_two_percent_of_the_turn_rate():
    model, true = (learned(Robot(), method, 5).model for method in ("structure-learned", "structure-given"))
    seen = np.concatenate([frames(Robot(), seed)[0] for seed in range(5)])[::7]
    for action in ACTIONS:
        commands = np.tile(action, (len(seen), 1))
        error = model.rates(seen, commands) - true.rates(seen, commands)
        assert np.sqrt(np.mean(error**2)) < 0.02 * 10 * DEG


def test_noise_leaves_the_speeds_within_five_percent():
    w_x, _, c = learned(Robot(noise=(2 * DEG, 1 * DEG, 0.05)), stretches=4).fit.mean[[0, -2, -1]]
    assert (w_x * HEIGHT_M, c) == pytest.approx((1.0, 1.0), abs=0.05)


def test_a_changed_robot_is_noticed_and_the_old_one_forgotten():
    memory = learned(Robot())
    memory.learn(*frames(Robot(turn_gain=0.5), 11))
    memory.learn(*frames(Robot(turn_gain=0.5), 12))
    turn = memory.model.rates(np.array([[0.0, 0.0, 2.0]]), np.array([[0.0, 0.1]]))[0, 1]
    assert turn == pytest.approx(-0.05, abs=0.003)


@pytest.mark.parametrize(
    ("surprises", "forgets"),
    [
        ([9.1], True),
        ([8.9], False),
        ([5.9, 7.3], True),
        ([3.0, 3.0, 3.0], False),
        ([3.0, 3.0, 3.0, 3.0], True),
        ([8.0, 0.1, 8.0, 0.1], False),
        ([1.9] * 20, False),
    ],
)
def test_a_large_surprise_or_smaller_ones_in_a_row_make_it_forget(monkeypatch, surprises, forgets):
    memory, values = learned(Robot(), stretches=2), iter(surprises)
    monkeypatch.setattr(motion_memory, "surprise", lambda *_: next(values))
    before = float(memory.sums.count[0])
    for seed in range(len(surprises)):
        memory.learn(*frames(Robot(), 20 + seed, 40))
    assert (memory.sums.count[0] < before) == forgets
    assert memory.suspicion < memory.surprise


def test_noise_is_no_reason_to_forget():
    memory = learned(Robot(noise=(2 * DEG, 1 * DEG, 0.05)), "structure-learned", 4)
    assert memory.sums.count[0] > 3 * 90 * math.exp(-4 * 100 * PERIOD_S / 600.0)


def test_smoothing_takes_most_of_white_noise_and_leaves_a_line_as_it_is():
    rng = np.random.default_rng(3)
    line = np.linspace(0.0, 1.0, 80)[:, None] * np.array([1.0, -2.0, 0.5])
    noisy = smoothed(line + 0.05 * rng.standard_normal(line.shape), np.zeros_like(line), 0.05)
    assert np.sqrt(np.mean((noisy - line) ** 2)) < 0.5 * 0.05
    assert smoothed(line, np.zeros_like(line), 0.05) == pytest.approx(line, abs=1e-3)


def test_a_delay_of_one_and_a_quarter_samples_mixes_the_commands_before():
    commands = np.array([[1.0, 0.0], [2.0, 0.0], [4.0, 0.0], [8.0, 0.0]])
    assert in_force(commands, 1.25)[:, 0].tolist() == [1.0, 1.0, 0.75 * 2.0 + 0.25 * 1.0, 0.75 * 4.0 + 0.25 * 2.0]


def coarse(method="structure-given"):
    return Perceptual(Planning(method, angle_step_rad=6 * DEG, d_share=0.5), LIMITS, ACTIONS)


def fed(learner, begin=0, end=220):
    percepts, commands = frames(Robot(), 1, 220)
    for k in range(begin, end):
        learner.feed(Seen(tuple(percepts[k].tolist()), tuple(commands[k].tolist())), k // 60)
        learner.advance(3)
    return learner


def test_a_plan_in_slices_is_the_plan_at_once():
    sliced, whole = fed(coarse()), fed(coarse(), end=181)
    for learner in (sliced, whole):
        learner.close()
    while sliced.planner.busy:
        sliced.advance(1)
    assert whole.planner.model is not None
    whole.planner.begin(sliced.planner.model)
    whole.planner.finish()
    assert (whole.planner.times_s == sliced.planner.times_s).all()


@pytest.mark.parametrize("cut", [30, 62, 121, 122, 125])
def test_a_saved_and_loaded_learner_goes_on_as_if_nothing_had_happened(cut):
    whole = fed(coarse())
    header, arrays = unpack(pack("x", *fed(coarse(), end=cut).to_plain()), "x")
    again = coarse()
    again.from_plain(header, arrays)
    fed(again, begin=cut)
    assert pack("x", *again.to_plain()) == pack("x", *whole.to_plain())


def test_a_plan_that_was_left_out_is_begun_anew_and_comes_to_the_same():
    learner, again = fed(coarse(), end=62), coarse()
    assert learner.planner.busy
    header, arrays = learner.to_plain(plan=False)
    assert "times_s" not in arrays
    again.from_plain(*unpack(pack("x", header, arrays), "x"))
    learner.planner.finish()
    again.planner.finish()
    assert (again.planner.times_s == learner.planner.times_s).all()


def test_what_it_suspects_is_saved():
    learner, again = fed(coarse()), coarse()
    learner.memory.suspicion = 2.5
    again.from_plain(*unpack(pack("x", *learner.to_plain()), "x"))
    assert again.memory.suspicion == 2.5


def test_a_damaged_state_changes_nothing():
    learner = fed(coarse())
    header, arrays = learner.to_plain()
    before = pack("x", header, arrays)
    with pytest.raises(ValueError, match="table"):
        learner.from_plain(header, {**arrays, "table": np.full_like(learner.table, 9)})
    with pytest.raises(ValueError, match="incomplete"):
        learner.from_plain({**header, "open": None}, arrays)
    assert pack("x", *learner.to_plain()) == before


def test_a_frame_in_which_nothing_was_seen_ends_a_stretch():
    learner = coarse()
    percepts, commands = frames(Robot(), 1, 40)
    for k in range(40):
        learner.feed(Seen(tuple(percepts[k].tolist()), tuple(commands[k].tolist())), 0)
    assert learner.memory.samples == 0
    assert learner.feed(None, 0)
    assert learner.memory.samples == 40


def test_where_the_model_is_not_trusted_nothing_is_known():
    learner = Perceptual(
        Planning("structure-given", angle_step_rad=6 * DEG, d_share=0.5, trust_per_s=1e-9, explore=False),
        LIMITS,
        ACTIONS,
    )
    fed(learner)
    learner.close()
    while learner.planner.busy:
        learner.advance(50)
    policy = learner.policy()
    assert policy is None or policy.known == 0
    assert math.isfinite(learner.memory.fit.log_evidence)


def test_training_tries_what_is_not_known_where_the_plan_is_driven_otherwise():
    learner = Perceptual(
        Planning("structure-given", angle_step_rad=6 * DEG, d_share=0.5, known_per_s=1e-9), LIMITS, ACTIONS
    )
    fed(learner)
    learner.close()
    while learner.planner.busy:
        learner.advance(50)
    plan, trusted = learner.planner.chosen(), learner.policy()
    around = np.linspace(-0.8, 0.8, 9)
    states = np.array([[beta, alpha, math.log(d)] for beta in around for alpha in around for d in (1.0, 2.0, 4.0)])
    assert (trusted.act(states) == plan.reshape(-1)[trusted.axes.nearest(states)]).all()
    assert trusted.known == np.count_nonzero(plan >= 0)
    assert (trusted.act(states, exploring=True) != trusted.act(states)).any()
