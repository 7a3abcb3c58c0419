"""What stands in the room: coloured quadrilaterals and the object. Static, built once."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from components.simulator.params import Params
from docking.pinhole import Array

Colour = tuple[float, float, float]
"""Blue, green, red in 0 .. 255."""

FLOOR_Z_M = -0.80
"""Floor below the object's centre: a table of 0.74 m."""
ROOM_M = (-4.5, 2.6, 4.0)
"""Wall behind the robot, wall behind the table, side walls at +- this."""
WALL_TOP_M = 2.0

FLOOR, WALL, RUG = (98.0, 106.0, 112.0), (182.0, 194.0, 200.0), (84.0, 112.0, 88.0)
TABLE, APRON, STRIPE = (112.0, 148.0, 178.0), (70.0, 92.0, 114.0), (22.0, 122.0, 242.0)
OBJECT: Colour = (58.0, 152.0, 30.0)
LEAF, TERRACOTTA, BLUE, RED = (92.0, 126.0, 98.0), (86.0, 122.0, 172.0), (170.0, 96.0, 50.0), (46.0, 48.0, 176.0)
YELLOW, VIVID_GREEN, VIVID_ORANGE = (52.0, 188.0, 206.0), (50.0, 170.0, 30.0), (20.0, 125.0, 245.0)

BOX_SIDES = 4
"""Front, left, right and top; the back is never seen."""
FACETS = 16
"""Flat sides that the object's mantle is drawn with."""
TO_LIGHT = np.array((-0.55, 0.45, 0.70))
"""Direction to the lamp, world: behind the robot, to the left, above."""


class Quads(NamedTuple):
    """Flat quadrilaterals, seen only from the side that their normal points to."""

    corners_m: Array
    """`[N, 4, 3]`, world."""
    normals: Array
    """`[N, 3]`, not of unit length."""
    colours: Array
    """`[N, 3]` blue, green, red."""

    def facing(self, here_m: Array) -> NDArray[np.bool_]:
        """Which of them show their front to a camera at `here_m` `[3]`; `[N]`."""
        return np.asarray(np.einsum("ij,ij->i", here_m - self.corners_m[:, 0], self.normals) > 0.0)


class Scene(NamedTuple):
    """All that stands still, the room first, then boxes."""

    quads: Quads
    room: int
    """How many of the quads are the room: drawn first, in their order."""
    boxes_m: Array
    """Where the boxes stand, `[B, 2]`; each has `BOX_SIDES` quads."""

    def order(self, here_m: Array) -> list[int]:
        """Indices of the quads in the order of drawing: the farthest box first."""
        order = list(range(self.room))
        for box_index in np.argsort(-np.hypot(*(self.boxes_m - here_m[:2]).T)).tolist():
            first = self.room + BOX_SIDES * box_index
            order.extend(range(first, first + BOX_SIDES))
        return order


Side = tuple[Array, Colour]
"""Corners `[4, 3]` m, counter-clockwise seen from outside, and paint."""


def quads(sides: list[Side]) -> Quads:
    """Quads of these sides."""
    corners_m = np.array([side for side, _ in sides])
    normals = np.cross(corners_m[:, 1] - corners_m[:, 0], corners_m[:, 2] - corners_m[:, 1])
    return Quads(corners_m, normals, np.array([colour for _, colour in sides]))


def flat(x_m: tuple[float, float], y_m: tuple[float, float], z_m: float) -> Array:
    """A level rectangle, seen from above, `[4, 3]`."""
    (x0, x1), (y0, y1) = x_m, y_m
    return np.array(((x0, y0, z_m), (x1, y0, z_m), (x1, y1, z_m), (x0, y1, z_m)))


def upright(x_m: float, y_m: tuple[float, float], z_m: tuple[float, float]) -> Array:
    """A rectangle across the docking direction, seen from the robot's side, `[4, 3]`."""
    (y0, y1), (z0, z1) = y_m, z_m
    return np.array(((x_m, y1, z0), (x_m, y0, z0), (x_m, y0, z1), (x_m, y1, z1)))


def box(x_m: float, y_m: float, base_z_m: float, size_m: tuple[float, float, float], colour: Colour) -> list[Side]:
    """A box standing at (x_m, y_m): depth, width, height; its sides shaded."""
    depth, width, height = size_m
    x, y = (x_m, x_m + depth), (y_m - width / 2, y_m + width / 2)
    z = (base_z_m, base_z_m + height)
    left = np.array(((x[1], y[1], z[0]), (x[0], y[1], z[0]), (x[0], y[1], z[1]), (x[1], y[1], z[1])))
    right = np.array(((x[0], y[0], z[0]), (x[1], y[0], z[0]), (x[1], y[0], z[1]), (x[0], y[0], z[1])))
    return [
        (upright(x[0], y, z), shaded(colour, 0.90)),
        (left, shaded(colour, 0.95)),
        (right, shaded(colour, 0.70)),
        (flat(x, y, z[1]), colour),
    ]


def shaded(colour: Colour, light: float) -> Colour:
    """A colour under less or more light."""
    blue, green, red = colour
    return blue * light, green * light, red * light


def scene(params: Params) -> Scene:
    """The room around the object."""
    room, boxes = _room(params), _boxes(params) if params.distractors else []
    sides = room + [side for sides in boxes for side in sides]
    stands_m = np.array([sides[-1][0].mean(axis=0)[:2] for sides in boxes]).reshape(-1, 2)
    return Scene(quads(sides), len(room), stands_m)


def _room(params: Params) -> list[Side]:
    edge_m, top_m = -params.edge_offset_m, params.table_z_m
    y = (-params.table_width_m / 2, params.table_width_m / 2)
    back, front, side = ROOM_M
    floor = [(flat((back, front), (-side, side), FLOOR_Z_M), FLOOR)]
    rug = [(flat((-2.4, -0.9), (-1.9, -0.7), FLOOR_Z_M), RUG)]
    stripe = upright(edge_m, y, (top_m - params.stripe_height_m, top_m))
    apron = upright(edge_m, y, (top_m - params.stripe_height_m - 0.05, top_m - params.stripe_height_m))
    painted = STRIPE if params.stripe else APRON
    table = [(flat((edge_m, edge_m + params.table_depth_m), y, top_m), TABLE), (apron, APRON), (stripe, painted)]
    return floor + (rug + _posters(front) if params.distractors else []) + table


def _posters(wall_x_m: float) -> list[Side]:
    return [
        (upright(wall_x_m, (0.5, 1.3), (0.0, 0.9)), LEAF),
        (upright(wall_x_m, (-1.2, -0.6), (0.1, 0.8)), TERRACOTTA),
        (upright(wall_x_m, (-2.6, -1.8), (0.2, 0.7)), BLUE),
        (upright(wall_x_m, (2.0, 2.5), (0.2, 0.9)), YELLOW),
    ]


def _boxes(params: Params) -> list[list[Side]]:
    """None of them hides the object from a robot in front of the table."""
    z = params.table_z_m
    return [
        box(0.30, 0.55, z, (0.20, 0.15, 0.22), LEAF),
        box(0.35, -0.45, z, (0.12, 0.20, 0.10), TERRACOTTA),
        box(0.22, 0.22, z, (0.06, 0.09, 0.12), RED),
        box(0.45, -0.05, z, (0.08, 0.25, 0.06), BLUE),
        box(0.25, -0.80, z, (0.10, 0.10, 0.16), YELLOW),
        box(0.20, -0.20, z, (0.01, 0.01, 0.01), VIVID_GREEN),
        box(0.25, 0.38, z, (0.02, 0.04, 0.02), VIVID_ORANGE),
    ]


def mantle(params: Params) -> tuple[Array, Quads, Array]:
    """The object about its own centre.

    Returns:
        rings `[2, FACETS, 3]` m (bottom, top), the facets of the mantle, and the light on each `[FACETS]`.
    """
    radius_m, half_m = 0.5 * params.object_diameter_m, 0.5 * params.object_height_m
    turns = 2.0 * math.pi * np.arange(FACETS) / FACETS
    ring = np.column_stack((radius_m * np.cos(turns), radius_m * np.sin(turns), np.zeros(FACETS)))
    up_m = np.array((0.0, 0.0, half_m))
    bottom, top = ring - up_m, ring + up_m
    after = np.roll(np.arange(FACETS), -1)
    sides = quads([(np.array((bottom[i], bottom[j], top[j], top[i])), OBJECT) for i, j in enumerate(after.tolist())])
    outward = sides.normals / np.linalg.norm(sides.normals, axis=1, keepdims=True)
    return np.stack((bottom, top)), sides, 0.68 + 0.42 * np.clip(outward @ TO_LIGHT, 0.0, None)
