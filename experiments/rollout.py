"""Driving the kinematic plant, compiled: one training trial, or many evaluation starts, with any controller.

A controller is a table of action indices over cells; where it says -1, another rule decides (named in each function).
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from docking import cells, plant

Floats = NDArray[np.float64]
Actions = NDArray[np.int8]

MAX_STEPS = 4000
"""Samples in one trial; none needs 2,000, since the distance falls all the time within the ranges."""
MAX_TRANSITIONS = 4000

advance = njit(nogil=True)(plant.advance)
observe = njit(nogil=True)(plant.observe)
pose = njit(nogil=True)(plant.pose)
printed_rates = njit(nogil=True)(plant.printed_rates)
cell_of = njit(nogil=True)(cells.cell_of)


@njit(nogil=True, cache=True)
def step(
    printed: bool, beta: float, alpha: float, d: float, v: float, omega: float, dt: float
) -> tuple[float, float, float]:
    """(beta, alpha, d) after dt: an exact arc of the geometric plant, or a midpoint step of the printed equations."""
    if not printed:
        x, y, heading = pose(beta, alpha, d)
        x, y, heading = advance(x, y, heading, v, omega, dt)
        beta, alpha, d = observe(x, y, heading)
        return beta, alpha, d
    beta_rate, alpha_rate, d_rate = printed_rates(alpha, d, v, omega)
    middle = 0.5 * dt
    beta_rate, alpha_rate, d_rate = printed_rates(alpha + alpha_rate * middle, d + d_rate * middle, v, omega)
    return beta + beta_rate * dt, alpha + alpha_rate * dt, d + d_rate * dt


@njit(nogil=True, cache=True)
def shaken(value: float, share: float, rng: np.random.Generator) -> float:
    """A commanded speed or turn rate as a noisy plant executes it."""
    return value * (1.0 + share * rng.standard_normal()) if share > 0.0 else value


@njit(nogil=True, cache=True)
def dock(
    starts: Floats,
    table: Actions,
    actions: Floats,
    k_beta: float,
    k_alpha: float,
    turn_rate: float,
    keep_unknown: bool,
    printed: bool,
    ranges: Floats,
    shape: tuple[int, int],
    d_min: float,
    dt: float,
    noise: float,
    rng: np.random.Generator,
) -> Floats:
    """Time to the goal cell from each start, [starts] s; inf where the sink comes first.

    Args:
        starts: [starts, 3] beta rad, alpha rad, d m.
        table: [cells] action; where -1, omega = sat(k_beta beta + k_alpha alpha) at the first action's speed, or, with
            `keep_unknown`, the last action goes on (a start in such a cell begins with action start modulo actions).
        actions: [actions, 2] m/s, rad/s.
        k_beta: 1/s.
        k_alpha: 1/s.
        turn_rate: limit of the linear law, rad/s.
        keep_unknown: see table.
        printed: which plant.
        ranges: [2] rad, of beta and alpha.
        shape: cells along beta and alpha.
        d_min: m, sink.
        dt: s, sampling period.
        noise: standard deviation of speed and turn rate, as a share of them.
        rng: for the noise.
    """
    goal = (shape[0] // 2) * shape[1] + shape[1] // 2
    times = np.full(len(starts), np.inf)
    for start in range(len(starts)):
        beta, alpha, d = starts[start]
        last = start % len(actions)
        for k in range(MAX_STEPS):
            cell = cell_of(beta, alpha, ranges[0], ranges[1], shape[0], shape[1])
            if cell < 0 or d < d_min:
                break
            if cell == goal:
                times[start] = k * dt
                break
            action = table[cell]
            if action < 0 and keep_unknown:
                action = last
            if action >= 0:
                v, omega = actions[action]
                last = action
            else:
                v = actions[0, 0]
                omega = min(max(k_beta * beta + k_alpha * alpha, -turn_rate), turn_rate)
            v, omega = shaken(v, noise, rng), shaken(omega, noise, rng)
            beta, alpha, d = step(printed, beta, alpha, d, v, omega, dt)
    return times


@njit(nogil=True, cache=True)
def drive_trial(
    start: Floats,
    table: Actions,
    actions: Floats,
    explore: float,
    reach: int,
    hold: int,
    printed: bool,
    ranges: Floats,
    shape: tuple[int, int],
    d_min: float,
    dt: float,
    noise: float,
    percept_noise: float,
    rng: np.random.Generator,
) -> tuple[Floats, int, bool]:
    """One training trial, to the goal, the sink or d_min.

    An action is held until the cell has changed by `reach` (Chebyshev), or, with hold > 0, for so many samples. The
    next one is the table's, or, where that is -1 and with probability `explore` elsewhere, a random one.

    Returns:
        Transitions [n, 7] (cell, action, next cell or -1, periods, change of beta rad, of alpha rad, too close 0/1),
        samples driven, goal reached.
    """
    goal = (shape[0] // 2) * shape[1] + shape[1] // 2
    rows = np.empty((MAX_TRANSITIONS, 7))
    n, k = 0, 0
    beta, alpha, d = start
    seen_beta, seen_alpha = beta, alpha
    cell = cell_of(beta, alpha, ranges[0], ranges[1], shape[0], shape[1])
    while cell >= 0 and cell != goal and n < MAX_TRANSITIONS:
        action = table[cell]
        if action < 0 or (explore > 0.0 and rng.random() < explore):
            action = int(rng.random() * len(actions))
        from_beta, from_alpha, began, entered, near = seen_beta, seen_alpha, k, cell, False
        while k < MAX_STEPS:
            v, omega = shaken(actions[action, 0], noise, rng), shaken(actions[action, 1], noise, rng)
            beta, alpha, d = step(printed, beta, alpha, d, v, omega, dt)
            k += 1
            seen_beta, seen_alpha = beta, alpha
            if percept_noise > 0.0:
                seen_beta += percept_noise * rng.standard_normal()
                seen_alpha += percept_noise * rng.standard_normal()
            entered = cell_of(seen_beta, seen_alpha, ranges[0], ranges[1], shape[0], shape[1])
            near = d < d_min
            if entered < 0 or entered == goal or near:
                break
            if hold > 0:
                if k - began >= hold:
                    break
            elif changed(cell, entered, shape[1]) >= reach:
                break
        near = near and entered != goal and entered >= 0
        row = rows[n]
        row[0], row[1], row[2], row[3] = cell, action, -1 if near else entered, k - began
        row[4], row[5], row[6] = seen_beta - from_beta, seen_alpha - from_alpha, near
        n += 1
        cell = -1 if near or k >= MAX_STEPS else entered
    return rows[:n].copy(), k, cell == goal


@njit(nogil=True, cache=True)
def changed(a: int, b: int, columns: int) -> int:
    """Chebyshev distance between two cells."""
    return max(abs(a // columns - b // columns), abs(a % columns - b % columns))


@njit(nogil=True, cache=True, error_model="numpy")
def moves_of(printed: bool, alpha: Floats, d: Floats, actions: Floats, dt: float) -> Floats:
    """(change of beta, alpha, d) after each action held for dt: [d nodes, alpha nodes, actions, 3]."""
    moves = np.empty((len(d), len(alpha), len(actions), 3))
    for i in range(len(d)):
        for j in range(len(alpha)):
            for action in range(len(actions)):
                v, omega = actions[action]
                moves[i, j, action] = step(printed, 0.0, alpha[j], d[i], v, omega, dt)
    return moves


@njit(nogil=True, cache=True, error_model="numpy")
def landings_of(printed: bool, points: Floats, actions: Floats, dt: float) -> Floats:
    """Where each action leads in dt from each of points [N, 3]: [N, actions, 3]."""
    landings = np.empty((len(points), len(actions), 3))
    for n in range(len(points)):
        for action in range(len(actions)):
            v, omega = actions[action]
            landings[n, action] = step(printed, points[n, 0], points[n, 1], points[n, 2], v, omega, dt)
    return landings
