"""The eyes: how well the table's edge is told with and without a stripe, and what it costs.

The stripe's line and the Hough line are judged each against its own true line, on the same disturbed images; the Hough
line also in a room without a stripe. Cost is processor time; the floor is OpenCV's decoder and the calls of the method.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.figure import Figure
from benchmarks.scenes import ORIGIN_M, Room, View, decoded
from components.simulator.params import Params as WorldParams
from components.vision import hough, jpeg
from components.vision.core import Eyes
from components.vision.params import Params
from docking.angles import DEG

FRAMES = 2000
OBJECTS, MARKERS = 1000, 500
TIMED, ROUNDS = 40, 15
WRONG_RAD = 1.0 * DEG
"""An edge further off is another line."""


class Edges(NamedTuple):
    """What one method made of many images."""

    error_rad: float
    """95 of 100 errors of the line's angle are smaller."""
    lost: int
    wrong: int


def figures() -> list[Figure]:
    """All of it."""
    cv2.setNumThreads(1)
    striped, plain = Room(WorldParams()), Room(WorldParams(stripe=False))
    views = list(striped.views(FRAMES))
    stripe = edges(striped, views, Params())
    beside = edges(striped, views, Params(edge="hough"))
    without = edges(plain, list(plain.views(FRAMES)), Params(edge="hough"))
    note = f"of {FRAMES} frames; lost {{}}, another line {{}}"
    return [
        _angle("stripe: slope error, 95 %", stripe, note),
        _angle("Hough beside it, same images", beside, note),
        _angle("Hough without a stripe", without, note),
        Figure("Hough / stripe, same images", beside.error_rad / stripe.error_rad, at_most=1.5),
        Figure("Hough without / stripe", without.error_rad / stripe.error_rad, at_most=1.5),
        Figure(
            "edges lost or wrong, Hough", float(beside.lost + beside.wrong + without.lost + without.wrong), at_most=0
        ),
        *_objects(),
        *_markers(),
        *_costs([view.data for view in plain.views(TIMED)]),
    ]


def _angle(name: str, found: Edges, note: str) -> Figure:
    return Figure(name, found.error_rad / DEG, "deg", note=note.format(found.lost, found.wrong))


def edges(room: Room, views: Sequence[View], params: Params) -> Edges:
    """The edge in all of them; object and edge must both be seen."""
    eyes, errors = Eyes(params), []
    for view in views:
        sight = eyes.look(decoded(view.data))
        if sight.spot is not None and sight.border is not None:
            _, slope = room.edge(view.camera, sight.spot.u_px, params.edge)
            errors.append(abs(np.arctan(sight.border.slope) - np.arctan(slope)))
    found = np.array(errors)
    if not len(found):
        return Edges(np.nan, len(views), 0)
    return Edges(float(np.percentile(found, 95)), len(views) - len(found), int((found > WRONG_RAD).sum()))


def _objects() -> list[Figure]:
    """The green can among green things, cut off by the image's border or gone."""
    found = []
    for edge in ("stripe", "hough"):
        room, eyes = Room(WorldParams(stripe=edge == "stripe")), Eyes(Params(edge=edge))
        true = sum(
            room.is_object(view.camera, eyes.look(decoded(view.data)).spot) for view in room.partial_views(OBJECTS)
        )
        false = sum(eyes.look(decoded(view.data)).spot is not None for view in room.empty_views(OBJECTS))
        found += [
            Figure(f"{edge}: object found, a quarter visible", true / OBJECTS, at_least=0.99),
            Figure(f"{edge}: false objects", float(false), f"of {OBJECTS}", at_most=0),
        ]
    return found


def _markers() -> list[Figure]:
    """A marker of 8 cm, from everywhere; the room without one; what its detector costs."""
    found = []
    for width in (320, 640):
        room = Room(WorldParams(object="marker", width_px=width))
        eyes = Eyes(Params(object="marker", width_px=width, height_px=width * 3 // 4))
        images = [(view.camera, decoded(view.data)) for view in room.views(MARKERS)]
        spots = [(camera, eyes.look(image).spot) for camera, image in images]
        away = [np.hypot(*(camera.project(ORIGIN_M[None])[0] - spot[:2])) for camera, spot in spots if spot]
        false = sum(eyes.look(decoded(view.data)).spot is not None for view in room.empty_views(MARKERS))
        note = f"middle off by {np.percentile(away, 95):.2f} px (95 %)"
        least = 0.99 if width == 640 else None
        found += [
            Figure(f"marker of 8 cm found, {width} px", len(away) / MARKERS, at_least=least, note=note),
            Figure(f"false markers, {width} px", float(false), f"of {MARKERS}", at_most=0),
            Figure(f"marker looked for, {width} px", _cost(eyes, [image for _, image in images[:TIMED]]), "ms"),
        ]
    return found


def _cost(eyes: Eyes, images: Sequence[NDArray[np.uint8]]) -> float:
    """Processor time of the best of a few rounds, ms an image, without decoding."""
    best = np.inf
    for _ in range(3):
        began_ns = time.thread_time_ns()
        for image in images:
            eyes.look(image)
        best = min(best, (time.thread_time_ns() - began_ns) * 1e-6 / len(images))
    return float(best)


def _costs(frames: Sequence[bytes]) -> list[Figure]:
    width, height = Params().width_px, Params().height_px
    stripe, lines = Eyes(Params()), Eyes(Params(edge="hough"))
    calls: dict[str, Callable[[bytes], object]] = {
        "stripe": lambda data: stripe.look(jpeg.decode(data, width, height)),
        "hough": lambda data: lines.look(jpeg.decode(data, width, height)),
        "plain": plain,
        "decoder": decoded,
    }
    best = dict.fromkeys(calls, np.inf)
    for _ in range(ROUNDS):
        for name, call in calls.items():
            best[name] = min(best[name], ms(call, frames))
    return [
        Figure("frame understood, stripe", best["stripe"], "ms", note=f"decoder alone {best['decoder']:.2f} ms"),
        Figure("frame understood, Hough", best["hough"], "ms", note=f"OpenCV's calls alone {best['plain']:.2f} ms"),
        Figure("the same / OpenCV's calls", best["hough"] / best["plain"], at_most=1.5),
    ]


def ms(call: Callable[[bytes], object], frames: Sequence[bytes]) -> float:
    """Processor time a frame."""
    began_ns = time.thread_time_ns()
    for data in frames:
        call(data)
    return (time.thread_time_ns() - began_ns) * 1e-6 / len(frames)


def plain(data: bytes) -> None:
    """What anyone would call for the same: decode, colour, patches, edges, lines."""
    image = decoded(data)
    blue, green, red = cv2.split(image)
    mask = cv2.threshold(cv2.subtract(green, cv2.max(red, blue)), 35, 255, cv2.THRESH_BINARY)[1]
    cv2.connectedComponentsWithStats(mask)
    marks = cv2.Canny(cv2.GaussianBlur(image, (3, 3), 0.0), hough.WEAK, hough.STRONG)
    cv2.HoughLines(marks, hough.RHO_PX, hough.THETA_RAD, 32)
