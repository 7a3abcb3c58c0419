"""Policies, teacher, trials, reverse: turns percepts into drive commands: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from docking.angles import DEG
from docking.task import Task
from runtime.contract import Input, Kind, Port
from runtime.params import between, not_negative, one_of, positive, ruled
from schemas.drive_pb2 import Applied, BaseState, Drive
from schemas.grasp_pb2 import Grasp
from schemas.percept_pb2 import Percept
from schemas.policy_pb2 import Policy
from schemas.session_pb2 import SessionEnd
from schemas.trial_pb2 import Trial


def is_policy(data: bytes) -> bool:
    """Whether these bytes are a policy file (or none at all)."""
    from docking.policy import PolicyTable  # noqa: PLC0415  (numpy: not for every launch check)

    try:
        return not data or PolicyTable.from_bytes(data) is not None
    except ValueError:
        return False


@dataclass(frozen=True)
class Params:
    """Parameters of this component."""

    task: Task = field(default_factory=Task)
    """Ranges, goal, actions and limits, from the launch file's [task]."""
    train_s: float = not_negative(2400.0)
    """Robot time to learn for; 0 = none. 40 minutes: Martinez-Marin and Duckett 2005, section VI, on their robot."""
    evaluation_trials: int = not_negative(100)
    """Trials with the frozen policy after the training; the robot is put at one start after another"""
    first_start: int = not_negative(0)
    """Number of the evaluation's first start, so that one list of starts can be split."""
    policy: bytes = ruled(b"", "a policy file", is_policy)
    """Path of a policy to begin with; empty = none, until the learner sends one."""
    controller: str = one_of("rl-lc", "rl", "lc", "rl-lc", "greedy")
    """Who drives in training: rl = a random action for each cell, lc = the teacher, rl-lc = trial by trial teacher and
    random (section V), greedy = the newest policy."""
    evaluation_controller: str = one_of("greedy", "greedy", "lc")
    """Who drives in evaluation: the policy, or the linear law on the continuous state."""
    evaluation_reset: str = one_of("place", "place", "reverse")
    """How the robot gets to the next start in evaluation: it is put there, or drives back there itself."""
    rival_policy: bytes = ruled(b"", "a policy file", is_policy)
    """Path of the policy that `policy` is compared with; see `rival_controller`."""
    rival_controller: str = one_of("", "", "greedy", "lc")
    """Not empty: evaluation trials come in pairs from one start, one driven as `evaluation_controller` says, the other
    by this one (greedy: by `rival_policy`), in an order drawn from the seed."""
    shadow: bool = False
    """Say what the policy would do wherever the object is seen; run no trials, be engaged never."""
    unknown_cells: str = one_of("lc", "lc", "random")
    """Whom greedy asks in a cell that the policy knows nothing about."""
    hold: str = one_of("cell", "cell", "sample")
    """An action is held until the cell changes (the paper's semi-Markov step), or for one sample."""
    sampling_period_s: float = positive(0.125)
    """Ts. By it a policy that knows the distance bridges the delay of its commands. Table I."""
    fine_hold_samples: int = between(3, 1, 8)
    """A policy that knows the distance holds each action so long: at the edge between two it would choose the other in
    every frame, faster than motors can turn, and their lag would drive."""
    k_beta_per_s: float = 2.25
    """Gain of the linear law and teacher on beta. Best of a grid search on the geometric plant; by hand: 1.5."""
    k_alpha_per_s: float = 1.5
    """As above, on alpha."""
    servo_k_beta_per_s: float = 3.0
    """Gain of the servo on beta, from the goal cell to the pick-up. Best on the plant with 0.5 deg of
    noise and one sample of delay; the turn rate's limit matters more than the gains."""
    servo_k_alpha_per_s: float = 4.0
    """As above, on alpha."""
    servo_slow_tilt_rad: float = not_negative(4 * DEG)
    """This much before the goal's tilt the servo slows down, so that a sample of motion is millimetres; 0 = never."""
    servo_slowest: float = between(0.25, 0.01, 1.0)
    """Share of the task's speed that is left at the goal's tilt; also the speed back after a step too far."""
    servo_tolerance_rad: float = positive(0.7 * DEG)
    """The goal's tilt is met within this; 8 mm."""
    camera_height_m: float = positive(0.45)
    """Of the camera above the object and the next one; only for the watchdog of the robot, if base tells of a slow one.
    Towards the table no faster than that the robot would stop before it by itself, if its computer died."""
    table_room_m: float = between(0.04, 0.0, 1.0)
    """Beyond the task's `tilt_limit_rad` the gripper is still so far from the table. In simulation: 0.042."""
    settle_s: float = positive(1.0)
    """Longest wait for the base to stand still before the grasper is called."""
    pick_up: bool = True
    """A grasper is wired: after arriving wait for it."""
    grasp_timeout_s: float = positive(40.0)
    """Longer than this is a missed pick-up."""
    lost_s: float = positive(15.0)
    """Object not seen for longer ends a trial; the tracker's search takes some seconds."""
    trial_timeout_s: float = positive(60.0)
    """Longest trial, from its first sight of the object."""
    placing_s: float = not_negative(0.2)
    """Percepts captured sooner than this after a placement may still show the old place."""
    reverse_speed_mps: float = positive(0.2)
    """Speed backwards after a trial."""
    reverse_turn_rate_radps: float = positive(25 * DEG)
    """Fastest turn after a trial; 3 deg a frame, so that the object stays in the image."""
    reverse_gain_per_s: float = positive(2.0)
    """Turn rate per radian of bearing error."""
    reverse_bearing_rad: float = between(60 * DEG, 0.0, 1.4)
    """Largest bearing held while driving backwards; it moves beta."""
    reverse_clear_tilt_rad: float = between(38 * DEG, 0.0, 1.57)
    """Closer than this the robot backs off without turning on the spot: the gripper would sweep over the table."""
    reverse_tolerance_rad: float = positive(3 * DEG)
    """A start's bearing is met within this."""
    reverse_timeout_s: float = positive(40.0)
    """After this a trial begins where the robot is, or another start is drawn."""
    search_turn_rate_radps: float = positive(15 * DEG)
    """With the object out of view for `lost_s` after a trial, the robot turns once round, if it stands clear of the
    table; not found, a trial ends as lost."""
    blame_s: float = positive(3.0)
    """A late command or a slip longer than this before a trial's end is not its cause."""
    lock_s: float = positive(2.0)
    """Turning towards the goal at the limit for so long, and missing it, is called unreachable."""
    slip_window_s: float = positive(2.0)
    """Wheels and view are compared over this time."""
    slip_way_m: float = positive(0.1)
    """Shorter ways are not compared; 0.2 m are driven in the window."""
    slip_share: float = between(0.5, 0.0, 1.0)
    """Slip: the view moves by less than this share of what it used to for the same way."""
    slip_turn_rad: float = positive(10 * DEG)
    """Slip: odometry and the table's edge disagree by more about how far the robot has turned in the window."""
    start_share: float = between(0.85, 0.0, 1.0)
    """Starts are drawn within this share of the ranges of beta and alpha, uniformly."""


INPUTS: Mapping[str, Input] = {
    "percept": Port(Percept, Kind.STATE, hz=8, per_frame=True),
    "policy": Port(Policy, Kind.EVENT, optional=True),
    "base": Port(BaseState, Kind.STATE, hz=8),
    "grasp": Port(Grasp, Kind.EVENT, hz=8, optional=True),
    "applied": Port(Applied, Kind.STATE, hz=8, optional=True),
}
OUTPUTS: Mapping[str, Port] = {
    "drive": Port(Drive, Kind.COMMAND, hz=8, per_frame=True, on=("percept",)),
    "trial": Port(Trial, Kind.EVENT, hz=8, per_frame=True, on=("percept",)),
    "end": Port(SessionEnd, Kind.EVENT, on=("percept",)),
}
