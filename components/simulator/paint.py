"""Draws the scene through the true projection, antialiased, with corners to a sixteenth of a pixel."""

from __future__ import annotations

from typing import cast

import cv2
import numpy as np
from numpy.typing import NDArray

from components.simulator import lamp, scene
from components.simulator.clip import clipped
from components.simulator.panel import Panel
from components.simulator.params import Params
from docking.pinhole import Array, Camera

Image = NDArray[np.uint8]
Paint = tuple[float, float, float]

NEAR_M = 0.05
"""Nothing nearer to the camera is drawn."""
SHIFT = 4
"""Fractional bits of the corners: OpenCV draws at 1/16 px."""
GUARD = 16.0
"""Polygons are cut at this many half images from the centre: OpenCV's fixed-point corners overflow far outside."""
TOP_LIGHT = 1.05


class Painter:
    """One image after the other, from where the camera stands."""

    def __init__(self, params: Params) -> None:
        self._gains = tuple(params.brightness * gain for gain in lamp.gains(params.light, params.lamp_k))
        shape = (params.height_px, params.width_px, 3)
        self._centre = 0.5 * np.array((params.width_px - 1, params.height_px - 1))
        self._reach = GUARD * (self._centre + 1.0) / params.scaled_focal_px
        self._wall: Image = np.full(shape, self._paint(scene.WALL)).astype(np.uint8)
        self._scene = scene.scene(params)
        self._colours = [self._paint(cast("Paint", tuple(colour))) for colour in self._scene.quads.colours.tolist()]
        self._rings, self._sides, light = scene.mantle(params)
        self._mantle = [self._paint(scene.shaded(scene.OBJECT, share)) for share in light.tolist()]
        self._panel = Panel(params, self._gains) if params.object == "marker" else None
        self._top = self._paint(scene.shaded(scene.OBJECT, TOP_LIGHT))

    def _paint(self, colour: Paint) -> Paint:
        """A colour under the room's light, clipped as a sensor clips it."""
        return cast("Paint", tuple(min(255.0, part * gain) for part, gain in zip(colour, self._gains, strict=True)))

    def image(self, camera: Camera, object_m: Array) -> Image:
        """`[height, width, 3]` blue, green, red; `object_m` is the object's centre, world `[3]`."""
        image = self._wall.copy()
        self._draw_scene(image, camera)
        if self._panel is not None:
            self._panel.draw(image, camera, object_m)
        else:
            self._draw_object(image, camera, object_m)
        return image

    def _draw_scene(self, image: Image, camera: Camera) -> None:
        here_m = camera.position
        seen = (self._scene.quads.corners_m - here_m) @ camera.axes.T
        shown = self._scene.quads.facing(here_m) & _may_be_seen(seen, self._reach)
        whole, pixels = self._pixels(seen, camera.focal_px)
        for index in self._scene.order(here_m):
            if not shown[index]:
                continue
            if whole[index]:
                _fill(image, pixels[index], self._colours[index])
            else:
                self._fill_cut(image, seen[index], camera.focal_px, self._colours[index])

    def _draw_object(self, image: Image, camera: Camera, object_m: Array) -> None:
        here_m = camera.position - object_m
        rings = (self._rings - here_m) @ camera.axes.T
        whole, pixels = self._pixels(rings, camera.focal_px)
        if not whole.all():
            return
        bottom, top = pixels
        for side in np.flatnonzero(self._sides.facing(here_m)).tolist():
            after = (side + 1) % len(bottom)
            facet = np.array((bottom[side], bottom[after], top[after], top[side]))
            _fill(image, facet, self._mantle[side])
        if here_m[2] > self._rings[1, 0, 2]:
            _fill(image, top, self._top)

    def _pixels(self, seen: Array, focal_px: float) -> tuple[NDArray[np.bool_], NDArray[np.int32]]:
        """Which polygons `[N, M, 3]` need no cut, `[N]`, and the fixed-point corners of those, `[N, M, 2]`."""
        depth = np.maximum(seen[:, :, 2:], NEAR_M)
        held = np.abs(seen[:, :, :2]) <= self._reach * depth
        whole = np.all(held, axis=(1, 2)) & np.all(seen[:, :, 2] > NEAR_M, axis=1)
        return whole, self._fixed_point(np.where(whole[:, None, None], seen[:, :, :2] / depth, 0.0), focal_px)

    def _fixed_point(self, tangents: Array, focal_px: float) -> NDArray[np.int32]:
        return np.rint((focal_px * tangents + self._centre) * (1 << SHIFT)).astype(np.int32)

    def _fill_cut(self, image: Image, seen: Array, focal_px: float, paint: Paint) -> None:
        part = clipped(seen, NEAR_M, self._reach)
        if len(part):
            _fill(image, self._fixed_point(part[:, :2] / part[:, 2:], focal_px), paint)


def _fill(image: Image, corners: NDArray[np.int32], paint: Paint) -> None:
    cv2.fillConvexPoly(image, corners, paint, cv2.LINE_AA, SHIFT)


def _may_be_seen(seen: Array, reach: Array) -> NDArray[np.bool_]:
    """Polygons `[N, M, 3]` that do not lie wholly behind the camera or beyond one side of the view, `[N]`."""
    edge = reach / GUARD * np.maximum(seen[:, :, 2:], 0.0)
    aside = np.all(seen[:, :, :2] > edge, axis=1) | np.all(seen[:, :, :2] < -edge, axis=1)
    return np.asarray(np.any(seen[:, :, 2] > NEAR_M, axis=1) & ~np.any(aside, axis=1))
