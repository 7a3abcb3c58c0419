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

from experiments.levels import FAR, goal_level, sink_level
from experiments.problem import Limits
from experiments.rollout import step

Floats = NDArray[np.float64]

LATE_S = 60.0
"""Time of a node from which the goal is not reached."""


@njit(nogil=True, cache=True)
def moves_of(printed: bool, alpha: Floats, d: Floats, actions: Floats, dt: float) -> Floats:
    """(change of beta, alpha, d) after each action held for dt: [d nodes, alpha nodes, actions, 3]."""
    moves = np.empty((len(d), len(alpha), len(actions), 3))
    for i in range(len(d)):
        for j in range(len(alpha)):
            for action in range(len(actions)):
                v, omega = actions[action]
                moves[i, j, action] = step(printed, 0.0, alpha[j], d[i], v, omega, dt)
    return moves


@njit(nogil=True, cache=True)
def place(nodes: Floats, x: float) -> tuple[int, float]:
    """Index of the node below x and the share of the one above; the nearest end outside."""
    last = len(nodes) - 1
    position = min(max((x - nodes[0]) / (nodes[1] - nodes[0]), 0.0), float(last))
    below = min(int(position), last - 1)
    return below, position - below


@njit(nogil=True, cache=True)
def promised(limits: Limits, timed: bool, dt: float, onward: float, beta: float, alpha: float, d: float) -> float:
    """Value of an action that lands at a point from which `onward` is the value."""
    goal, sink = goal_level(limits, beta, alpha, d), sink_level(limits, beta, alpha, d)
    if not timed:
        return min(goal, max(sink, onward))
    if goal <= 0.0:
        return dt
    return LATE_S if sink > 0.0 else dt + onward


@njit(nogil=True, cache=True)
def lower(
    best: Floats,
    value: Floats,
    beta: Floats,
    alpha: Floats,
    d: Floats,
    move: Floats,
    limits: Limits,
    timed: bool,
    dt: float,
) -> None:
    """Lower `best` [beta nodes] to what one action promises from one (alpha, d)."""
    i, up = place(d, move[2])
    j, left = place(alpha, move[1])
    whole = math.floor(move[0] / (beta[1] - beta[0]))
    rest = move[0] / (beta[1] - beta[0]) - whole
    near_right, near_left = value[i, j], value[i, j + 1]
    far_right, far_left = value[i + 1, j], value[i + 1, j + 1]
    weights = ((1.0 - up) * (1.0 - left), (1.0 - up) * left, up * (1.0 - left), up * left)
    last = len(beta) - 1
    for b in range(len(beta)):
        k, m = min(max(b + whole, 0), last), min(max(b + whole + 1, 0), last)
        below = (
            weights[0] * near_right[k]
            + weights[1] * near_left[k]
            + weights[2] * far_right[k]
            + weights[3] * far_left[k]
        )
        above = (
            weights[0] * near_right[m]
            + weights[1] * near_left[m]
            + weights[2] * far_right[m]
            + weights[3] * far_left[m]
        )
        onward = (1.0 - rest) * below + rest * above
        best[b] = min(best[b], promised(limits, timed, dt, onward, beta[b] + move[0], move[1], move[2]))


@njit(nogil=True, cache=True)
def at_node(limits: Limits, timed: bool, best: float, beta: float, alpha: float, d: float) -> float:
    """Value of a node whose best action promises `best`."""
    goal = goal_level(limits, beta, alpha, d)
    if timed:
        return 0.0 if goal <= 0.0 else min(best, LATE_S)
    return min(goal, best, FAR)


@njit(nogil=True, cache=True)
def sweep(
    value: Floats,
    moves: Floats,
    beta: Floats,
    alpha: Floats,
    d: Floats,
    limits: Limits,
    timed: bool,
    dt: float,
    passes: int,
    settled: float,
) -> float:
    """Back up all nodes in place, each distance until it is `settled` or `passes` are done; the largest change."""
    best = np.empty(len(beta))
    largest = 0.0
    for i in range(len(d)):
        for turn in range(passes):
            change = 0.0
            for step_j in range(len(alpha)):
                j = step_j if turn % 2 == 0 else len(alpha) - 1 - step_j
                best[:] = np.inf
                for action in range(moves.shape[2]):
                    lower(best, value, beta, alpha, d, moves[i, j, action], limits, timed, dt)
                for b in range(len(beta)):
                    new = at_node(limits, timed, best[b], beta[b], alpha[j], d[i])
                    change = max(change, abs(new - value[i, j, b]))
                    value[i, j, b] = new
            largest = max(largest, change)
            if change < settled:
                break
    return largest


@njit(nogil=True, cache=True)
def interpolated(value: Floats, beta: Floats, alpha: Floats, d: Floats, b: float, a: float, far: float) -> float:
    """Trilinear interpolation at (b, a, far)."""
    k, along = place(beta, b)
    j, left = place(alpha, a)
    i, up = place(d, far)
    total = 0.0
    for corner in range(8):
        p, q, r = corner >> 2, (corner >> 1) & 1, corner & 1
        weight = (up if p else 1.0 - up) * (left if q else 1.0 - left) * (along if r else 1.0 - along)
        total += weight * value[i + p, j + q, k + r]
    return total


@njit(nogil=True, cache=True)
def look_up(value: Floats, beta: Floats, alpha: Floats, d: Floats, points: Floats) -> Floats:
    """`interpolated` at points [N, 3]: [N]."""
    return np.array([interpolated(value, beta, alpha, d, p[0], p[1], p[2]) for p in points])


@njit(nogil=True, cache=True)
def fastest_actions(
    times: Floats,
    beta: Floats,
    alpha: Floats,
    d: Floats,
    limits: Limits,
    printed: bool,
    actions: Floats,
    dt: float,
    points: Floats,
) -> NDArray[np.int64]:
    """Index of the action that promises the least time from each of points [N, 3], looking one dt ahead: [N]."""
    chosen = np.zeros(len(points), np.int64)
    for n in range(len(points)):
        least = np.inf
        for action in range(len(actions)):
            b, a, far = step(
                printed, points[n, 0], points[n, 1], points[n, 2], actions[action, 0], actions[action, 1], dt
            )
            onward = interpolated(times, beta, alpha, d, b, a, far)
            time = promised(limits, True, dt, onward, b, a, far)
            if time < least:
                least, chosen[n] = time, action
    return chosen
