"""Our own methods as the component sees them: fed frame by frame, a table out."""

from __future__ import annotations

import hashlib
import math
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from components.learner.frame import Frame
from components.learner.perception import limits_of
from components.learner.perceptual import Perceptual, Planning, Seen
from components.learner.planner import Planner
from components.learner.ports import FLEET
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
class Robot:
    """One of those that learn, and what is remembered of its newest frames."""

    learner: Perceptual
    capture_ns: int = -1
    speeds_mps: list[float] = field(default_factory=list)
    """Commanded, this long: a ramp and one."""


class PerceptualMethod:
    """A learner of how percepts move. Nothing in it is random.

    Of several robots that are built alike each has its own rates and its own plan; what one has seen, all know.
    """

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
        self._planning, self._actions = planning, task.actions
        self._limits = limits_of(task, room_rad, docking=settings.goal == "dock")
        self._robots: dict[int, Robot] = {}
        self._compile()

    @property
    def learner(self) -> Perceptual:
        """The first robot's."""
        return self._robot(0).learner

    def feed(self, frame: Frame, robot: int = 0) -> bool:
        """One frame of a robot, each robot's in order; True if a new plan of its has become complete."""
        one = self._robot(robot)
        gap = one.capture_ns >= 0 and frame.capture_ns - one.capture_ns > 1.5e9 * self._period_s
        one.capture_ns = frame.capture_ns
        if gap:
            one.learner.close()
            one.speeds_mps.clear()
        one.speeds_mps = [*one.speeds_mps, frame.command[0]][-round(_RAMP_S / self._period_s) - 1 :]
        if frame.progress.training:
            stage = 2 * frame.progress.ended + frame.progress.learning
            one.learner.feed(self._seen(frame, one), stage)
        return one.learner.advance(self.settings.layers_per_frame)

    def table(self, version: int = 0, robot: int = 0) -> PolicyTable:
        """A robot's newest complete plan, and its picture on the task's cells."""
        learner = self._robot(robot).learner
        fine = learner.policy(version)
        action = np.full(self.grid.count, UNKNOWN, dtype=np.int8)
        value = np.zeros(self.grid.count)
        if fine is not None:
            states = self._centres()
            action = fine.act(states).astype(np.int8)
            value = self._values(fine, states, learner.half_seconds)
        return PolicyTable(
            grid=self.grid,
            action=action,
            value=value,
            actions=self._actions,
            version=version,
            method=self.settings.method,
            transitions=learner.memory.samples,
            table_sha256=learner.digest(),
            fine=fine,
        )

    def digest(self) -> bytes:
        """SHA-256 of what is known."""
        digests = [one.learner.digest() for _, one in sorted(self._robots.items())] or [self.learner.digest()]
        return digests[0] if len(digests) == 1 else hashlib.sha256(b"".join(digests)).digest()

    def save(self) -> bytes:
        """The whole state."""
        return self._saved(plan=True)

    def knowledge(self) -> bytes:
        """The state without a plan that is being made, for `load`: 0.3 instead of 8 MB."""
        return self._saved(plan=False)

    def _saved(self, *, plan: bool) -> bytes:
        headers: list[dict[str, Any]] = []
        arrays: dict[str, NDArray[Any]] = {}
        for number, one in sorted(self._robots.items()):
            header, own = one.learner.to_plain(plan=plan)
            headers.append({**header, "robot": number, "capture_ns": one.capture_ns, "speeds_mps": one.speeds_mps})
            arrays |= {f"{number}/{name}": array for name, array in own.items()}
        return zlib.compress(pack(_KIND, {"method": self.settings.method, "robots": headers}, arrays), 1)

    def load(self, state: bytes) -> None:
        """Take over what `save` gave, of a learner of the same task and settings; on an error nothing is changed.

        Raises:
            ValueError: it is not such a state; says why.
        """
        header, arrays = unpack(_decompressed(state), _KIND)
        if header.get("method") != self.settings.method:
            raise ValueError(f"learner state is of {header.get('method')!r}; it must be {self.settings.method!r}")
        self._robots = self._loaded(header, arrays)

    def _loaded(self, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> dict[int, Robot]:
        robots: dict[int, Robot] = {}
        try:
            for one in header["robots"]:
                number, speeds = int(one["robot"]), [*map(float, one["speeds_mps"])]
                if number in robots or number not in range(FLEET):
                    raise ValueError(f"learner state: robots must differ and be of 0..{FLEET - 1}; got {number}")
                learner = self._new_learner(robots)
                own = {name: array for name, array in arrays.items() if name.startswith(f"{number}/")}
                learner.from_plain(one, {name.partition("/")[2]: array for name, array in own.items()})
                robots[number] = Robot(learner, int(one["capture_ns"]), speeds)
        except (KeyError, TypeError, OverflowError) as error:
            raise ValueError(f"learner state is incomplete or mistyped: {error!r}") from error
        return robots

    def _robot(self, number: int) -> Robot:
        if number not in self._robots:
            self._robots[number] = Robot(self._new_learner(self._robots))
        return self._robots[number]

    def _new_learner(self, robots: Mapping[int, Robot]) -> Perceptual:
        """Of one more robot."""
        alike = next((one.learner for one in robots.values()), None)
        return Perceptual(self._planning, self._limits, self._actions, alike)

    def _seen(self, frame: Frame, robot: Robot) -> Seen | None:
        """What is learned from; left out is where the motors' response counts most, fast turns and changes of speed.

        They would be taken for a delay.
        """
        percept, (v, omega) = frame.percept, frame.command
        fast = not (abs(v) <= _FASTEST_MPS and abs(omega) <= _FASTER * self._turn_rate_radps)  # true for NaN
        ramp = max(robot.speeds_mps) - min(robot.speeds_mps) > _RAMP_MPS
        if not percept.visible or fast or ramp:
            return None
        log = -math.log(math.tan(percept.tilt_rad))
        return Seen((percept.beta_rad, percept.alpha_rad, log), (v, omega))

    def _compile(self) -> None:
        """Sweep once over a few nodes, so that nothing is compiled while a robot drives."""
        size = SIZES["kinematic"]
        axes = Axes(1.0, 1.0, 0.5, 1.0, 3, 3, 2)
        planner = Planner(self._limits, axes, np.array(self._actions), self._period_s)
        planner.begin(RateModel("kinematic", np.zeros((3, 2, size))))
        planner.finish()
        planner.chosen()

    def _centres(self) -> NDArray[np.float64]:
        """(beta, alpha, ln d) in the middle of each cell, at the distance that is shown, [cells, 3]."""
        log = math.log(self._shown_d)
        return np.array([(*self.grid.centre(cell), log) for cell in range(self.grid.count)])

    def _values(
        self, fine: GridPolicy, states: NDArray[np.float64], half_seconds: NDArray[np.int8]
    ) -> NDArray[np.float64]:
        """Goal's reward less the sampling periods to it; 0 where it is not reached, as in the paper's tables."""
        nodes = fine.axes.nearest(states)
        times_s = 0.5 * half_seconds.reshape(-1)[nodes]
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
