"""What all methods share: a table of Q over cells and actions, which transitions count, and the policy it gives."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from components.learner.model import checked
from components.learner.settings import Rewards, Settings
from components.learner.transition import Transition
from docking.arrays import pack, unpack
from docking.cells import SINK, Grid
from docking.policy import UNKNOWN, PolicyTable, mirrored_actions
from docking.task import Task

_KIND = "learner"


class Tabular:
    """A learner of Q over (cell, action). `observe` a transition, then `plan`, then look at the `table`.

    Attributes:
        q: [cells * actions].
        v: [cells + 1], largest Q of each cell; the last is the sink's, 0.
        image: [actions] int32, the mirror image of each action.
        transitions: that counted so far.
        dropped: that did not count: jumps, self-loops, the goal left again.
    """

    def __init__(self, task: Task, settings: Settings) -> None:
        self.settings = settings
        self.grid = Grid.of(task)
        self.actions = task.actions
        self.image = np.array(mirrored_actions(self.actions), dtype=np.int32)
        self.rewards = Rewards(settings.goal_reward, settings.sink_reward)
        self.q = np.full(self.grid.count * len(self.actions), settings.unknown_value)
        self.v = np.full(self.grid.count + 1, settings.unknown_value)
        self.v[[self.grid.goal, -1]] = 0.0
        self.transitions = 0
        self.dropped = 0

    def observe(self, transition: Transition) -> bool:
        """Take in a transition; True if it counts."""
        counts = self.counts(transition) and self._learn(transition)
        self.transitions += counts
        self.dropped += not counts
        return counts

    def plan(self) -> None:
        """Improve the values from what is remembered; a fixed amount of work."""

    def counts(self, transition: Transition) -> bool:
        """The adjoining property (eq. 5): the cell changed by exactly k. A sink or a fixed hold always counts.

        Coming too close inside the ranges counts only if the settings call it a sink.
        """
        ignored = transition.too_close and self.settings.too_close == "ignored"
        if ignored or transition.cell in (SINK, self.grid.goal):
            return False
        if self.settings.hold_periods or transition.next_cell == SINK:
            return True
        return self.grid.distance(transition.cell, transition.next_cell) == self.settings.adjoining_cells

    def table(self, version: int = 0) -> PolicyTable:
        """The greedy policy over the actions that were tried."""
        action, value = greedy(self.q, self.known, self.image, self.settings.mirror)
        return PolicyTable(
            grid=self.grid,
            action=action,
            value=value,
            actions=self.actions,
            version=version,
            method=self.settings.method,
            transitions=self.transitions,
            table_sha256=self.digest(),
        )

    def explorer(self) -> NDArray[np.int8]:
        """[cells] action of the largest Q, where what was never tried counts as `unknown_value`."""
        return greedy(self.q, np.ones(self.q.size, dtype=np.bool_), self.image, self.settings.mirror)[0]

    def digest(self) -> bytes:
        """SHA-256 of the value table, little-endian, C order."""
        return hashlib.sha256(self.q.astype("<f8").tobytes()).digest()

    def save(self) -> bytes:
        """The whole state."""
        header = {"transitions": self.transitions, "dropped": self.dropped, **self._identity()}
        return pack(_KIND, header, self._arrays())

    def knowledge(self) -> bytes:
        """What a snapshot keeps: the whole state, since its plans are made at once."""
        return self.save()

    def load(self, state: bytes) -> None:
        """Take over what `save` gave, of a learner of the same task and settings; on an error nothing is changed.

        Raises:
            ValueError: it is not such a state; says why.
        """
        header, arrays = unpack(state, _KIND)
        for name, own in self._identity().items():
            if header.get(name) != own:
                raise ValueError(f"learner state has {name} = {header.get(name)!r}; it must be {own!r}")
        counters = [header.get(name) for name in ("transitions", "dropped")]
        if not all(type(count) is int and count >= 0 for count in counters):
            raise ValueError(f"learner state must have counts of transitions; got {counters}")
        self._restore(arrays)
        self.transitions, self.dropped = header["transitions"], header["dropped"]

    @property
    def known(self) -> NDArray[np.bool_]:
        """[cells * actions], tried at least once."""
        raise NotImplementedError

    def _learn(self, transition: Transition) -> bool:
        raise NotImplementedError

    def _arrays(self) -> dict[str, NDArray[Any]]:
        return {"q": self.q, "v": self.v}

    def _restore(self, arrays: Mapping[str, NDArray[Any]]) -> None:
        fresh = [checked(arrays, name, own) for name, own in self._arrays().items()]
        for own, new in zip(self._arrays().values(), fresh, strict=True):
            own[...] = new

    def _identity(self) -> dict[str, Any]:
        grid, settings = self.grid, self.settings
        return {
            "method": settings.method,
            "model": settings.model,
            "cells": [grid.beta_cells, grid.alpha_cells],
            "ranges_rad": [grid.beta_range_rad, grid.alpha_range_rad],
            "actions": [list(action) for action in self.actions],
            "adjoining_cells": settings.adjoining_cells,
            "hold_periods": settings.hold_periods,
            "mirror": settings.mirror,
        }


def greedy(
    q: NDArray[np.float64], known: NDArray[np.bool_], image: NDArray[np.int32], mirror: bool
) -> tuple[NDArray[np.int8], NDArray[np.float64]]:
    """Action of the largest Q among the known ones, [cells] (UNKNOWN where there is none), and that Q (0 there).

    With `mirror` the second half of the cells is the image of the first, so that ties are broken symmetrically.
    """
    masked = np.where(known, q, -np.inf).reshape(-1, image.size)
    action = masked.argmax(axis=1).astype(np.int8)
    value = masked.max(axis=1)
    unknown = np.isneginf(value)
    action[unknown] = UNKNOWN
    value[unknown] = 0.0
    if mirror:
        half = len(action) // 2
        lookup = np.array([*image, UNKNOWN], dtype=np.int8)
        action[half + 1 :] = lookup[action[:half][::-1]]
    return action, value
