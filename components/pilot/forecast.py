"""What a policy expects of a start before the robot moves: it drives the learned model from there and from around it.

Said is the share of dockings by Laplace's rule of succession, so that nothing is called certain, and their median time.
Where most fail, the shortest way straight back after which most would dock is looked for.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from components.pilot.evidence import Forecast
from components.pilot.rules import Rules
from docking.grid_policy import UNKNOWN, GridPolicy

Floats = NDArray[np.float64]

_AROUND = np.array(list(itertools.product((-1.0, 0.0, 1.0), repeat=3))) * (math.radians(2.0), math.radians(2.0), 0.02)
"""Offsets in beta, alpha (rad) and ln d, about as wrong as a plan's grid and a motor's lag are together, [27, 3]."""
_BACK_M, _FARTHEST = 0.1, 10
"""Ways back are tried in steps of this, so many."""
_NEAR = 1.17
"""Of the distance at the pick-up: from there on the landing decides ..."""
_BETA_RAD, _ALPHA_RAD = math.radians(4.0), math.radians(20.0)
"""... and docks from within so much."""
_LANDING_S = 1.0
"""Takes so long, about."""


def forecast(rules: Rules, policy: GridPolicy, state: Floats) -> Forecast:
    """From the state (beta, alpha, ln d) `[1, 3]`."""
    times_s = arrivals_s(rules, policy, state + _AROUND)
    share, arrived = _share(times_s), times_s[np.isfinite(times_s)]
    if share >= 0.5:
        return Forecast(share, float(np.median(arrived)))
    return Forecast(share, float(np.median(arrived)) if len(arrived) else 0.0, _back_off_m(rules, policy, state))


def arrivals_s(rules: Rules, policy: GridPolicy, states: Floats) -> Floats:
    """Time to the docking from each state `[N, 3]`, inf where the model does not dock: `[N]`.

    Actions are held as the pilot holds them; the delay is left out, since the pilot looks ahead over it.
    """
    params, commands = rules.params, np.array(policy.actions)
    step_s = params.fine_hold_samples * params.sampling_period_s
    back = max(1, round(policy.back_samples / params.fine_hold_samples))
    found, states = np.full(len(states), np.inf), states.copy()
    going, held = np.arange(len(states)), np.zeros(len(states), dtype=np.int64)
    action = np.zeros(len(states), dtype=np.int64)
    for step in range(math.ceil(params.trial_timeout_s / step_s)):
        there, lost = _judged(rules, policy, states[going])
        found[going[there]] = step * step_s + _LANDING_S
        going = going[~(there | lost)]
        if not len(going):
            break
        free = going[held[going] <= 0]
        action[free] = _chosen(rules, policy, states[free])
        held[free] = np.where(commands[action[free], 0] < 0.0, back, 1)
        held[going] -= 1
        states[going] = policy.model.moved(states[going], commands[action[going]], step_s)
    return found


def _judged(rules: Rules, policy: GridPolicy, states: Floats) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """(arrived, lost) of states `[N, 3]`."""
    beta, alpha, d = np.abs(states[:, 0]), np.abs(states[:, 1]), np.exp(states[:, 2])
    there = (d <= _NEAR / math.tan(rules.task.arrival_tilt_rad)) & (beta < _BETA_RAD) & (alpha < _ALPHA_RAD)
    axes = policy.axes
    inside = (beta <= axes.beta_range_rad) & (alpha <= axes.alpha_range_rad)  # false for NaN
    close = d * np.cos(beta) < 1.0 / math.tan(rules.task.tilt_limit_rad)
    return there, ~inside | close


def _chosen(rules: Rules, policy: GridPolicy, states: Floats) -> NDArray[np.int64]:
    """The policy's action or the law's `[N]`."""
    law, commands = rules.teacher, np.array(policy.actions)
    wanted = law.k_beta_per_s * states[:, 0] + law.k_alpha_per_s * states[:, 1]
    wanted = np.clip(wanted, -law.turn_rate_radps, law.turn_rate_radps)
    off = np.abs(commands[:, 1] - wanted[:, None]) - 1e-3 * commands[:, 0]
    chosen = policy.act(states)
    return np.where(chosen == UNKNOWN, off.argmin(axis=1), chosen)


def _share(times_s: Floats) -> float:
    return float((np.isfinite(times_s).sum() + 1) / (len(times_s) + 2))


def _back_off_m(rules: Rules, policy: GridPolicy, state: Floats) -> float:
    """Shortest way back after which most dock; 0 if none of those tried helps."""
    speed = rules.task.speed_mps
    states, behind = state + _AROUND, []
    for _ in range(_FARTHEST):
        states = policy.model.moved(states, np.tile([-speed, 0.0], (len(states), 1)), _BACK_M / speed)
        behind.append(states)
    times_s = arrivals_s(rules, policy, np.concatenate(behind)).reshape(_FARTHEST, -1)
    helps = [_share(row) >= 0.5 for row in times_s]
    return _BACK_M * (helps.index(True) + 1) if any(helps) else 0.0
