"""Least times to the goal in perceptual space, swept over a grid in slices."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from docking.grid_policy import Axes
from docking.levels import Limits
from docking.rates import RateModel
from docking.value_iteration import LATE_S, fastest, sweep

Floats = NDArray[np.float64]

SETTLED_S = 0.01
"""Sweeps end when no node's time changes by more."""
_SWEEPS = 300
"""More are not made; driving back and forth beside the goal settles slowly."""
_NODES_PER_BACKUP = 1.6
"""A backup looks so far ahead that the robot turns by so many nodes: shorter steps over wide nodes blur."""
_LONGEST_BACKUP = 8
"""Sampling periods."""


def axes_of(limits: Limits, angle_step_rad: float, d_step: float) -> Axes:
    """Nodes over the limits: an odd number along the angles, so that one is at 0."""
    beta, alpha = (
        2 * max(1, round(half / angle_step_rad)) + 1 for half in (limits.beta_range_rad, limits.alpha_range_rad)
    )
    layers = max(1, round((limits.d_max_m - limits.d_min_m) / d_step)) + 1
    return Axes(limits.beta_range_rad, limits.alpha_range_rad, limits.d_min_m, limits.d_max_m, beta, alpha, layers)


class Planner:
    """Value iteration with a learned model, from nothing for each model.

    Attributes:
        limits: goal and sink; lengths in camera heights.
        times_s: [d, alpha, beta nodes].
        model: that is planned with; None before the first.
        busy: the times have not settled yet.
    """

    def __init__(self, limits: Limits, axes: Axes, actions: Floats, period_s: float, back_s: float = 0.0) -> None:
        """Plan that driving backwards is done for at least `back_s` at a time."""
        self.limits, self.axes, self.actions, self.period_s = limits, axes, actions, period_s
        self.nodes = (
            np.linspace(-axes.beta_range_rad, axes.beta_range_rad, axes.beta_nodes),
            np.linspace(-axes.alpha_range_rad, axes.alpha_range_rad, axes.alpha_nodes),
            np.linspace(axes.d_min, axes.d_max, axes.d_nodes),
        )
        self.times_s = np.full(axes.shape, LATE_S)
        self.model: RateModel | None = None
        self.busy = False
        self._layer = self._sweeps = 0
        self._change = 0.0
        self._backwards = actions[:, 0] < 0.0
        self._back_s = back_s
        self._dt_s = period_s
        self._moves = np.empty(0)

    def aim(self, limits: Limits) -> None:
        """The next plan is for another goal, on the same nodes."""
        self.limits, self.model = limits, None

    def begin(self, model: RateModel) -> None:
        """Plan with another model."""
        self._set_model(model)
        self.times_s[:] = LATE_S
        self.busy, self._layer, self._sweeps, self._change = True, 0, 0, 0.0

    def advance(self, layers: int) -> bool:
        """Back up so many layers of equal d, unless the times have settled before; True once they have."""
        # Driving forwards, a distance depends on nearer ones only: settle it first.
        passes = 2 if self._backwards.any() else 60
        while self.busy and layers > 0:
            last = min(self._layer + layers, self.axes.d_nodes)
            change = sweep(
                self.times_s, self._moves, self.nodes, self.limits, True, self._durations(self._dt_s), passes,
                0.1 * SETTLED_S,
                self._layer, last,
            )  # fmt: skip
            layers -= last - self._layer
            self._change = max(self._change, float(change))
            self._layer = last
            if last == self.axes.d_nodes:
                self._end_sweep()
        return not self.busy

    def finish(self) -> None:
        """Plan to the end."""
        while not self.advance(self.axes.d_nodes):
            pass

    def chosen(self) -> NDArray[np.int8]:
        """Index of the fastest action at each node, [d, alpha, beta]; -1 where none arrives."""
        moves, durations = self._held(self.period_s), self._durations(self.period_s)
        found: NDArray[np.int8] = fastest(self.times_s, moves, self.nodes, self.limits, durations)
        return found

    def moves(self, dt_s: float, model: RateModel | None = None) -> Floats:
        """Where each action leads: `docking.rates.RateModel.moves` over the nodes, of another model or the planner's.

        Raises:
            ValueError: there is none.
        """
        model = model or self.model
        if model is None:
            raise ValueError("begin() gives the planner its model")
        return model.moves(self.nodes[1], self.nodes[2], self.actions, dt_s)

    def to_plain(self) -> dict[str, float]:
        """Where it is, beside the times and the model."""
        return {"busy": self.busy, "layer": self._layer, "sweeps": self._sweeps, "change": self._change}

    def restore(self, model: RateModel, times_s: Floats, plain: dict[str, float]) -> None:
        """Go on with a model at the times and the place that were saved."""
        self._set_model(model)
        self.times_s[:] = times_s
        self.busy, self._change = bool(plain["busy"]), float(plain["change"])
        self._layer, self._sweeps = int(plain["layer"]), int(plain["sweeps"])

    def _set_model(self, model: RateModel) -> None:
        self.model = model
        self._dt_s = self.period_s * self._backup_samples(model)
        self._moves = self._held(self._dt_s)

    def _durations(self, dt_s: float) -> Floats:
        return np.where(self._backwards, max(dt_s, self._back_s), dt_s)

    def _held(self, dt_s: float) -> Floats:
        """As `moves`, each action held for its duration."""
        moves = self.moves(dt_s)
        if self._backwards.any():
            moves[:, :, self._backwards] = self.moves(max(dt_s, self._back_s))[:, :, self._backwards]
        return moves

    def _backup_samples(self, model: RateModel) -> int:
        far = np.tile([0.0, 0.0, np.log(self.axes.d_max)], (len(self.actions), 1))
        turn_rad = float(np.abs(model.rates(far, self.actions)[:, 1]).mean()) * self.period_s
        step_rad = 2.0 * self.axes.alpha_range_rad / (self.axes.alpha_nodes - 1)
        return int(np.clip(round(_NODES_PER_BACKUP * step_rad / max(turn_rad, 1e-9)), 1, _LONGEST_BACKUP))

    def _end_sweep(self) -> None:
        self._sweeps += 1
        most = _SWEEPS if self._backwards.any() else 1
        self.busy = self._change >= SETTLED_S and self._sweeps < most
        self._layer, self._change = 0, 0.0
