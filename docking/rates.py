"""How a percept moves under a command, as a learner found it: rates of (beta, alpha, ln d), linear in the command.

d is the distance in camera heights, cot(tilt): no length is known. Angles are relative to the goal. A robot that
stands still sees nothing move, and turning the world about the object changes nothing but beta, so that the rates
depend on alpha, d and the command alone: rate_j = sum over k, c of theta[j, c, k] function_k(alpha, d) command_c.
The logarithm, since a percept's distance errs by a share of itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

ALPHA_DEGREE, LOG_DEGREE, TOTAL_DEGREE = 5, 4, 6
"""Of the polynomials, in alpha and in ln d. Sine and 1/d are met within 0.3 %."""
_ALPHA_SCALE_RAD, _LOG_SCALE = 1.4, 1.2
"""Polynomials run over about -1 .. 1."""
_MIDDLE_LOG = 0.4
"""ln d in the middle of the ranges: 1.5 camera heights."""
DEGREES = tuple((a, x) for x in range(LOG_DEGREE + 1) for a in range(ALPHA_DEGREE + 1) if a + x <= TOTAL_DEGREE)
"""Degrees in alpha and in ln d of each polynomial."""


def kinematic(alpha_rad: Floats, d: Floats) -> Floats:
    """(sin(alpha) / d, cos(alpha) / d, 1): what the motion of a camera on a rigid robot is made of, `[N, 3]`."""
    return np.stack([np.sin(alpha_rad) / d, np.cos(alpha_rad) / d, np.ones_like(d)], axis=-1)


def polynomial(alpha_rad: Floats, d: Floats) -> Floats:
    """Products of Chebyshev polynomials in alpha and ln d, `[N, len(DEGREES)]`: any smooth function."""
    a = np.clip(alpha_rad / _ALPHA_SCALE_RAD, -1.2, 1.2)
    x = np.clip((np.log(d) - _MIDDLE_LOG) / _LOG_SCALE, -1.2, 1.2)
    in_alpha, in_log = _chebyshev(a, ALPHA_DEGREE), _chebyshev(x, LOG_DEGREE)
    return np.stack([in_alpha[i] * in_log[j] for i, j in DEGREES], axis=-1)


FUNCTIONS: Mapping[str, Callable[[Floats, Floats], Floats]] = {"kinematic": kinematic, "polynomial": polynomial}
"""Of (alpha, d), by name."""
SIZES: Mapping[str, int] = {"kinematic": 3, "polynomial": len(DEGREES)}


@dataclass(frozen=True, eq=False)
class RateModel:
    """What was learned. Checked when it is made, so that it may come from a stranger.

    Raises:
        ValueError: unknown functions, another shape, numbers that are not finite.
    """

    functions: str
    """Key of `FUNCTIONS`."""
    theta: Floats
    """[3, 2, functions]: of beta, alpha and ln d (1/s), per m/s and per rad/s of the command."""
    delay_samples: float = 0.0
    """Sampling periods until a command is in force; need not be whole."""
    noise: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Standard deviation of a percept's beta, alpha (rad) and ln d."""

    def __post_init__(self) -> None:
        if self.functions not in FUNCTIONS:
            raise ValueError(f"rates: functions must be one of {', '.join(FUNCTIONS)}; got {self.functions!r}")
        if self.theta.shape != (3, 2, SIZES[self.functions]) or not np.isfinite(self.theta).all():
            raise ValueError(f"rates: theta must be finite, [3, 2, {SIZES[self.functions]}]; got {self.theta.shape}")
        if not 0.0 <= self.delay_samples <= 100.0 or not all(0.0 <= s < math.inf for s in self.noise):
            raise ValueError(f"rates: delay and noise must be >= 0; got {self.delay_samples} and {self.noise}")

    def rates(self, states: Floats, commands: Floats) -> Floats:
        """Of (beta, alpha, ln d) `[N, 3]` under commands `[N, 2]` (m/s, rad/s): `[N, 3]` per second."""
        known = FUNCTIONS[self.functions](states[:, 1], np.exp(states[:, 2]))
        per_command = known @ self.theta.reshape(6, -1).T
        forwards, turning = per_command[:, 0::2], per_command[:, 1::2]
        return np.asarray(forwards * commands[:, :1] + turning * commands[:, 1:])

    def moved(self, states: Floats, commands: Floats, dt_s: float) -> Floats:
        """(beta, alpha, ln d) `[N, 3]` after dt_s: one Runge-Kutta step of the fourth order."""
        first = self.rates(states, commands)
        second = self.rates(states + 0.5 * dt_s * first, commands)
        third = self.rates(states + 0.5 * dt_s * second, commands)
        last = self.rates(states + dt_s * third, commands)
        return np.asarray(states + dt_s / 6.0 * (first + 2.0 * second + 2.0 * third + last))

    def moves(self, alpha_rad: Floats, d: Floats, actions: Floats, dt_s: float) -> Floats:
        """Landing places as `docking.value_iteration.sweep` takes them: `[d nodes, alpha nodes, actions, 3]`.

        That is the change of beta, and the new alpha and d, of each action `[actions, 2]` held for dt_s.
        """
        shape = (len(d), len(alpha_rad), len(actions))
        states = np.zeros((*shape, 3))
        states[..., 1], states[..., 2] = alpha_rad[None, :, None], np.log(d)[:, None, None]
        commands = np.broadcast_to(actions, (*shape, 2)).reshape(-1, 2)
        moves = self.moved(states.reshape(-1, 3), commands, dt_s).reshape(*shape, 3)
        moves[..., 2] = np.exp(moves[..., 2])
        return moves


def _chebyshev(x: Floats, degree: int) -> list[Floats]:
    terms = [np.ones_like(x), x]
    for _ in range(degree - 1):
        terms.append(2.0 * x * terms[-1] - terms[-2])
    return terms
