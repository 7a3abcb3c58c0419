"""Whether a session's topics keep their rates from its second quarter to its last."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable
from typing import NamedTuple

from runtime.recording import Logged, Tallies
from runtime.system import System, ports_of

_BIN_NS = 1_000_000_000


class Rates(NamedTuple):
    """What was found in a recording."""

    messages: int
    lost: int
    drift: float
    """Largest change of a topic's rate, as a share of it."""
    topic: str
    """Whose it is."""


def paced(system: System) -> set[str]:
    """Topics that have a rate, declared or the camera's; the others say something when there is something to say."""
    rows = [(ports_of(spec.run).OUTPUTS[port], key) for spec in system.components for port, key in spec.outputs.items()]
    return {key for port, key in rows if port.hz or port.per_frame}


def rates(messages: Iterable[Logged], topics: Collection[str]) -> Rates:
    """Count all messages and the missing ones, and how much the rates of some topics change, by time of capture."""
    tallies, bins = Tallies(), dict[str, Counter[int]]()
    for logged in messages:
        tallies.add(logged)
        if logged.topic in topics:
            bins.setdefault(logged.topic, Counter())[logged.capture_ns // _BIN_NS] += 1
    rows = tallies.topics()
    drift, topic = max(((_drift(bins[name]), name) for name in bins), default=(0.0, ""))
    return Rates(sum(row.count for row in rows), sum(row.lost for row in rows), drift, topic)


def _drift(counts: Counter[int]) -> float:
    """Change of a topic's rate from the second quarter to the last, as a share; 0 if there was no time for any."""
    first, length = min(counts), max(counts) - min(counts)
    width = length // 4
    early, late = (sum(counts[first + n] for n in range(begin, begin + width)) for begin in (width, length - width))
    if late == early:
        return 0.0
    return abs(late / early - 1.0) if early else float("inf")
