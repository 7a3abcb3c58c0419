"""A session of processes on the bus, supervised from here."""

from __future__ import annotations

from collections import deque
from typing import Any

from cli.in_process import on_signal
from cli.session import Watch
from runtime.bus import ALONE
from runtime.link import Link
from runtime.supervise import Supervisor
from runtime.system import System

_BACKLOG = 100_000
"""Messages from zenoh's threads that wait for the scoreboard; more than ten minutes of robot time."""


def run_on_bus(system: System, watch: Watch, duration_s: float | None, link: Link = ALONE) -> tuple[bool, str]:
    """Run to the end.

    Args:
        system: resolved launch file.
        watch: gets trials, truth and the recorder's acknowledgements.
        duration_s: session time to stop at; None = the session's own end.
        link: to another host's part of the system.

    Returns:
        (failed, reason).

    Raises:
        ConfigurationError: the realm or an endpoint is busy, or the other host runs another system.
    """
    waiting: deque[tuple[Any, int]] = deque(maxlen=_BACKLOG)
    supervisor = Supervisor(system, link=link)
    for key in _watched(system):
        supervisor.watch(key, lambda message, capture_ns: waiting.append((message, capture_ns)))
    with on_signal(lambda: supervisor.stop_soon("interrupted")), supervisor:
        _follow(supervisor, watch, waiting, duration_s)
        supervisor.stop()
    _take_all(watch, waiting)
    return supervisor.exit_code != 0, supervisor.end_reason


def _watched(system: System) -> list[str]:
    acks = [f"{spec.name}/ack" for spec in system.components if spec.tap and "ack" in spec.outputs]
    return [key for key in (system.trial, system.truth, *acks) if key]


def _follow(supervisor: Supervisor, watch: Watch, waiting: deque[tuple[Any, int]], duration_s: float | None) -> None:
    while supervisor.poll(0.1):
        _take_all(watch, waiting)
        watch.note = supervisor.note
        watch.show()
        if watch.over:
            supervisor.stop_soon(watch.over)
        if duration_s is not None and watch.board.robot_s >= duration_s:
            supervisor.stop_soon("duration")


def _take_all(watch: Watch, waiting: deque[tuple[Any, int]]) -> None:
    while waiting:
        message, capture_ns = waiting.popleft()
        if message.DESCRIPTOR.name == "RecorderAck":
            watch.messages, watch.lost = message.messages, message.lost
        else:
            watch.take(message, capture_ns)
