"""Sets of actions (v m/s, omega rad/s): the paper's two, and those of its future work."""

from __future__ import annotations

from collections.abc import Mapping

Actions = tuple[tuple[float, float], ...]
"""(v_mps, omega_radps) of each."""

ACTION_SETS: Mapping[str, tuple[float, ...]] = {"one-speed": (1.0,), "two-speeds": (1.0, 0.5), "reverse": (1.0, -1.0)}
"""Speeds as shares of the task's: the paper's; also half of it; also backwards."""


def action_set(name: str, speed_mps: float, turn_rate_radps: float) -> Actions:
    """Actions of a set, for a speed and a turn rate: turning left and right at each speed.

    Raises:
        KeyError: no such set.
    """
    return tuple((share * speed_mps, sign * turn_rate_radps) for share in ACTION_SETS[name] for sign in (1.0, -1.0))
