"""A policy as a table over cells, as the learner makes it and the pilot looks it up. No protobuf, no files."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from docking import grid_policy
from docking.arrays import pack, unpack
from docking.cells import SINK, Grid
from docking.grid_policy import GridPolicy

UNKNOWN = grid_policy.UNKNOWN
"""Action of a cell that the learner knows nothing about."""
LARGEST_CELLS = 1001
"""Along one axis; more is refused."""
_KIND = "policy"


def mirrored_actions(actions: Sequence[tuple[float, float]]) -> tuple[int, ...]:
    """For each action (v_mps, omega_radps) the index of (v_mps, -omega_radps).

    Raises:
        ValueError: an action has no mirror image among the actions.
    """
    places = {action: i for i, action in enumerate(actions)}
    try:
        return tuple(places[v, -omega] for v, omega in actions)
    except KeyError as error:
        raise ValueError(f"actions must contain the mirror image {error.args[0]}; got {list(actions)}") from error


@dataclass(frozen=True, eq=False)
class PolicyTable:
    """One action and one value per cell. Checked when it is made, so that it may come from a stranger.

    Raises:
        ValueError: shapes, ranges or actions that do not fit together, or numbers that are not finite.
    """

    grid: Grid
    """Cells about the goal; ranges in rad."""
    action: NDArray[np.int8]
    """[cells] index into `actions`, UNKNOWN where nothing is known."""
    value: NDArray[np.float64]
    """[cells] largest Q over the known actions; 0 where nothing is known."""
    actions: tuple[tuple[float, float], ...]
    """(v_mps, omega_radps) of each action."""
    version: int = 0
    method: str = ""
    transitions: int = 0
    """That entered the model so far."""
    table_sha256: bytes = field(default=b"")
    """Of the learner's whole value table."""
    fine: GridPolicy | None = None
    """The policy that knows the distance too; the cells are then its picture at one distance."""

    def __post_init__(self) -> None:
        grid = self.grid
        _require(
            0.0 < grid.beta_range_rad <= math.pi and 0.0 < grid.alpha_range_rad <= math.pi,
            f"ranges must be in (0, pi] rad; got {grid.beta_range_rad} and {grid.alpha_range_rad}",
        )
        for cells in (grid.beta_cells, grid.alpha_cells):
            _require(
                3 <= cells <= LARGEST_CELLS and cells % 2 == 1, f"cells must be odd, 3..{LARGEST_CELLS}; got {cells}"
            )
        for name, array in (("action", self.action), ("value", self.value)):
            _require(array.shape == (grid.count,), f"{name} must have {grid.count} entries; got shape {array.shape}")
        _require(self.action.dtype == np.int8, f"action must be int8; got {self.action.dtype}")
        _require(0 < len(self.actions) <= 127, f"there must be 1..127 actions; got {len(self.actions)}")
        _require(np.isfinite(self.actions).all(), f"actions must be finite; got {self.actions}")
        known = (self.action >= UNKNOWN) & (self.action < len(self.actions))
        _require(known.all(), f"action must be in -1..{len(self.actions) - 1}; got {self.action[~known][:3]}")
        _require(np.isfinite(self.value).all(), "value must be finite")
        _require(self.version >= 0 and self.transitions >= 0, "version and transitions must be >= 0")

    def act(self, beta_rad: float, alpha_rad: float) -> int | None:
        """Index of the action in the cell of (beta, alpha) relative to the goal; None outside or where unknown."""
        cell = self.grid.cell(beta_rad, alpha_rad)
        return None if cell == SINK else self.act_in(cell)

    def act_in(self, cell: int) -> int | None:
        """Index of the action in a cell; None where unknown."""
        action = int(self.action[cell])
        return None if action == UNKNOWN else action

    @property
    def known(self) -> int:
        """Number of cells with an action."""
        return int(np.count_nonzero(self.action != UNKNOWN))

    @property
    def mirror_faults(self) -> int:
        """Number of cells, goal aside, whose action is not the mirror image of the mirrored cell's; 0 = symmetric."""
        image = np.array([*mirrored_actions(self.actions), UNKNOWN], dtype=np.int8)
        wrong = image[self.action] != self.action[::-1]
        wrong[self.grid.goal] = False
        return int(np.count_nonzero(wrong))

    def to_bytes(self) -> bytes:
        """As a file's contents; equal tables give equal bytes."""
        grid = self.grid
        header = {
            "beta_range_rad": grid.beta_range_rad,
            "alpha_range_rad": grid.alpha_range_rad,
            "beta_cells": grid.beta_cells,
            "alpha_cells": grid.alpha_cells,
            "actions": [list(action) for action in self.actions],
            "version": self.version,
            "method": self.method,
            "transitions": self.transitions,
            "table_sha256": self.table_sha256.hex(),
        }
        arrays: dict[str, NDArray[Any]] = {"action": self.action, "value": self.value}
        if self.fine is not None:
            arrays["fine"] = np.frombuffer(self.fine.to_bytes(), dtype=np.int8)
        return pack(_KIND, header, arrays)

    @staticmethod
    def from_bytes(data: bytes) -> PolicyTable:
        """The table that `to_bytes` wrote.

        Raises:
            ValueError: it is none, or not a valid one; says why.
        """
        header, arrays = unpack(data, _KIND)
        try:
            return PolicyTable(
                grid=_grid(header),
                action=arrays["action"],
                value=np.asarray(arrays["value"], dtype=np.float64),
                actions=tuple((float(v), float(omega)) for v, omega in header["actions"]),
                version=int(header["version"]),
                method=str(header["method"]),
                transitions=int(header["transitions"]),
                table_sha256=bytes.fromhex(header["table_sha256"]),
                fine=GridPolicy.from_bytes(arrays["fine"].tobytes()) if "fine" in arrays else None,
            )
        except (KeyError, TypeError, OverflowError) as error:
            raise ValueError(f"policy is incomplete or mistyped: {error!r}") from error


def _grid(header: dict[str, Any]) -> Grid:
    return Grid(
        float(header["beta_range_rad"]),
        float(header["alpha_range_rad"]),
        int(header["beta_cells"]),
        int(header["alpha_cells"]),
    )


def _require(holds: bool | np.bool_, words: str) -> None:
    if not holds:
        raise ValueError(f"policy: {words}")
