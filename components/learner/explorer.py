"""Where the model is trusted, and what is tried where it is not."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from components.learner.planner import Planner
from components.learner.regression import Fit
from docking.angles import DEG
from docking.grid_policy import UNKNOWN, paired
from docking.rates import FUNCTIONS

Floats = NDArray[np.float64]

_AHEAD_S = 1.0
"""A trial of an action must stay clear of the sink for so long."""
_MARGIN_RAD = 8.0 * DEG
_CLEARANCE = 1.3
"""Of the least distance."""


def doubts(fit: Fit, alpha_rad: Floats, d: Floats, actions: Floats) -> Floats:
    """Standard deviation of the rates of beta, alpha and ln d, the largest of the three, 1/s: `[d, alpha, actions]`."""
    far, bearing = np.meshgrid(d, alpha_rad, indexing="ij")
    known = FUNCTIONS[fit.structure.functions](bearing.ravel(), far.ravel())
    maps = fit.structure.matrix.reshape(3, 2, known.shape[1], -1)
    found = np.empty((len(known), len(actions)))
    for index, action in enumerate(actions):
        causes = known @ np.tensordot(action, maps, axes=(0, 1))  # [3, nodes, numbers]
        found[:, index] = np.sqrt(((causes @ fit.covariance) * causes).sum(axis=2).max(axis=0))
    return found.reshape(len(d), len(alpha_rad), len(actions))


class Trusted(NamedTuple):
    """What to do at each node."""

    table: NDArray[np.int8]
    """[d, alpha, beta]"""
    unsure: bool
    """Somewhere the model is worth learning more of."""


def trusted_actions(planner: Planner, fit: Fit, trust_per_s: float, known_per_s: float, *, explore: bool) -> Trusted:
    """The planner's action where the rates of all actions are known within `trust_per_s`; else UNKNOWN: no plan.

    Where they are not known within `known_per_s`, training tries the action that is known least, if that is safe.
    """
    doubt = doubts(fit, planner.nodes[1], planner.nodes[2], planner.actions)
    largest = doubt.max(axis=2)[:, :, None]
    unsure = largest > known_per_s
    table = np.where(largest > trust_per_s, UNKNOWN, planner.chosen()).astype(np.int8)
    if explore and unsure.any():
        table = paired(table, np.where(unsure, _tried(planner, doubt), UNKNOWN), len(planner.actions))
    return Trusted(table, bool(unsure.any()))


def _tried(planner: Planner, doubt: Floats) -> NDArray[np.int64]:
    """The safe action of the largest doubt at each node, UNKNOWN where none is safe."""
    limits, beta = planner.limits, planner.nodes[0]
    best, chosen = np.zeros(planner.axes.shape), np.full(planner.axes.shape, UNKNOWN)
    moves = planner.moves(_AHEAD_S)
    for action in range(len(planner.actions)):
        shift, alpha, d = np.moveaxis(moves[:, :, action], -1, 0)
        inside = (np.abs(alpha) < limits.alpha_range_rad - _MARGIN_RAD) & (d > _CLEARANCE * limits.d_min_m)
        inside &= d < limits.d_max_m
        safe = inside[:, :, None] & (np.abs(beta + shift[:, :, None]) < limits.beta_range_rad - _MARGIN_RAD)
        better = safe & (doubt[:, :, action, None] > best)
        chosen[better] = action
        best = np.where(better, doubt[:, :, action, None], best)
    return chosen
