"""The percept is of the time of the exposure, with the encoders of that time, however late either of them is."""

import itertools
import math

import numpy as np
import pytest

from benchmarks.tracking import Loop
from components.simulator.component import Simulator
from components.simulator.wiring import Wiring
from components.tracker.join import Join, Reading, Sight
from runtime.contract import TICK, Event
from schemas.trial_pb2 import Trial

FRAME_NS = 125_000_000


def driven(camera_s, encoder_s, known, frames=110):
    """Frames of a robot that turns to and fro while it drives, and whose tracker knows its latencies or not."""
    latencies = {"camera_latency_s": camera_s, "encoder_latency_s": encoder_s}
    loop = Loop(3, **(latencies if known else {}))
    loop.simulator = Simulator(Simulator.Params(begins="facing", wiring=Wiring(**latencies)), 3)
    loop.pending = loop.simulator.handle(Event(0, TICK))
    found = []
    for k in range(frames):
        moves = k > 50
        omega = math.radians(10) * (1 if (k // 8) % 2 else -1)
        found.append(loop.frame((0.1, omega) if moves else (0.0, 0.0), Trial()))
    return found


def errors_deg(frames):
    """Bearing error at the exposure that the percept names, once the robot moves."""
    time_s = np.arange(len(frames)) * FRAME_NS * 1e-9
    bearing = np.array([frame.truth.alpha_rad for frame in frames])
    return [
        math.degrees(abs(frame.percept.pan_rad - np.interp(frame.percept.capture_time_ns * 1e-9, time_s, bearing)))
        for frame in frames[60:]
        if frame.percept.visible
    ]


@pytest.mark.parametrize(("camera_s", "encoder_s"), [(0.1, 0.0), (0.0, 0.1), (0.06, 0.2)])
def test_known_latencies_leave_little_error_at_the_exposure(camera_s, encoder_s):
    frames = driven(camera_s, encoder_s, known=True)
    errors = errors_deg(frames)
    assert len(errors) > 40
    assert np.percentile(errors, 90) < 0.6, "encoders are read eight times a second; a frame of age would be 1.25"
    exposure_ns = frames[-1].percept.capture_time_ns
    assert (len(frames) - 1) * FRAME_NS - exposure_ns >= round(camera_s * 1e9)


def test_late_encoders_that_are_not_known_make_the_head_swing():
    """Why it is worth knowing."""
    assert np.percentile(errors_deg(driven(0.0, 0.1, known=False)), 90) > 2.0


def join_of(times, shift_ns, every_ns=FRAME_NS):
    """What is answered when image and encoders of each time come together; an encoder reads its own time."""
    join = Join()
    for time_ns in times:
        join.sight(Sight(time_ns, object=True))
        for k in range(FRAME_NS // every_ns):
            stamp_ns = time_ns - (FRAME_NS // every_ns - 1 - k) * every_ns
            join.reading(Reading(stamp_ns, stamp_ns * 1e-9, 0.0))
        yield from join.ready(shift_ns)


@pytest.mark.parametrize("shift_ns", [-200_000_000, -100_000_000, 0, 40_000_000, 100_000_000, 300_000_000])
@pytest.mark.parametrize("every_ns", [FRAME_NS, FRAME_NS // 5])
def test_every_image_is_answered_once_with_the_encoders_of_its_exposure(shift_ns, every_ns):
    times = [k * FRAME_NS for k in range(1, 20)]
    answers = list(join_of(times, shift_ns, every_ns))
    assert [answered for answered, _, _ in answers] == times
    for answered, sight, reading in answers[6:]:
        assert reading.pan_rad == pytest.approx((sight.capture_ns + shift_ns) * 1e-9)
        assert answered - sight.capture_ns <= max(0, shift_ns) + FRAME_NS


def test_images_used_never_go_back():
    used = [sight.capture_ns for _, sight, _ in join_of([k * FRAME_NS for k in range(1, 20)], 100_000_000)][2:]
    assert all(a <= b for a, b in itertools.pairwise(used))
