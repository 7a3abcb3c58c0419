"""Each failed trial has the name of what made it fail, and the time of it."""

import math

import pytest

from components.pilot.component import Pilot
from components.pilot.ports import Params
from docking import plant
from docking.task import Task
from schemas.drive_pb2 import Applied, BaseState
from schemas.grasp_pb2 import Grasp
from schemas.trial_pb2 import Trial
from tests.components.piloting_world import AT_GOAL, DEG, HEIGHT_M, PERIOD_NS, TASK, frame, percept, policy, tell

LC = Params(task=Task(), train_s=0.0, evaluation_trials=2, evaluation_controller="lc", pick_up=False, placing_s=0.0,
            lost_s=1.0, trial_timeout_s=40.0)  # fmt: skip
GREEDY = Params(task=TASK, train_s=0.0, evaluation_trials=2, placing_s=0.0, pick_up=False, trial_timeout_s=20.0)
FRAMES = 500


class World:
    """A plant whose wheels may turn without moving it; odometry says what the wheels did."""

    def __init__(self, params, start, table=None):
        self.pilot = Pilot(params, 3)
        self.pose, self.wheels, self.motion = plant.pose(*start), (0.0, 0.0, 0.0), (0.0, 0.0)
        self.k = 0
        if table is not None:
            tell(self.pilot, "policy", table)

    def step(self, *, grip=1.0, turn_grip=1.0, visible=True, bumper=False, late=False) -> Trial:
        """One frame.

        Args:
            grip: share of the wheels' way that the robot goes.
            turn_grip: share of the wheels' turn that the robot turns.
        """
        if late:
            tell(self.pilot, "applied", Applied(commander="stale"), self.k)
        beta, alpha, d = plant.observe(*self.pose)
        state = BaseState(odometry_x_m=self.wheels[0], odometry_y_m=self.wheels[1], odometry_heading_rad=self.wheels[2],
                          v_mps=self.motion[0], omega_radps=self.motion[1], bumper=bumper)  # fmt: skip
        command, trial, _ = frame(self.pilot, self.k, percept(beta, alpha, math.atan2(HEIGHT_M, d), visible), state)
        self.motion = (command.v_mps, command.omega_radps) if command.engaged else (0.0, 0.0)
        v, omega = self.motion
        self.wheels = plant.advance(*self.wheels, v, omega, 0.125)
        self.pose = plant.advance(*self.pose, v * grip, omega * turn_grip, 0.125)
        self.k += 1
        return trial

    def until_the_end(self, **how) -> Trial:
        """Go on until a trial has ended."""
        for _ in range(FRAMES):
            trial = self.step(**how)
            if trial.ended:
                return trial
        raise AssertionError("no trial ended")

    def go(self, frames, **how):
        for _ in range(frames):
            assert not self.step(**how).ended


def name(trial):
    return Trial.Failure.Name(trial.failure)


STRAIGHT, HARD = (0.3, 0.3, 1.6), (50 * DEG, 0.0, 0.8)
"""(beta, alpha, d): a start that the linear law docks from, and one that no turn of this limit does."""


def test_a_success_has_no_failure():
    trial = World(LC, STRAIGHT).until_the_end()
    assert (Trial.Outcome.Name(trial.outcome), name(trial), trial.failure_ns) == ("ARRIVED", "NO_FAILURE", 0)


def test_a_closed_bumper_is_a_collision_at_that_frame():
    world = World(LC, STRAIGHT)
    world.go(20)
    trial = world.step(bumper=True)
    assert (name(trial), trial.failure_ns) == ("COLLISION", 20 * PERIOD_NS)


def test_an_object_out_of_view_is_lost_since_it_was_last_seen():
    world = World(LC, STRAIGHT)
    world.go(20)
    trial = world.until_the_end(visible=False)
    assert (name(trial), trial.failure_ns) == ("OBJECT_LOST", 19 * PERIOD_NS)


def test_a_turn_at_the_limit_that_does_not_suffice_is_an_unreachable_start():
    world = World(LC, HARD)
    trial = world.until_the_end()
    assert name(trial) == "UNREACHABLE"
    assert trial.began_ns <= trial.failure_ns <= (world.k - 1) * PERIOD_NS - LC.lock_s * 1e9


def test_a_collision_after_a_late_command_is_the_late_commands():
    world = World(LC, STRAIGHT)
    world.go(20)
    world.go(1, late=True)
    world.go(3)
    trial = world.step(bumper=True)
    assert (name(trial), trial.failure_ns) == ("LATE_COMMAND", 20 * PERIOD_NS)
    assert Trial.Outcome.Name(trial.outcome) == "COLLIDED"


def test_a_late_command_is_never_later_than_the_trials_end():
    world = World(LC, STRAIGHT)
    world.go(20)
    tell(world.pilot, "applied", Applied(commander="stale"), 24)  # base's own clock goes on while a frame is late
    assert world.step(bumper=True).failure_ns == 20 * PERIOD_NS


def test_a_late_command_long_before_the_end_is_not_blamed():
    world = World(LC, STRAIGHT)
    world.go(20)
    world.go(1, late=True)
    world.go(30)
    assert name(world.step(bumper=True)) == "COLLISION"


def test_wheels_that_turn_while_the_view_stands_still_slip():
    world = World(LC, STRAIGHT)
    world.go(70)
    trial = world.until_the_end(grip=0.0)
    assert (Trial.Outcome.Name(trial.outcome), name(trial)) == ("TIMED_OUT", "SLIP")


def test_a_turn_that_the_table_does_not_show_is_a_slip():
    world = World(LC, (0.6, 0.6, 1.6))
    trial = world.until_the_end(turn_grip=0.0)
    assert name(trial) == "SLIP"


@pytest.mark.parametrize("scale", [0.95, 1.05])
def test_wheels_of_another_radius_do_not_slip(scale):
    world = World(LC, HARD)
    assert name(world.until_the_end(grip=scale, turn_grip=scale)) == "UNREACHABLE"


def test_a_policy_that_promised_the_goal_and_missed_it_has_a_wrong_model():
    table = policy(everywhere=1, value=[250.0] * 25)
    trial = World(GREEDY, (0.5, 0.4, 1.5), table).until_the_end()
    assert (Trial.Outcome.Name(trial.outcome), name(trial)) == ("SINK", "MODEL_WRONG")


def test_a_policy_that_expected_no_better_calls_its_start_unreachable():
    table = policy(everywhere=1, value=[-40.0] * 25)
    trial = World(GREEDY, (0.5, 0.4, 1.5), table).until_the_end()
    assert (name(trial), trial.failure_ns) == ("UNREACHABLE", trial.began_ns)


def test_chance_that_steers_out_of_the_cells_is_off_course():
    params = Params(task=TASK, controller="rl", train_s=100.0)
    world = World(params, (-0.9, 0.9, 1.2))
    assert name(world.until_the_end()) == "OFF_COURSE"


def test_time_runs_out_by_its_own_name():
    params = Params(task=Task(), train_s=0.0, evaluation_trials=2, evaluation_controller="lc", trial_timeout_s=2.0)
    assert name(World(params, STRAIGHT).until_the_end()) == "TIMEOUT"


def test_a_missed_pick_up_has_its_name():
    pilot = Pilot(Params(task=TASK, train_s=0.0, evaluation_trials=2, placing_s=0.0), 3)
    trials = [frame(pilot, k, percept(*AT_GOAL))[1] for k in range(5)]
    assert trials[-1].mode == Trial.GRASP
    tell(pilot, "grasp", Grasp(stage=Grasp.DONE, picked=False), 5)
    assert name(frame(pilot, 5, percept(*AT_GOAL))[1]) == "PICK_MISSED"


def test_the_name_stays_until_the_next_trial_ends():
    world = World(LC, STRAIGHT)
    world.go(20)
    world.step(bumper=True)
    assert {name(world.step()) for _ in range(5)} == {"COLLISION"}


def test_what_explains_a_failure_is_saved_with_the_pilot():
    whole, cut = World(LC, STRAIGHT), World(LC, STRAIGHT)
    for world in (whole, cut):
        world.go(70)
    state = cut.pilot.save()
    cut.pilot = Pilot(LC, 3)
    cut.pilot.load(state)
    ends = [world.until_the_end(grip=0.0) for world in (whole, cut)]
    assert ends[0].SerializeToString() == ends[1].SerializeToString()
    assert name(ends[0]) == "SLIP"
