"""The eyes under other lamps, with colours learned in one frame: the object cut off by the image's border or gone.

The edge's error under the worst lamp is judged by what the default stripe's is under the lamp that its colours are
tuned for. Cost is processor time over frames of all lamps; the floor is the plain calls of `benchmarks.vision`.
"""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np

from benchmarks.figure import Figure
from benchmarks.scenes import ORIGIN_M, Room, View, decoded
from benchmarks.vision import Edges, edges, ms, plain
from components.simulator.params import Params as WorldParams
from components.vision import jpeg, pointing
from components.vision.core import Eyes
from components.vision.params import Params
from docking.angles import DEG

LEARNED_K = 4000.0
LAMPS_K, LIGHTS = (2700.0, 3300.0, 4000.0, 5000.0, 6500.0), (0.1, 0.3, 1.0, 4.0)
FRAMES = 60
"""Of each kind, lamp and light."""
STRIPES = 400
"""From which the default stripe's error is told."""
TIMED, ROUNDS = 2, 10
"""Frames of each lamp and light, and how often they are looked at."""


class Seen(NamedTuple):
    """Under one lamp, or under all."""

    found: int
    false: int
    edges: Edges


def figures() -> list[Figure]:
    """With the stripe and without one, over all lamps and lights."""
    cv2.setNumThreads(1)
    room = Room(WorldParams())
    usual = edges(room, list(room.views(STRIPES)), Params())
    return [figure for edge in ("stripe", "hough") for figure in _figures(edge, usual.error_rad)]


def _figures(edge: str, usual_rad: float) -> list[Figure]:
    params = learned(edge)
    lights = [(lamp_k, light) for lamp_k in LAMPS_K for light in LIGHTS]
    seen = [_seen(edge, params, lamp_k, light) for lamp_k, light in lights]
    frames = FRAMES * len(seen)
    worst = np.nanmax([each.edges.error_rad for each in seen])
    lost, wrong = sum(each.edges.lost for each in seen), sum(each.edges.wrong for each in seen)
    found = sum(each.found for each in seen) / frames
    angle = f"where learned {_seen(edge, params, LEARNED_K, 1.0).edges.error_rad / DEG:.3f} deg"
    stripe = f"default stripe, usual lamp {usual_rad / DEG:.3f} deg"
    return [
        Figure(f"{edge}: object found, a quarter visible", found, at_least=0.99, note=f"{len(seen)} lamps and lights"),
        Figure(f"{edge}: false objects", float(sum(each.false for each in seen)), f"of {frames}", at_most=0),
        Figure(f"{edge}: slope error, 95 %, worst lamp", worst / DEG, "deg", note=angle),
        Figure(f"{edge}: the same / the stripe's", worst / usual_rad, at_most=1.5, note=stripe),
        Figure(
            f"{edge}: edges lost or wrong", (lost + wrong) / frames, at_most=0.01, note=f"{lost} lost, {wrong} wrong"
        ),
        _cost(edge, params, [view.data for light in lights for view in _views(edge, *light, TIMED)]),
    ]


def _views(edge: str, lamp_k: float, light: float, count: int) -> list[View]:
    return list(Room(WorldParams(lamp_k=lamp_k, light=light, stripe=edge == "stripe")).views(count))


def _cost(edge: str, params: Params, frames: list[bytes]) -> Figure:
    eyes = Eyes(params)
    mine = theirs = np.inf
    for _ in range(ROUNDS):
        mine = min(mine, ms(lambda data: eyes.look(jpeg.decode(data, params.width_px, params.height_px)), frames))
        theirs = min(theirs, ms(plain, frames))
    return Figure(f"{edge}: cost / OpenCV's calls", mine / theirs, at_most=1.5, note=f"{mine:.2f} ms, {theirs:.2f} ms")


def learned(edge: str) -> Params:
    """Pointed at object and stripe in one frame."""
    room = Room(WorldParams(lamp_k=LEARNED_K, stripe=edge == "stripe"))
    camera = room.camera(0.2, 1.0)
    image = decoded(room.view(camera).data)
    stripe_m = np.array((-room.params.edge_offset_m, 0.1, room.params.stripe_z_m))
    half = 0.5 * np.array((room.params.width_px - 1, room.params.height_px - 1))
    colours = []
    for point_m in (ORIGIN_M, stripe_m) if edge == "stripe" else (ORIGIN_M,):
        u_px, v_px = np.rint(camera.project(point_m[None])[0] + half).astype(int).tolist()
        colours.append(pointing.colour(image, pointing.around(u_px, v_px, room.params.width_px)))
    table = colours[1] if edge == "stripe" else ()
    return Params(edge=edge, object_colour=colours[0], table_colour=table)


def _seen(edge: str, params: Params, lamp_k: float, light: float) -> Seen:
    room, eyes = Room(WorldParams(lamp_k=lamp_k, light=light, stripe=edge == "stripe")), Eyes(params)
    found = sum(room.is_object(view.camera, eyes.look(decoded(view.data)).spot) for view in room.partial_views(FRAMES))
    false = sum(eyes.look(decoded(view.data)).spot is not None for view in room.empty_views(FRAMES))
    return Seen(found, false, edges(room, list(room.views(FRAMES)), params))
