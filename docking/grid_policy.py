"""A policy on a grid over (beta, alpha, d), d in camera heights: what the pilot runs where the distance counts."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from docking.arrays import pack, unpack
from docking.rates import RateModel

Floats = NDArray[np.float64]

UNKNOWN = -1
"""Action of a node that nothing is known about."""
TRIED = -2
"""Less its index: an action that is only tried, to learn."""
MOST_PAIRED = 10
"""With more actions no node has one for driving and another one for training: int8 holds no more pairs."""
LARGEST_NODES = 4_000_000
"""More is refused."""
LONGEST_HOLD = 32
"""Sampling periods for which an action may have to be held."""
_KIND = "grid policy"


@dataclass(frozen=True, slots=True)
class Axes:
    """Uniform nodes over +-beta, +-alpha and from d_min to d_max, both ends included."""

    beta_range_rad: float
    alpha_range_rad: float
    d_min: float
    """Camera heights, as d_max."""
    d_max: float
    beta_nodes: int
    alpha_nodes: int
    d_nodes: int

    @property
    def shape(self) -> tuple[int, int, int]:
        """Of the tables: d, alpha, beta."""
        return self.d_nodes, self.alpha_nodes, self.beta_nodes

    def spans(self, beta_rad: float, alpha_rad: float) -> bool:
        """Whether the angles are within the ranges."""
        return abs(beta_rad) <= self.beta_range_rad and abs(alpha_rad) <= self.alpha_range_rad

    def nearest(self, states: Floats) -> NDArray[np.int64]:
        """Index into the flat table of the node next to (beta, alpha, ln d) `[N, 3]`; -1 outside the ranges: `[N]`."""
        spans = (
            (states[:, 0], -self.beta_range_rad, self.beta_range_rad, self.beta_nodes),
            (states[:, 1], -self.alpha_range_rad, self.alpha_range_rad, self.alpha_nodes),
            (np.exp(states[:, 2]), self.d_min, self.d_max, self.d_nodes),
        )
        inside = np.ones(len(states), dtype=np.bool_)
        indices = []
        for x, low, high, count in spans:
            step = (high - low) / (count - 1)
            inside &= (x >= low - step) & (x <= high + step)  # false for NaN; a node's step of grace
            index = np.where(np.isfinite(x), np.rint((np.clip(x, low, high) - low) / step), 0.0)
            indices.append(index.astype(np.int64))
        beta, alpha, d = indices
        return np.where(inside, (d * self.alpha_nodes + alpha) * self.beta_nodes + beta, -1)


@dataclass(frozen=True, eq=False)
class GridPolicy:
    """One action per node, and the rates that a delay is bridged with. Checked: it may come from a stranger.

    Raises:
        ValueError: shapes, ranges or actions that do not fit together, or numbers that are not finite.
    """

    axes: Axes
    action: NDArray[np.int8]
    """[d, alpha, beta] index into `actions`, UNKNOWN where nothing arrives or the model is not trusted. An action
    that is worth trying in training, in place of that or of none, is there as `paired` writes it."""
    actions: tuple[tuple[float, float], ...]
    """(v_mps, omega_radps) of each action."""
    model: RateModel
    docking: bool = True
    """It leads to the pick-up; else to the goal cell, at any distance."""
    back_samples: int = 0
    """An action that drives backwards is held for so many sampling periods; 0 = as any other."""
    version: int = 0
    method: str = ""
    samples: int = 0
    """Frames learned from."""
    table_sha256: bytes = field(default=b"")
    """Of the learner's table of times."""

    def __post_init__(self) -> None:
        axes = self.axes
        ranges = (axes.beta_range_rad, axes.alpha_range_rad)
        _require(all(0.0 < half <= math.pi for half in ranges), f"ranges must be in (0, pi] rad; got {ranges}")
        _require(0.0 < axes.d_min < axes.d_max < math.inf, f"d must grow from above 0; got {axes.d_min}, {axes.d_max}")
        _require(min(axes.shape) >= 2, f"there must be at least 2 nodes along each axis; got {axes.shape}")
        _require(math.prod(axes.shape) <= LARGEST_NODES, f"there must be at most {LARGEST_NODES} nodes")
        _require(self.action.shape == axes.shape, f"action must be {axes.shape}; got {self.action.shape}")
        _require(self.action.dtype == np.int8, f"action must be int8; got {self.action.dtype}")
        _require(0 < len(self.actions) <= 127, f"there must be 1..127 actions; got {len(self.actions)}")
        _require(bool(np.isfinite(self.actions).all()), f"actions must be finite; got {self.actions}")
        least = lowest(len(self.actions))
        known = (self.action >= least) & (self.action < len(self.actions))
        _require(bool(known.all()), f"action must be in {least}..{len(self.actions) - 1}")
        _require(0 <= self.back_samples <= LONGEST_HOLD, f"back_samples must be in 0..{LONGEST_HOLD}")
        _require(self.version >= 0 and self.samples >= 0, "version and samples must be >= 0")

    def act(self, states: Floats, *, exploring: bool = False) -> NDArray[np.int64]:
        """Index of the action at (beta, alpha, ln d) `[N, 3]`; UNKNOWN outside or where nothing is known: `[N]`."""
        nodes = self.axes.nearest(states)
        found = np.where(nodes >= 0, self.action.reshape(-1)[nodes], UNKNOWN).astype(np.int64)
        driven, tried = np.divmod(TRIED - found, len(self.actions))
        return np.where(found <= TRIED, tried if exploring else driven + UNKNOWN, found)

    @property
    def known(self) -> int:
        """Number of nodes with an action to drive."""
        return int(np.count_nonzero((self.action >= 0) | (self.action <= TRIED - len(self.actions))))

    def to_bytes(self) -> bytes:
        """As a file's contents; equal policies give equal bytes."""
        axes, model = self.axes, self.model
        header = {
            "ranges": [axes.beta_range_rad, axes.alpha_range_rad, axes.d_min, axes.d_max],
            "nodes": [axes.beta_nodes, axes.alpha_nodes, axes.d_nodes],
            "actions": [list(action) for action in self.actions],
            "functions": model.functions,
            "delay_samples": model.delay_samples,
            "noise": list(model.noise),
            "docking": self.docking,
            "back_samples": self.back_samples,
            "version": self.version,
            "method": self.method,
            "samples": self.samples,
            "table_sha256": self.table_sha256.hex(),
        }
        return pack(_KIND, header, {"action": self.action, "theta": model.theta})

    @staticmethod
    def from_bytes(data: bytes) -> GridPolicy:
        """The policy that `to_bytes` wrote.

        Raises:
            ValueError: it is none, or not a valid one; says why.
        """
        header, arrays = unpack(data, _KIND)
        try:
            return GridPolicy(
                axes=_axes(header),
                action=arrays["action"],
                actions=tuple((float(v), float(omega)) for v, omega in header["actions"]),
                model=RateModel(
                    str(header["functions"]),
                    np.asarray(arrays["theta"], dtype=np.float64),
                    float(header["delay_samples"]),
                    _three(header["noise"]),
                ),
                docking=bool(header["docking"]),
                back_samples=int(header.get("back_samples", 0)),
                version=int(header["version"]),
                method=str(header["method"]),
                samples=int(header["samples"]),
                table_sha256=bytes.fromhex(header["table_sha256"]),
            )
        except (KeyError, TypeError, OverflowError) as error:
            raise ValueError(f"policy is incomplete or mistyped: {error!r}") from error


def lowest(actions: int) -> int:
    """The least number in a table of so many actions."""
    return TRIED + 1 - actions * (actions + 1 if actions <= MOST_PAIRED else 1)


def paired(driven: NDArray[np.int8], tried: NDArray[np.int64], actions: int) -> NDArray[np.int8]:
    """One table of two: what is driven (or UNKNOWN), and what is tried instead in training (UNKNOWN: the same)."""
    both = TRIED - tried - (actions * (driven.astype(np.int64) - UNKNOWN) if actions <= MOST_PAIRED else 0)
    return np.where(tried == UNKNOWN, driven, both).astype(np.int8)


def _axes(header: dict[str, Any]) -> Axes:
    beta_range, alpha_range, d_min, d_max = map(float, header["ranges"])
    beta, alpha, d = map(int, header["nodes"])
    return Axes(beta_range, alpha_range, d_min, d_max, beta, alpha, d)


def _three(values: Any) -> tuple[float, float, float]:
    a, b, c = map(float, values)
    return a, b, c


def _require(holds: bool, words: str) -> None:
    if not holds:
        raise ValueError(f"policy: {words}")
