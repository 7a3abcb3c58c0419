"""Where the pilot is in its session: everything it remembers, as plain numbers, so that it can be saved."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from typing import NamedTuple

from components.pilot.evidence import Evidence, Forecast, Scale
from runtime.params import between, not_negative, ruled


class Phase(IntEnum):
    """Numbers of `berth.Trial.Phase`."""

    TRAIN = 0
    EVALUATE = 1
    FINISHED = 2


class Mode(IntEnum):
    """Numbers of `berth.Trial.Mode`."""

    WAIT = 0
    APPROACH = 1
    SERVO = 2
    GRASP = 3
    REVERSE = 4
    PLACE = 5


class Outcome(IntEnum):
    """Numbers of `berth.Trial.Outcome`."""

    NONE = 0
    REACHED = 1
    SINK = 2
    COLLIDED = 3
    LOST = 4
    TIMED_OUT = 5
    ARRIVED = 6
    PICKED = 7
    MISSED = 8


class Failure(IntEnum):
    """Numbers of `berth.Trial.Failure`; `components.pilot.diagnosis` has the rules."""

    NO_FAILURE = 0
    UNREACHABLE = 1
    OBJECT_LOST = 2
    MODEL_WRONG = 3
    LATE_COMMAND = 4
    SLIP = 5
    COLLISION = 6
    TIMEOUT = 7
    OFF_COURSE = 8
    PICK_MISSED = 9


@dataclass(frozen=True, slots=True)
class Held:
    """The action that is held until the cell changes."""

    cell: int = -1
    """-1 = none is held."""
    action: int = between(-1, -1, 126)
    v_mps: float = 0.0
    omega_radps: float = 0.0
    controller: str = ""
    """Who chose it."""


@dataclass(frozen=True, slots=True)
class Start:
    """Where a reverse shall end, relative to the goal."""

    beta_rad: float = 0.0
    alpha_rad: float = 0.0
    tilt_rad: float = between(0.2, 1e-3, 1.57)


@dataclass(frozen=True, slots=True)
class Heard:
    """The newest word of base and grasper; times are capture times."""

    base_ns: int = -1
    bumper: bool = False
    v_mps: float = 0.0
    omega_radps: float = 0.0
    grasp_ns: int = -1
    grasp_done: bool = False
    picked: bool = False
    odometry_x_m: float = 0.0
    odometry_y_m: float = 0.0
    odometry_heading_rad: float = 0.0
    late_ns: int = -1
    """Newest frame in which base let a command go for its age."""
    hindered_ns: int = -1
    """Newest frame in which base refused to drive further back."""
    watchdog_s: float = 0.0
    """For so long the robot drives on after its last command; 0 = base does not say."""
    led_ns: int = -1
    """Since when a person has been driving the robot forwards; -1 = nobody does."""


@dataclass(frozen=True, slots=True)
class Progress:
    """State of the session. Times are capture times in ns, -1 = not yet."""

    answered_ns: int = -1
    """Newest frame answered."""
    phase: int = ruled(int(Phase.TRAIN), "a phase", lambda value: value in tuple(Phase))
    phase_began_ns: int = -1
    mode: int = ruled(int(Mode.WAIT), "a mode", lambda value: value in tuple(Mode))
    mode_began_ns: int = -1
    number: int = not_negative(0)
    """Of the trial in its phase."""
    ended: int = not_negative(0)
    """Trials ended in this phase."""
    outcome: int = ruled(int(Outcome.NONE), "an outcome", lambda value: value in tuple(Outcome))
    """Of the newest ended trial."""
    failure: int = ruled(int(Failure.NO_FAILURE), "a failure", lambda value: value in tuple(Failure))
    """Why the newest ended trial failed."""
    failure_ns: int = -1
    over: bool = False
    """The trial has ended; the next frame reverses or places."""
    goal_reached: bool = False
    began_ns: int = -1
    """First sight of the object in this trial; until then when the robot was placed or began to wait."""
    begun: bool = False
    seen_ns: int = -1
    """Newest frame in which the object was seen, or when the wait for it began."""
    placed_ns: int = -1
    arrived_ns: int = -1
    """When the servo stopped at the goal's tilt."""
    held: Held = field(default_factory=Held)
    draws: int = not_negative(0)
    """Random choices made in this trial: the next one's number in its stream."""
    start: Start = field(default_factory=Start)
    """Where the reverse shall end."""
    sent: tuple[float, ...] = ()
    """Speed and turn rate of the newest frames of this approach, m/s and rad/s by turns, the newest last."""
    hindered: bool = False
    """Base has lately refused to drive backwards."""
    turning: bool = False
    """The reverse has gone back far enough and turns on the spot."""
    seen_alpha_rad: float = 0.0
    """Bearing of the object when the reverse saw it last."""
    seen_tilt_rad: float = 1.57
    """As above; before that the robot may stand at the table."""
    searched: bool = False
    """The robot has turned once round in search of the object, in vain."""
    evidence: Evidence = field(default_factory=Evidence)
    forecast: Forecast = field(default_factory=Forecast)
    scale: Scale = field(default_factory=Scale)


class Wish(NamedTuple):
    """What the pilot wants in one frame."""

    v_mps: float = 0.0
    omega_radps: float = 0.0
    controller: str = ""
    action: int = -1
    engaged: bool = True
    place: bool = False


REST = Wish()
Step = tuple[Progress, Wish]
