"""Cost of one camera frame: drawn, exposed and encoded by the simulator, decoded and understood by the eyes.

Processor time of one thread, the best of many rounds. The floor is OpenCV's own JPEG encoder and decoder on the same
images in the same rounds.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import cv2
import numpy as np

from benchmarks.figure import Figure
from components.simulator.paint import Painter
from components.simulator.params import Params as WorldParams
from components.simulator.sensor import Sensor
from components.simulator.world import World
from components.vision.component import Vision
from components.vision.params import Params as EyesParams
from docking.angles import DEG
from docking.starts import Start
from runtime.contract import Event
from schemas.image_pb2 import CompressedImage

STARTS = (Start(0.0, 0.0, 2.0), Start(0.0, 0.0, 0.3), Start(60 * DEG, 0.0, 0.6), Start(-45 * DEG, 0.3, 1.2))
"""Far, near, steep, and from the side."""
ROUNDS, CALLS = 25, 20


def figures() -> list[Figure]:
    """Means over the starts."""
    cv2.setNumThreads(1)
    costs = np.array([_costs(start) for start in STARTS]).mean(axis=0)
    frame, blurred, encoder, view, decoder = (float(cost) for cost in costs)
    return [
        Figure("frame rendered and encoded", frame, "ms", at_most=1.3, note=f"encoder alone {encoder:.2f} ms"),
        Figure("the same with motion blur", blurred, "ms", note="5 px across, 2 px down"),
        Figure("frame decoded and understood", view / decoder, "x decoder", at_most=3, note=f"{view:.2f} ms"),
    ]


def _costs(start: Start) -> tuple[float, ...]:
    params = WorldParams()
    world = World(params, start, 0)
    world.place(start)
    painter, sensor, eyes = Painter(params), Sensor(params, 1), Vision(EyesParams(), 0)
    chance = np.random.default_rng(1)

    def frame(motion_px: tuple[float, float] = (0.0, 0.0)) -> bytes:
        return sensor.expose(painter.image(world.camera, world.object_m), np.array(motion_px), chance)

    data = frame()
    pixels = np.frombuffer(data, np.uint8)
    image = np.asarray(cv2.imdecode(pixels, cv2.IMREAD_COLOR))
    quality = (cv2.IMWRITE_JPEG_QUALITY, params.jpeg_quality)
    event = Event(0, "image", CompressedImage(data=data))
    return (
        _best_ms(frame),
        _best_ms(lambda: frame((5.0, 2.0))),
        _best_ms(lambda: cv2.imencode(".jpg", image, quality)),
        _best_ms(lambda: eyes.handle(event)),
        _best_ms(lambda: cv2.imdecode(pixels, cv2.IMREAD_COLOR)),
    )


def _best_ms(call: Callable[[], object]) -> float:
    best_ns = None
    for _ in range(ROUNDS):
        began_ns = time.thread_time_ns()
        for _ in range(CALLS):
            call()
        round_ns = time.thread_time_ns() - began_ns
        best_ns = round_ns if best_ns is None else min(best_ns, round_ns)
    return (best_ns or 0) / CALLS * 1e-6
