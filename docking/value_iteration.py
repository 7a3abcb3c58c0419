"""Value iteration on nodes over (d, alpha, beta), compiled: semi-Lagrangian, Gauss-Seidel, nearest distance first.

Two values share the sweep. The *level* of a node is at most 0 where some policy reaches the goal and keeps out of the
sink: min(goal, max(sink, level of the best successor)). The *time* is the least time to the goal, LATE_S where it can
not be reached. Goal and sink are judged exactly where an action lands; only what comes after is interpolated. A move
does not depend on beta, so beta runs innermost with one set of weights.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from docking.levels import FAR, Limits, cell_level, dock_level, goal_level, sink_level

Floats = NDArray[np.float64]
Axes = tuple[Floats, Floats, Floats]
"""Nodes in beta, alpha (rad) and d (m, or any other unit that the limits have too)."""

LATE_S = 60.0
"""Time of a node from which the goal is not reached."""


@njit(nogil=True, cache=True, error_model="numpy")
def place(nodes: Floats, x: float) -> tuple[int, float]:
    """Index of the node below x and the share of the one above; the nearest end outside."""
    last = len(nodes) - 1
    position = min(max((x - nodes[0]) / (nodes[1] - nodes[0]), 0.0), float(last))
    below = min(int(position), last - 1)
    return below, position - below


@njit(nogil=True, cache=True, error_model="numpy")
def promised(timed: bool, dt: float, goal: float, sink: float, onward: float) -> float:
    """Value of an action that lands at these levels, and from where `onward` is the value."""
    if not timed:
        return min(goal, max(sink, onward))
    return dt if goal <= 0.0 else LATE_S if sink > 0.0 else dt + onward


@njit(nogil=True, cache=True, error_model="numpy")
def goal_line(goal: Floats, limits: Limits, beta: Floats, shift: float, alpha: float, d: float) -> None:
    """`goal_level` at beta + shift, into `goal` [beta nodes]: one branch outside the loop, so that it runs fast."""
    if not limits.docking:
        for b in range(len(beta)):
            goal[b] = cell_level(limits, beta[b] + shift, alpha, d)
    else:
        for b in range(len(beta)):
            goal[b] = dock_level(limits, beta[b] + shift, alpha, d)


@njit(nogil=True, cache=True, error_model="numpy")
def onward_line(onward: Floats, line: Floats, value: Floats, axes: Axes, move: Floats) -> None:
    """Value where an action lands, from each beta of one (alpha, d), into `onward` [beta nodes]; `line` is scratch."""
    beta, alpha, d = axes
    i, up = place(d, move[2])
    j, left = place(alpha, move[1])
    whole = math.floor(move[0] / (beta[1] - beta[0]))
    rest = move[0] / (beta[1] - beta[0]) - whole
    shares = ((1.0 - up) * (1.0 - left), (1.0 - up) * left, up * (1.0 - left), up * left)
    near_right, near_left, far_right, far_left = value[i, j], value[i, j + 1], value[i + 1, j], value[i + 1, j + 1]
    for b in range(len(beta)):
        line[b] = (
            shares[0] * near_right[b] + shares[1] * near_left[b] + shares[2] * far_right[b] + shares[3] * far_left[b]
        )
    last = len(beta) - 1
    for b in range(len(beta)):
        below, above = min(max(b + whole, 0), last), min(max(b + whole + 1, 0), last)
        onward[b] = (1.0 - rest) * line[below] + rest * line[above]


@njit(nogil=True, cache=True, error_model="numpy")
def lower(
    best: Floats, scratch: Floats, value: Floats, axes: Axes, move: Floats, limits: Limits, timed: bool, dt: float
) -> None:
    """Lower `best` [beta nodes] to what one action promises from one (alpha, d); `scratch` is [3, beta nodes]."""
    beta = axes[0]
    goal, onward = scratch[0], scratch[1]
    goal_line(goal, limits, beta, move[0], move[1], move[2])
    onward_line(onward, scratch[2], value, axes, move)
    for b in range(len(beta)):
        sink = sink_level(limits, beta[b] + move[0], move[1], move[2])
        best[b] = min(best[b], promised(timed, dt, goal[b], sink, onward[b]))


@njit(nogil=True, cache=True, error_model="numpy")
def keep_line(line: Floats, best: Floats, goal: Floats, timed: bool) -> float:
    """Put the values of one (alpha, d) into `line` [beta nodes]; the largest change."""
    change = 0.0
    for b in range(len(line)):
        arrived = timed and goal[b] <= 0.0
        new = 0.0 if arrived else min(best[b], LATE_S) if timed else min(goal[b], best[b], FAR)
        change = max(change, abs(new - line[b]))
        line[b] = new
    return change


@njit(nogil=True, cache=True, error_model="numpy")
def sweep(
    value: Floats,
    moves: Floats,
    axes: Axes,
    limits: Limits,
    timed: bool,
    durations: Floats,
    passes: int,
    settled: float,
    first: int = 0,
    last: int = 1 << 30,
) -> float:
    """Back up all nodes in place, each distance until it is `settled` or `passes` are done; the largest change.

    Each action is held for its duration, `[actions]` s. Only the distances from index `first` to before `last`, so that
    a sweep can be cut into slices.
    """
    beta, alpha, d = axes
    best, scratch = np.empty(len(beta)), np.empty((3, len(beta)))
    largest = 0.0
    for i in range(first, min(last, len(d))):
        for turn in range(passes):
            change = 0.0
            for count in range(len(alpha)):
                j = count if turn % 2 == 0 else len(alpha) - 1 - count
                best[:] = np.inf
                for action in range(moves.shape[2]):
                    lower(best, scratch, value, axes, moves[i, j, action], limits, timed, durations[action])
                goal_line(scratch[0], limits, beta, 0.0, alpha[j], d[i])
                change = max(change, keep_line(value[i, j], best, scratch[0], timed))
            largest = max(largest, change)
            if change < settled:
                break
    return largest


@njit(nogil=True, cache=True, error_model="numpy")
def interpolated(value: Floats, axes: Axes, b: float, a: float, far: float) -> float:
    """Trilinear interpolation at (b, a, far)."""
    k, along = place(axes[0], b)
    j, left = place(axes[1], a)
    i, up = place(axes[2], far)
    total = 0.0
    for corner in range(8):
        p, q, r = corner >> 2, (corner >> 1) & 1, corner & 1
        weight = (up if p else 1.0 - up) * (left if q else 1.0 - left) * (along if r else 1.0 - along)
        total += weight * value[i + p, j + q, k + r]
    return total


@njit(nogil=True, cache=True, error_model="numpy")
def look_up(value: Floats, axes: Axes, points: Floats) -> Floats:
    """`interpolated` at points [N, 3]: [N]."""
    return np.array([interpolated(value, axes, p[0], p[1], p[2]) for p in points])


@njit(nogil=True, cache=True, error_model="numpy")
def promises(times: Floats, axes: Axes, limits: Limits, landings: Floats, dt: float) -> Floats:
    """Time that each action promises whose dt ends at landings [N, actions, 3]: [N, actions] s."""
    found = np.empty(landings.shape[:2])
    for n in range(landings.shape[0]):
        for action in range(landings.shape[1]):
            b, a, d = landings[n, action]
            onward = interpolated(times, axes, b, a, d)
            found[n, action] = promised(True, dt, goal_level(limits, b, a, d), sink_level(limits, b, a, d), onward)
    return found


@njit(nogil=True, cache=True, error_model="numpy")
def fastest(times: Floats, moves: Floats, axes: Axes, limits: Limits, durations: Floats) -> NDArray[np.int8]:
    """Index of the action that promises the least time at each node; -1 where none promises to arrive.

    Each is held for its duration, `[actions]` s.

    Returns:
        [d nodes, alpha nodes, beta nodes].
    """
    beta, alpha, d = axes
    chosen = np.full((len(d), len(alpha), len(beta)), -1, np.int8)
    best, before, scratch = np.empty(len(beta)), np.empty(len(beta)), np.empty((3, len(beta)))
    for i in range(len(d)):
        for j in range(len(alpha)):
            best[:] = LATE_S
            for action in range(moves.shape[2]):
                before[:] = best
                lower(best, scratch, times, axes, moves[i, j, action], limits, True, durations[action])
                for b in range(len(beta)):
                    if best[b] < before[b]:
                        chosen[i, j, b] = action
    return chosen
