"""Latency: what the journal says, frame by frame, against times that are known."""

import numpy as np
import pytest

from report.latency import Latency
from runtime.journal import JournalWriter
from runtime.recording import Logged

MS, FRAME_NS, RUN = 1_000_000, 125_000_000, 7
LAUNCH = {
    "clock": "real",
    "components": [
        {"name": "camera", "host": "robot", "inputs": {}, "outputs": {"image": "camera/image"}},
        {"name": "vision", "host": "robot", "inputs": {"image": "camera/image"}, "outputs": {"view": "vision/view"}},
        {"name": "learner", "host": "laptop", "inputs": {"view": "vision/view"}, "outputs": {}},
    ],
}


def hops(launch=LAUNCH, frames=40, age=lambda k: (5 + k % 3) * MS, missing=()):
    """A camera whose frames vision is handed at known ages, and a learner on another machine."""
    latency, journal = Latency(launch), JournalWriter(events=8)
    for k in range(frames):
        capture_ns = k * FRAME_NS
        if k not in missing:
            latency.take(Logged("camera/image", "foxglove.CompressedImage", b"", RUN, k, capture_ns, capture_ns))
        journal.add("tick", 0, 0, capture_ns, 0)
        journal.add("image", RUN, k, capture_ns + age(k), 0)
        if journal.is_due(0) or k == frames - 1:
            batch = journal.take().SerializeToString()
            for name in ("vision", "learner"):
                latency.take(Logged(f"{name}/journal", "berth.Journal", batch, 8, k, 0, 0))
    return latency.hops()


def test_each_age_is_hand_over_less_exposure():
    (hop,) = hops()
    assert (hop.component, hop.port, hop.topic) == ("vision", "image", "camera/image")
    assert hop.ages_ms == pytest.approx([5 + k % 3 for k in range(40)])
    assert hop.percentiles_ms()[0] == pytest.approx(np.median(hop.ages_ms))


def test_another_machines_clock_is_never_compared():
    assert {hop.component for hop in hops()} == {"vision"}


def test_a_message_that_is_missing_in_the_file_has_no_age():
    (hop,) = hops(missing={3, 4})
    assert len(hop.ages_ms) == 38


def test_in_lockstep_there_is_no_latency():
    assert hops({**LAUNCH, "clock": "lockstep"}) == []


def test_nonsense_has_no_age():
    assert hops(age=lambda k: -1 * MS) == []
    assert hops({"clock": "real", "components": [None, {"inputs": None}]}) == []
