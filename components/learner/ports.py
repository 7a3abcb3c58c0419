"""Memory, filter, model, sweep: turns percepts and applied commands into a policy table: parameters and ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from components.learner.settings import Settings
from docking.angles import DEG
from docking.task import Task
from runtime.contract import Input, Kind, Port
from runtime.params import between, positive
from schemas.drive_pb2 import Applied
from schemas.percept_pb2 import Percept
from schemas.policy_pb2 import Policy
from schemas.session_pb2 import LearnerPace, Snapshot
from schemas.trial_pb2 import Trial


@dataclass(frozen=True)
class Params(Settings):
    """Parameters of this component; those of the learning methods are inherited."""

    task: Task = field(default_factory=Task)
    """Cells, goal, actions and limits, from the launch file's [task]."""
    sampling_period_s: float = positive(0.125)
    """Ts, the unit of the paper's n. Table I."""
    speed_tolerance_mps: float = positive(0.02)
    """What base applied is an action if its speed differs by no more than this. A fifth of the speed."""
    turn_tolerance_radps: float = positive(2 * DEG)
    """As above, for the turn rate."""
    action_share: float = between(0.6, 0.5, 1.0)
    """A transition counts if its action was executed in at least this share of its frames."""
    delay_samples: int = between(1, 0, 8)
    """Frames until a new action is in force; that motion still belongs to the action before and is left out."""
    max_gap_samples: float = between(2.5, 1.0, 80.0)
    """Frames further apart than this break a transition."""
    join_frames: int = between(8, 1, 64)
    """An incomplete frame is given up when so many newer ones are complete."""
    snapshot_every_trials: int = positive(1)
    """What is known is published at the end of every so many trials, and at the end of the training: 0.3 MB."""


FLEET = 4
"""So many robots may share one learner: `percept`, `trial` and `applied` are the first one's, `percept_2` ... the
others'."""
_PARTS = {"percept": (Percept, Kind.STATE), "trial": (Trial, Kind.EVENT), "applied": (Applied, Kind.STATE)}
HEARD: Mapping[str, tuple[str, int]] = {
    part if robot == 0 else f"{part}_{robot + 1}": (part, robot) for robot in range(FLEET) for part in _PARTS
}
"""Input port -> what it tells of a frame, and which robot's frame."""
INPUTS: Mapping[str, Input] = {
    name: Port(*_PARTS[part], hz=8, queue=512, optional=robot > 0) for name, (part, robot) in HEARD.items()
}
_FRAME = tuple(HEARD)
POLICIES = ("policy", *(f"policy_{robot + 1}" for robot in range(1, FLEET)))
"""Output port of each robot's."""
OUTPUTS: Mapping[str, Port] = {
    **{name: Port(Policy, Kind.EVENT, on=_FRAME) for name in POLICIES},
    "snapshot": Port(Snapshot, Kind.EVENT, on=_FRAME),
    "pace": Port(LearnerPace, Kind.EVENT, hz=8, on=_FRAME),
}
