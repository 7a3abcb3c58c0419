"""The model: where each (cell, action) leads, as weights over successor cells, and its mean reward."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from components.learner.mean_filter import MeanFilter
from components.learner.settings import Rewards, Settings
from components.learner.transition import Transition
from docking.cells import SINK, Grid


class Model:
    """Arrays that a sweep reads; a pair is `cell * actions + action`. Subclasses say what is filtered.

    Attributes:
        successor: [pairs, slots] uint32, cell; `grid.count` stands for the sink. Unsigned: an index without a sign
            needs no wraparound check, which costs the sweep a quarter of its speed.
        weight: [pairs, slots], sums to 1 over the first `degree` slots.
        degree: [pairs] int32, slots in use; 0 = never tried.
        reward: [pairs], mean reward of a transition.
        visits: [pairs] int32, transitions that entered, mirrored ones included.
    """

    slots: int
    entries: int
    mirrored_entries: float | NDArray[np.float64] = 1.0
    """Factor of each filtered entry when beta and alpha change sign."""

    def __init__(self, grid: Grid, actions: int, settings: Settings) -> None:
        self.grid = grid
        self.actions = actions
        self.reach = settings.adjoining_cells
        self.rewards = Rewards(settings.goal_reward, settings.sink_reward)
        pairs = grid.count * actions
        self.successor = np.zeros((pairs, self.slots), dtype=np.uint32)
        self.weight = np.zeros((pairs, self.slots))
        self.degree = np.zeros(pairs, dtype=np.int32)
        self.reward = np.zeros(pairs)
        self.visits = np.zeros(pairs, dtype=np.int32)
        self.mean = np.zeros((pairs, self.entries))
        self.variance = np.zeros(pairs)
        self._goal_pairs = slice(grid.goal * actions, (grid.goal + 1) * actions)
        self._filter = MeanFilter(settings.process_noise)

    def observe(self, transition: Transition) -> bool:
        """Filter one transition into the model; False if there is no room for its successor."""
        raise NotImplementedError

    def mirror(self, pair: int, image: int) -> None:
        """Make the pair `image`, of the mirrored cell and action, the mirror image of `pair`."""
        for array in (self.weight, self.degree, self.reward, self.visits, self.variance):
            array[image] = array[pair]
        self.mean[image] = self.mean[pair] * self.mirrored_entries
        successor = self.successor[pair]
        self.successor[image] = np.where(successor == self.grid.count, successor, self.grid.count - 1 - successor)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """The whole state, for `docking.arrays.pack`."""
        names = ("successor", "weight", "degree", "reward", "visits", "mean", "variance")
        return {name: getattr(self, name) for name in names}

    def check(self, arrays: Mapping[str, NDArray[Any]]) -> None:
        """See that arrays which come from outside lead from cells to cells.

        Raises:
            ValueError: they do not, or one is missing.
        """
        successor = checked(arrays, "successor", self.successor)
        degree = checked(arrays, "degree", self.degree)
        inside = (successor <= self.grid.count) & (degree >= 0)[:, None]
        if not inside.all() or (degree > self.slots).any() or degree[self._goal_pairs].any():
            raise ValueError("the model must lead from cells other than the goal to cells")

    def _filtered(self, pair: int, measured: NDArray[np.float64]) -> NDArray[np.float64]:
        mean, self.variance[pair] = self._filter.update(self.mean[pair], float(self.variance[pair]), measured)
        self.mean[pair] = mean
        self.visits[pair] += 1
        return mean


class ExitModel(Model):
    """Filters the exits: a vector with a 1 at the cell entered, and the reward. Its average are relative counts.

    Successors are stored by index, never as a mean of positions: averaged exits through different faces fall back
    into the cell itself.
    """

    def __init__(self, grid: Grid, actions: int, settings: Settings) -> None:
        self.slots = 32 if settings.hold_periods else 8 * settings.adjoining_cells + 1
        self.entries = self.slots + 1
        super().__init__(grid, actions, settings)

    def observe(self, transition: Transition) -> bool:
        """Filter one transition into the model; False if there is no room for its successor."""
        pair = transition.cell * self.actions + transition.action
        slot = self._slot(pair, self.grid.count if transition.next_cell == SINK else transition.next_cell)
        if slot is None:
            return False
        measured = np.zeros(self.entries)
        measured[slot] = 1.0
        measured[-1] = self.rewards.of(transition.next_cell, self.grid.goal, transition.periods)
        mean = self._filtered(pair, measured)
        self.weight[pair] = mean[:-1]
        self.reward[pair] = mean[-1]
        return True

    def _slot(self, pair: int, successor: int) -> int | None:
        used = int(self.degree[pair])
        for slot in range(used):
            if self.successor[pair, slot] == successor:
                return slot
        if used == self.slots:
            return None
        self.successor[pair, used] = successor
        self.degree[pair] += 1
        return used


class DisplacementModel(Model):
    """Filters the change of the continuous state: the paper's successor, relative to where the action began.

    Filtered with it: its duration, and how often it ended the trial for being too close.

    The successor is where the mean motion, begun at the cell's centre, has changed the cell by exactly k: a point on
    the ring of cells at distance k, shared between the two cells of the ring that it lies between. So a drift of a
    tenth of a cell per transition weighs a tenth, and no weight ever falls on the cell itself. Two bends of the path
    average to their chord, and jitter across a boundary averages out.
    """

    slots = 5
    entries = 4
    mirrored_entries = np.array([-1.0, -1.0, 1.0, 1.0])
    _LEAST_CHANGE = 0.02
    """Cells; motion that averages to less is treated as this much."""

    def __init__(self, grid: Grid, actions: int, settings: Settings) -> None:
        super().__init__(grid, actions, settings)
        self.adjoining = settings.hold_periods == 0

    def observe(self, transition: Transition) -> bool:
        """Filter one transition into the model."""
        pair = transition.cell * self.actions + transition.action
        grid = self.grid
        measured = np.array(
            [
                transition.beta_change_rad * (0.5 * grid.beta_cells / grid.beta_range_rad),
                transition.alpha_change_rad * (0.5 * grid.alpha_cells / grid.alpha_range_rad),
                transition.motion_periods,
                float(transition.too_close),
            ]
        )
        self._lead(transition.cell, pair, self._filtered(pair, measured))
        return True

    def _lead(self, cell: int, pair: int, mean: NDArray[np.float64]) -> None:
        rows, columns, periods, close = mean.tolist()
        scale = self.reach / max(abs(rows), abs(columns), self._LEAST_CHANGE) if self.adjoining else 1.0
        reward = close * self.rewards.sink
        self._set_slot(pair, 0, SINK, close)
        for slot, (row, column, share) in enumerate(self._shares(rows * scale, columns * scale), start=1):
            entered = self._neighbour(cell, row, column)
            self._set_slot(pair, slot, entered, (1.0 - close) * share)
            reward += (1.0 - close) * share * self.rewards.of(entered, self.grid.goal, periods * scale)
            self.degree[pair] = slot + 1
        self.reward[pair] = reward

    def _shares(self, rows: float, columns: float) -> Shares:
        return ring_shares(rows, columns, self.reach) if self.adjoining else square_shares(rows, columns)

    def _set_slot(self, pair: int, slot: int, entered: int, weight: float) -> None:
        self.successor[pair, slot] = self.grid.count if entered == SINK else entered
        self.weight[pair, slot] = weight

    def _neighbour(self, cell: int, rows: int, columns: int) -> int:
        row, column = divmod(cell, self.grid.alpha_cells)
        row, column = row + rows, column + columns
        inside = 0 <= row < self.grid.beta_cells and 0 <= column < self.grid.alpha_cells
        return row * self.grid.alpha_cells + column if inside else SINK


Shares = tuple[tuple[int, int, float], ...]
"""Of a point between cells: (rows, columns, share) of each cell around it, relative to where it came from."""


def ring_shares(rows: float, columns: float, reach: int) -> Shares:
    """The two cells at Chebyshev distance `reach` next to a point whose larger coordinate is `reach`.

    A point nearer than that is pushed out along its larger coordinate.
    """
    along_columns = abs(columns) >= abs(rows)
    other = rows if along_columns else columns
    outward = int(math.copysign(reach, columns if along_columns else rows))
    low = min(math.floor(abs(other)), reach - 1)
    share = min(1.0, abs(other) - low)  # rounding may carry it past the corner
    sign = int(math.copysign(1, other))
    near, far = sign * low, sign * (low + 1)
    if along_columns:
        return (near, outward, 1.0 - share), (far, outward, share)
    return (outward, near, 1.0 - share), (outward, far, share)


def square_shares(rows: float, columns: float) -> Shares:
    """The four cells around a point, weighted bilinearly; the cell itself may be one of them."""
    row, column = math.floor(rows), math.floor(columns)
    down, right = rows - row, columns - column
    return (
        (row, column, (1.0 - down) * (1.0 - right)),
        (row, column + 1, (1.0 - down) * right),
        (row + 1, column, down * (1.0 - right)),
        (row + 1, column + 1, down * right),
    )


def checked(arrays: Mapping[str, NDArray[Any]], name: str, like: NDArray[Any]) -> NDArray[Any]:
    """The array of this name, if it has shape and type of another and is finite.

    Raises:
        ValueError: it is missing or does not fit.
    """
    if name not in arrays:
        raise ValueError(f"the array {name} is missing")
    array = arrays[name]
    if array.shape != like.shape or array.dtype != like.dtype:
        raise ValueError(f"{name} must be {like.dtype} {like.shape}; got {array.dtype} {array.shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} must be finite")
    return array
