"""Backups of Q from the model, compiled: the hot loops of planning.

A pair is `cell * actions + action`. q is [pairs], v is [cells + 1] with the sink's 0 at the end; v = max over actions.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Cells = NDArray[np.uint32]


@njit(nogil=True, cache=True)
def back_up(
    pair: int, q: Floats, v: Floats, successor: Cells, weight: Floats, degree: Ints, reward: Floats, rate: Floats
) -> None:
    """Q(pair) moves by its rate towards the mean reward plus the mean value of the successors (paper, eq. 4)."""
    target = reward[pair]
    for slot in range(degree[pair]):
        target += weight[pair, slot] * v[successor[pair, slot]]
    q[pair] += rate[pair] * (target - q[pair])


@njit(nogil=True, cache=True)
def best_value(cell: int, q: Floats, image: Ints) -> float:
    """Largest Q of a cell."""
    actions = image.size
    best: float = -np.inf
    for action in range(actions):
        best = max(best, q[cell * actions + action])
    return best


@njit(nogil=True, cache=True)
def copy_mirrored(cell: int, q: Floats, v: Floats, image: Ints) -> None:
    """Give the mirrored cell the values of a cell; `image` names the mirror image of each action."""
    actions = image.size
    other = v.size - 2 - cell
    for action in range(actions):
        q[other * actions + image[action]] = q[cell * actions + action]
    v[other] = v[cell]


@njit(nogil=True, cache=True)
def sweep(
    sweeps: int,
    mirror: bool,
    q: Floats,
    v: Floats,
    successor: Cells,
    weight: Floats,
    degree: Ints,
    reward: Floats,
    rate: Floats,
    image: Ints,
) -> None:
    """Back up every known (cell, action) so many times, in the order of the cells, each with the newest values.

    With `mirror` the second half of the cells is copied from the first, so the values are exactly symmetric. The
    middle cell is the goal: terminal, never backed up.
    """
    actions = image.size
    cells = v.size - 1
    goal = cells // 2
    last = goal if mirror else cells
    for _ in range(sweeps):
        for cell in range(last):
            known = False
            best = -np.inf
            for signed in range(cell * actions, (cell + 1) * actions):
                pair = np.uint64(signed)  # without a sign there is no check for negative indices: a fifth faster
                if degree[pair] > 0:
                    known = True
                    target = reward[pair]
                    for slot in range(np.uint64(degree[pair])):
                        target += weight[pair, slot] * v[successor[pair, slot]]
                    q[pair] += rate[pair] * (target - q[pair])
                best = max(best, q[pair])
            if known and cell != goal:
                v[cell] = best
                if mirror:
                    copy_mirrored(cell, q, v, image)


@njit(nogil=True, cache=True)
def sweep_by_priority(
    backups: int,
    mirror: bool,
    q: Floats,
    v: Floats,
    successor: Cells,
    weight: Floats,
    degree: Ints,
    reward: Floats,
    rate: Floats,
    image: Ints,
    priority: Floats,
    columns: int,
    reach: int,
) -> int:
    """Back up the pair of the largest priority, raise its predecessors', and so on (Moore and Atkeson 1993).

    Finds the largest by looking at all: 2,000 numbers in a row cost less than a heap. A cell has `columns` cells in its
    row; no pair leads further than `reach` cells. Returns the backups made.
    """
    actions = image.size
    cells = v.size - 1
    for made in range(backups):
        pair = int(np.argmax(priority))
        if priority[pair] <= 0.0:
            return made
        priority[pair] = 0.0
        cell = pair // actions
        back_up(pair, q, v, successor, weight, degree, reward, rate)
        before = v[cell]
        v[cell] = best_value(cell, q, image)
        change = abs(v[cell] - before)
        if mirror:
            copy_mirrored(cell, q, v, image)
            priority[(cells - 1 - cell) * actions + image[pair % actions]] = 0.0
        if change > 1e-6:
            raise_predecessors(cell, change, successor, weight, degree, priority, columns, reach, actions)
            if mirror:
                raise_predecessors(
                    cells - 1 - cell, change, successor, weight, degree, priority, columns, reach, actions
                )
    return backups


@njit(nogil=True, cache=True)
def raise_predecessors(
    cell: int,
    change: float,
    successor: Cells,
    weight: Floats,
    degree: Ints,
    priority: Floats,
    columns: int,
    reach: int,
    actions: int,
) -> None:
    """A pair that leads to the cell is as urgent as the share of the cell's change that reaches it."""
    for row in range(-reach, reach + 1):
        middle = (cell + row * columns) * actions
        first, last = middle - reach * actions, middle + (reach + 1) * actions
        for pair in range(max(0, first), min(degree.size, last)):
            for slot in range(degree[pair]):
                if successor[pair, slot] == cell:
                    priority[pair] = max(priority[pair], weight[pair, slot] * change)
