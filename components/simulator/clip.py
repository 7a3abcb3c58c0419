"""Cuts a convex polygon to what a camera can see (Sutherland and Hodgman 1974)."""

from __future__ import annotations

import numpy as np

from docking.pinhole import Array


def clipped(seen_m: Array, near_m: float, reach: Array) -> Array:
    """The part of a polygon in front of the near plane and within |right| <= reach[0] depth, |down| <= reach[1] depth.

    Args:
        seen_m: corners in the camera's frame (right, down, depth), `[N, 3]`.
        near_m: smallest depth.
        reach: tangents of the half angles, `[2]`.

    Returns:
        corners `[M, 3]`, M = 0 if nothing is left.
    """
    across, along = float(reach[0]), float(reach[1])
    planes = [(0.0, 0.0, 1.0, near_m), (1.0, 0.0, across, 0.0), (-1.0, 0.0, across, 0.0)]
    planes += [(0.0, 1.0, along, 0.0), (0.0, -1.0, along, 0.0)]
    polygon: list[list[float]] = seen_m.tolist()
    for right, down, depth, offset in planes:
        heights = [right * x + down * y + depth * z - offset for x, y, z in polygon]
        polygon = _cut(polygon, heights)
    return np.array(polygon).reshape(-1, 3)


def _cut(polygon: list[list[float]], heights: list[float]) -> list[list[float]]:
    """Keep what has a positive height over a plane."""
    kept = []
    for here, after, height, next_height in zip(
        polygon, polygon[1:] + polygon[:1], heights, heights[1:] + heights[:1], strict=True
    ):
        if height >= 0.0:
            kept.append(here)
        if (height >= 0.0) != (next_height >= 0.0):
            share = height / (height - next_height)
            kept.append([a + share * (b - a) for a, b in zip(here, after, strict=True)])
    return kept
