"""The learner's policy message as a table."""

from __future__ import annotations

import math

import numpy as np

from docking.cells import Grid
from docking.policy import PolicyTable
from schemas.policy_pb2 import Policy

_FASTEST_MPS, _FASTEST_RADPS = 2.0, 2.0 * math.pi
"""Actions beyond this are not for a robot that docks."""


def table_of(policy: Policy) -> PolicyTable:
    """Read a message that may come from a stranger.

    Raises:
        ValueError: sizes that do not fit its own grid, unknown or absurd actions, numbers that are not finite.
    """
    if len(policy.action_v_mps) != len(policy.action_omega_radps):
        raise ValueError("policy: action_v_mps and action_omega_radps must have the same length")
    actions = tuple(zip(policy.action_v_mps, policy.action_omega_radps, strict=True))
    if any(not (abs(v) <= _FASTEST_MPS and abs(omega) <= _FASTEST_RADPS) for v, omega in actions):
        raise ValueError(f"policy: actions must be within {_FASTEST_MPS} m/s and {_FASTEST_RADPS:.2f} rad/s")
    return PolicyTable(
        grid=Grid(policy.beta_range_rad, policy.alpha_range_rad, policy.beta_cells, policy.alpha_cells),
        action=np.frombuffer(policy.action, dtype=np.int8),
        value=np.array(policy.value, dtype=np.float64),
        actions=actions,
        version=policy.version,
        method=policy.method,
        transitions=policy.transitions,
        table_sha256=policy.table_sha256,
    )
