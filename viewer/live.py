"""Follows a running system as a listener beside it: it says nothing on the bus, and nothing waits for it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from typing import Protocol

from runtime.assignment import Assignment
from runtime.clock import SECOND_NS, PacedClock
from runtime.inbox import Arrival
from runtime.joining import description
from runtime.listener import Listener
from runtime.recording import Logged
from runtime.runfile import Run
from viewer.scene import Scene, launch_of
from viewer.shown import Number, Shown, What
from viewer.wiring import SCHEMAS, Wiring

_SLICE_S = 0.05
_FLUSH_NS = SECOND_NS // 10


class Sink(Protocol):
    """A viewer, as far as a feed needs to know it."""

    def stands(self, entities: Mapping[str, What]) -> None:
        """Show what is there at all times."""
        ...

    def show(self, shown: Iterable[Shown]) -> None:
        """Show something, soon."""
        ...

    def flush(self) -> None:
        """Now."""
        ...


def follow(run: Run, sink: Sink, hz: float, is_over: Callable[[], bool]) -> None:
    """Show a running system until it ends or nobody looks any more.

    Args:
        run: the running system.
        sink: the viewer.
        hz: most camera images a second of wall time.
        is_over: whether nobody looks.

    Raises:
        ConfigurationError: the system is not there any more.
    """
    session = description(run)
    launch = launch_of(session.system.text)
    scene = Scene(launch, picture_ns=round(SECOND_NS / hz))
    sink.stands(scene.furniture())
    left_out = Wiring(launch).left_out
    keys = [key for key, schema in run.topics.items() if schema in SCHEMAS and key not in left_out]
    with Listener(run, keys, block=False) as listener:  # a slow viewer loses messages; the robot never waits for it
        _show(listener, scene, sink, _clock(session), is_over)
    sink.flush()


def _show(
    listener: Listener, scene: Scene, sink: Sink, time_of: Callable[[Arrival, int], int], is_over: Callable[[], bool]
) -> None:
    due_ns, dropped = 0, 0
    while not (is_over() or listener.is_over):
        heard, now_ns = listener.take(_SLICE_S), time.monotonic_ns()
        if heard is not None:
            logged = Logged(heard.key, heard.schema, heard.payload, *heard.stamp, time_of(heard, now_ns))
            sink.show(scene.take(logged, now_ns))
            if listener.dropped > dropped:
                dropped = listener.dropped
                sink.show([Shown("lost/by_this_viewer", heard.stamp.capture_ns, Number(float(dropped)))])
        if now_ns >= due_ns:
            due_ns = now_ns + _FLUSH_NS
            sink.flush()
    sink.show(scene.pages())


def _clock(session: Assignment) -> Callable[[Arrival, int], int]:
    """Session time at which a message was heard; in lockstep its capture time."""
    if session.system.clock == "lockstep":
        return lambda heard, _: heard.stamp.capture_ns
    clock = PacedClock(session.origin_ns, session.system.pace or 1.0)
    return lambda _, monotonic_ns: clock.session_ns(monotonic_ns)
