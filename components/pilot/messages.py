"""The learner's policy message as a table."""

from __future__ import annotations

import math
import zlib

import numpy as np
from numpy.typing import NDArray

from docking.cells import Grid
from docking.grid_policy import LARGEST_NODES, Axes, GridPolicy
from docking.policy import PolicyTable
from docking.rates import SIZES, RateModel
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
        fine=_fine(policy, actions) if policy.HasField("fine") else None,
    )


def _fine(policy: Policy, actions: tuple[tuple[float, float], ...]) -> GridPolicy:
    fine = policy.fine
    axes = Axes(
        fine.beta_range_rad, fine.alpha_range_rad, fine.d_min, fine.d_max,
        fine.beta_nodes, fine.alpha_nodes, fine.d_nodes,
    )  # fmt: skip
    if math.prod(axes.shape) > LARGEST_NODES or len(fine.noise) != 3:
        raise ValueError(f"policy: there must be at most {LARGEST_NODES} nodes, and the noise of three numbers")
    return GridPolicy(
        axes=axes,
        action=_unpacked(fine.action_zlib, math.prod(axes.shape)).reshape(axes.shape),
        actions=actions,
        model=RateModel(
            fine.functions,
            _theta(fine.functions, list(fine.theta)),
            fine.delay_samples,
            (fine.noise[0], fine.noise[1], fine.noise[2]),
        ),
        docking=fine.docking,
        back_samples=fine.back_samples,
        version=policy.version,
        method=policy.method,
        samples=policy.transitions,
        table_sha256=policy.table_sha256,
    )


def _unpacked(data: bytes, size: int) -> NDArray[np.int8]:
    """So many bytes and no more, whatever the data would grow to."""
    stream = zlib.decompressobj()
    try:
        found = stream.decompress(data, size + 1)
    except zlib.error as error:
        raise ValueError(f"policy: action_zlib is damaged: {error}") from error
    if len(found) != size:
        raise ValueError(f"policy: action_zlib must hold {size} actions")
    return np.frombuffer(found, dtype=np.int8)


def _theta(functions: str, numbers: list[float]) -> NDArray[np.float64]:
    size = SIZES.get(functions, 0)
    if len(numbers) != 6 * size:
        raise ValueError(f"policy: theta must have {6 * size} numbers; got {len(numbers)}")
    return np.array(numbers).reshape(3, 2, size)
