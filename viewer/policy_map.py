"""The learner's policy as two pictures: what it would do in each cell, and what it expects there."""

from __future__ import annotations

import math
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from components.pilot.messages import table_of
from docking.policy import UNKNOWN, PolicyTable
from schemas.policy_pb2 import Policy
from viewer.rate import Rate
from viewer.shown import Dots, Lines, Number, Picture, Point, Shown, What

SIDE_PX, LEFT_PX, BELOW_PX = 372, 44, 36
"""The cells' square, and the room for numbers left of it and below."""
HERE, GOAL = (255, 255, 255, 255), (255, 255, 255, 200)
_PAPER, _INK, _NOTHING = (24, 22, 20), (190, 190, 190), (52, 48, 46)
"""Blue, green, red, as OpenCV has it."""
_TURNS = np.array(((235, 111, 31), (60, 163, 242), (245, 183, 143), (158, 209, 249)), np.uint8)
"""Left, right; then the second speed or backwards, paler. The report's colours."""
_HELD_CELLS = 401 * 401

Image = NDArray[np.uint8]


class PolicyMap:
    """Draws a new policy now and then, and marks the robot in it."""

    def __init__(self, period_ns: int) -> None:
        """At most one drawing a period."""
        self._rate = Rate(period_ns)
        self._drawn: PolicyTable | None = None

    def policy(self, message: Policy, capture_ns: int, now_ns: int) -> list[Shown]:
        """A table; nothing if it comes too soon or is none that the pilot would take."""
        if message.beta_cells * message.alpha_cells > _HELD_CELLS or not self._rate.passes(now_ns):
            return []
        try:
            table = self._drawn = table_of(message)
        except ValueError:
            return []
        shown: dict[str, What] = {
            "policy/action": Picture(_png(_framed(actions(table), table)), "png"),
            "policy/value": Picture(_png(_framed(values(table), table)), "png"),
            "policy/action/goal": _goal(table),
            "policy/value/goal": _goal(table),
            "policy_size/known_percent": Number(100.0 * table.known / table.grid.count),
            "policy_size/transitions": Number(float(table.transitions)),
        }
        return [Shown(entity, capture_ns, what) for entity, what in shown.items()]

    def here(self, beta_rad: float, alpha_rad: float, capture_ns: int) -> list[Shown]:
        """The cell that the robot is in."""
        if self._drawn is None:
            return []
        at = place(self._drawn, beta_rad, alpha_rad)
        dot = Dots((at,) if at is not None else (), HERE, 5.0)
        return [Shown(f"policy/{name}/robot", capture_ns, dot) for name in ("action", "value")]


def place(table: PolicyTable, beta_rad: float, alpha_rad: float) -> Point | None:
    """Pixel of a percept: alpha to the right, beta upwards; None outside of the cells."""
    grid = table.grid
    if not (abs(beta_rad) <= grid.beta_range_rad and abs(alpha_rad) <= grid.alpha_range_rad):
        return None
    right = 0.5 + 0.5 * alpha_rad / grid.alpha_range_rad
    up = 0.5 + 0.5 * beta_rad / grid.beta_range_rad
    return LEFT_PX + SIDE_PX * right, SIDE_PX * (1.0 - up)


def actions(table: PolicyTable) -> Image:
    """One colour per action, `[beta_cells, alpha_cells, 3]`, beta upwards; grey where nothing is known."""
    colours = _TURNS[np.arange(len(table.actions)) % len(_TURNS)]
    return _upright(table, colours[np.maximum(table.action, 0)])


def values(table: PolicyTable) -> Image:
    """Expectation of each cell on viridis, as `actions`."""
    known = table.action != UNKNOWN
    least, most = (table.value[known].min(), table.value[known].max()) if known.any() else (0.0, 0.0)
    share = (table.value - least) / max(most - least, 1e-9)
    levels = np.clip(255 * share, 0, 255).astype(np.uint8)
    return _upright(table, cv2.applyColorMap(levels[:, None], cv2.COLORMAP_VIRIDIS)[:, 0])


def _upright(table: PolicyTable, colours: NDArray[Any]) -> Image:
    grid = table.grid
    known = (table.action != UNKNOWN)[:, None]
    cells = np.where(known, colours, np.array(_NOTHING, np.uint8)).astype(np.uint8)
    return cells.reshape(grid.beta_cells, grid.alpha_cells, 3)[::-1]


def _framed(cells: Image, table: PolicyTable) -> Image:
    """The cells as a square with its angles written beside it."""
    page = np.full((SIDE_PX + BELOW_PX, LEFT_PX + SIDE_PX, 3), _PAPER, np.uint8)
    page[:SIDE_PX, LEFT_PX:] = cv2.resize(cells, (SIDE_PX, SIDE_PX), interpolation=cv2.INTER_NEAREST)
    alpha_deg, beta_deg = math.degrees(table.grid.alpha_range_rad), math.degrees(table.grid.beta_range_rad)
    middle = LEFT_PX + SIDE_PX // 2
    for text, column in ((f"{-alpha_deg:.0f}", LEFT_PX), ("alpha, deg", middle - 36), (f"{alpha_deg:+.0f}", 388)):
        _write(page, text, column, SIDE_PX + 22)
    for text, row in ((f"{beta_deg:+.0f}", 14), ("beta", SIDE_PX // 2), (f"{-beta_deg:.0f}", SIDE_PX - 4)):
        _write(page, text, 2, row)
    return page


def _write(page: Image, text: str, column: int, row: int) -> None:
    cv2.putText(page, text, (column, row), cv2.FONT_HERSHEY_SIMPLEX, 0.45, _INK, 1, cv2.LINE_AA)


def _goal(table: PolicyTable) -> Lines:
    column, row = place(table, 0.0, 0.0) or (0.0, 0.0)
    arm = 6.0
    return Lines((((column - arm, row), (column + arm, row)), ((column, row - arm), (column, row + arm))), GOAL, 1.5)


def _png(image: Image) -> bytes:
    return bytes(cv2.imencode(".png", image)[1].tobytes())
