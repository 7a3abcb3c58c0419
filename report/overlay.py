"""The camera's picture with what vision found in it drawn over it."""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from schemas.view_pb2 import View

OBJECT, EDGE, CENTRE = (255, 255, 255), (255, 214, 0), (255, 255, 255)
"""Red, green, blue."""
Rgb = NDArray[np.uint8]


def camera_picture(jpeg: bytes, view: View | None, size_px: tuple[int, int]) -> Rgb | None:
    """The image, `[height, width, 3]`, with the object's centre and the table's edge; None if it is no image.

    Args:
        jpeg: as the camera gave it.
        view: what vision found in it; None draws nothing over it.
        size_px: width and height of the picture.
    """
    image = cv2.imdecode(np.frombuffer(jpeg or b"\0", np.uint8), cv2.IMREAD_COLOR)
    if image is None:
        return None
    scale = size_px[0] / image.shape[1]
    smooth = cv2.GaussianBlur(cv2.cvtColor(image, cv2.COLOR_BGR2RGB), (0, 0), 0.7)
    picture = cv2.resize(smooth, size_px, interpolation=cv2.INTER_CUBIC).astype(np.uint8)
    middle = (size_px[0] // 2, size_px[1] // 2)
    cv2.drawMarker(picture, middle, CENTRE, cv2.MARKER_CROSS, 18, 1, cv2.LINE_AA)
    if view is not None:
        _draw_edge(picture, view, scale)
        _draw_object(picture, view, scale)
    return picture


def _draw_edge(picture: Rgb, view: View, scale: float) -> None:
    if not (view.edge_visible and math.isfinite(view.edge_slope) and math.isfinite(view.edge_v_px)):
        return
    height, width = picture.shape[:2]
    column = width / 2 + scale * (view.object_u_px if view.object_visible else 0.0)
    row = height / 2 + scale * view.edge_v_px
    ends = [(x, _bounded(row + view.edge_slope * (x - column))) for x in (0, width)]
    cv2.line(picture, ends[0], ends[1], EDGE, 2, cv2.LINE_AA)


def _draw_object(picture: Rgb, view: View, scale: float) -> None:
    if not (view.object_visible and math.isfinite(view.object_u_px) and math.isfinite(view.object_v_px)):
        return
    height, width = picture.shape[:2]
    at = (_bounded(width / 2 + scale * view.object_u_px), _bounded(height / 2 + scale * view.object_v_px))
    radius = max(6, round(scale * math.sqrt(min(view.object_pixels, 100_000) / math.pi)))
    cv2.circle(picture, at, radius, OBJECT, 2, cv2.LINE_AA)


def _bounded(pixel: float) -> int:
    return round(min(max(pixel, -10_000.0), 10_000.0))
