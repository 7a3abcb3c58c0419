"""Our own methods as the component sees them: fed frame by frame, a table out."""

from __future__ import annotations

import math
import zlib
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from components.learner.frame import Frame
from components.learner.perception import limits_of
from components.learner.perceptual import Perceptual, Planning, Seen
from components.learner.planner import Planner
from components.learner.settings import Settings
from docking.arrays import LARGEST_BYTES, pack, unpack
from docking.cells import Grid
from docking.grid_policy import Axes, GridPolicy
from docking.policy import UNKNOWN, PolicyTable
from docking.rates import SIZES, RateModel
from docking.task import Task
from docking.value_iteration import LATE_S

_KIND = "perceptual learner"
_FASTER, _FASTEST_MPS = 1.25, 2.0
_RAMP_MPS, _RAMP_S = 0.06, 0.75
"""After a change of speed by more a robot is slower or faster than commanded for so long: 0.2 m/s take it 0.67 s."""
_SHOWN_TILT_SHARE = 0.5
"""The cells show the policy where cot(tilt) is halfway between the nearest and the farthest start."""


@dataclass
class Newest:
    """What is remembered of a robot's newest frames."""

    capture_ns: int = -1
    speeds_mps: list[float] = field(default_factory=list)
    """Commanded, this long: a ramp and one."""


class PerceptualMethod:
    """A learner of how percepts move. Nothing in it is random."""

    def __init__(self, task: Task, settings: Settings, period_s: float) -> None:
        self.settings = settings
        self.grid = Grid.of(task)
        self._period_s = period_s
        self._turn_rate_radps = task.turn_rate_radps
        planning = Planning(
            method=settings.method,
            period_s=period_s,
            angle_step_rad=settings.grid_angle_rad,
            d_share=settings.grid_distance_share,
            memory_s=settings.memory_s,
            surprise=settings.surprise,
            trust_per_s=settings.trust_per_s,
            known_per_s=settings.known_per_s,
            back_samples=settings.back_samples,
            explore=settings.explore,
        )
        near, far = (1.0 / math.tan(tilt) for tilt in (task.start_tilt_max_rad, task.start_tilt_min_rad))
        self._shown_d = near + _SHOWN_TILT_SHARE * (far - near)
        room_rad = (settings.room_beta_rad, settings.room_alpha_rad)
        self.learner = Perceptual(planning, limits_of(task, room_rad, docking=settings.goal == "dock"), task.actions)
        self._newest: dict[int, Newest] = {}
        """By robot."""
        self._compile()

    def feed(self, frame: Frame, robot: int = 0) -> bool:
        """One frame of a robot, each robot's in order; True if a new plan has become complete."""
        newest = self._newest.setdefault(robot, Newest())
        gap = newest.capture_ns >= 0 and frame.capture_ns - newest.capture_ns > 1.5e9 * self._period_s
        newest.capture_ns = frame.capture_ns
        if gap:
            self.learner.close(robot)
            newest.speeds_mps.clear()
        newest.speeds_mps = [*newest.speeds_mps, frame.command[0]][-round(_RAMP_S / self._period_s) - 1 :]
        if frame.progress.training:
            stage = 2 * frame.progress.ended + frame.progress.learning
            self.learner.feed(self._seen(frame, newest), stage, robot)
        return self.learner.advance(self.settings.layers_per_frame)

    def table(self, version: int = 0) -> PolicyTable:
        """The newest complete plan, and its picture on the task's cells."""
        fine = self.learner.policy(version)
        action = np.full(self.grid.count, UNKNOWN, dtype=np.int8)
        value = np.zeros(self.grid.count)
        if fine is not None:
            states = self._centres()
            action = fine.act(states).astype(np.int8)
            value = self._values(fine, states)
        return PolicyTable(
            grid=self.grid,
            action=action,
            value=value,
            actions=self.learner.actions,
            version=version,
            method=self.settings.method,
            transitions=self.learner.memory.samples,
            table_sha256=self.digest(),
            fine=fine,
        )

    def digest(self) -> bytes:
        """SHA-256 of what is known."""
        return self.learner.digest()

    def save(self) -> bytes:
        """The whole state."""
        return self._saved(plan=True)

    def knowledge(self) -> bytes:
        """The state without a plan that is being made, for `load`: 0.3 instead of 8 MB."""
        return self._saved(plan=False)

    def _saved(self, *, plan: bool) -> bytes:
        header, arrays = self.learner.to_plain(plan=plan)
        newest = [[robot, kept.capture_ns, kept.speeds_mps] for robot, kept in sorted(self._newest.items())]
        packed = pack(_KIND, {**header, "method": self.settings.method, "newest": newest}, arrays)
        return zlib.compress(packed, 1)

    def load(self, state: bytes) -> None:
        """Take over what `save` gave, of a learner of the same task and settings.

        Raises:
            ValueError: it is not such a state; says why.
        """
        header, arrays = unpack(_decompressed(state), _KIND)
        if header.get("method") != self.settings.method:
            raise ValueError(f"learner state is of {header.get('method')!r}; it must be {self.settings.method!r}")
        newest = _newest(header.get("newest"))
        self.learner.from_plain(header, arrays)
        self._newest = newest

    def _seen(self, frame: Frame, newest: Newest) -> Seen | None:
        """What is learned from; left out is where the motors' response counts most, fast turns and changes of speed.

        They would be taken for a delay.
        """
        percept, (v, omega) = frame.percept, frame.command
        fast = not (abs(v) <= _FASTEST_MPS and abs(omega) <= _FASTER * self._turn_rate_radps)  # true for NaN
        ramp = max(newest.speeds_mps) - min(newest.speeds_mps) > _RAMP_MPS
        if not percept.visible or fast or ramp:
            return None
        log = -math.log(math.tan(percept.tilt_rad))
        return Seen((percept.beta_rad, percept.alpha_rad, log), (v, omega))

    def _compile(self) -> None:
        """Sweep once over a few nodes, so that nothing is compiled while a robot drives."""
        size = SIZES["kinematic"]
        axes = Axes(1.0, 1.0, 0.5, 1.0, 3, 3, 2)
        planner = Planner(self.learner.planner.limits, axes, self.learner.planner.actions, self._period_s)
        planner.begin(RateModel("kinematic", np.zeros((3, 2, size))))
        planner.finish()
        planner.chosen()

    def _centres(self) -> NDArray[np.float64]:
        """(beta, alpha, ln d) in the middle of each cell, at the distance that is shown, [cells, 3]."""
        log = math.log(self._shown_d)
        return np.array([(*self.grid.centre(cell), log) for cell in range(self.grid.count)])

    def _values(self, fine: GridPolicy, states: NDArray[np.float64]) -> NDArray[np.float64]:
        """Goal's reward less the sampling periods to it; 0 where it is not reached, as in the paper's tables."""
        nodes = fine.axes.nearest(states)
        times_s = 0.5 * self.learner.half_seconds.reshape(-1)[nodes]
        value = np.maximum(self.settings.goal_reward - times_s / self._period_s, 1e-3)
        return np.where((nodes >= 0) & (times_s < LATE_S), value, 0.0)


def _decompressed(state: bytes) -> bytes:
    """At most one byte more than is unpacked.

    Raises:
        ValueError: it is nothing that was compressed.
    """
    try:
        return zlib.decompressobj().decompress(state, LARGEST_BYTES + 1)
    except zlib.error as error:
        raise ValueError(f"learner state is damaged: {error}") from None


def _newest(rows: Any) -> dict[int, Newest]:
    """By robot, out of nested lists as JSON gives them back.

    Raises:
        ValueError: they are nothing of the kind.
    """
    try:
        return {int(robot): Newest(int(capture_ns), [*map(float, speeds)]) for robot, capture_ns, speeds in rows}
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"learner state must have newest; got {rows!r}") from None
