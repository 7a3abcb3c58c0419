"""A session of processes on the bus, supervised from here."""

from __future__ import annotations

import math
from collections import deque
from typing import Any

from cli.in_process import on_signal
from cli.session import Watch
from cli.terminal import kept_terminal
from runtime.bus import ALONE
from runtime.device import kind_of
from runtime.link import Link
from runtime.supervise import Supervisor
from runtime.system import System, ports_of
from schemas.drive_pb2 import Applied

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
    watch.usage = "\n".join(kind.usage for spec in system.here if (kind := kind_of(spec)) is not None)
    with kept_terminal(), on_signal(lambda: supervisor.stop_soon("interrupted")), supervisor:
        _follow(supervisor, watch, waiting, duration_s)
        supervisor.stop()
    _take_all(watch, waiting)
    watch.refused = supervisor.refused
    return supervisor.exit_code != 0, supervisor.end_reason


def _watched(system: System) -> list[str]:
    acks = [f"{spec.name}/ack" for spec in system.components if spec.tap and "ack" in spec.outputs]
    # Who drives is of interest to a person who may; in lockstep one more reader of every frame would cost time.
    drives = [key for key in _keys(system, Applied) if system.clock == "real"]
    return [key for key in (system.trial, system.truth, *acks, *drives) if key]


def _keys(system: System, schema: type[Any]) -> list[str]:
    """Keys that carry a schema."""
    return [
        key
        for spec in system.components
        for port, key in spec.outputs.items()
        if ports_of(spec.run).OUTPUTS[port].schema is schema
    ]


def _follow(supervisor: Supervisor, watch: Watch, waiting: deque[tuple[Any, int]], duration_s: float | None) -> None:
    while supervisor.poll(0.1):
        _take_all(watch, waiting)
        watch.note = supervisor.note
        watch.refusal, watch.restarted = supervisor.refusal, supervisor.restarted
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
            watch.board.robot_s = max(watch.board.robot_s, capture_ns * 1e-9)  # eyes alone have no other clock
        elif message.DESCRIPTOR.name == "Applied":
            watch.drives = (
                f"{message.commander}, {message.v_mps:+.2f} m/s, {math.degrees(message.omega_radps):+.0f} deg/s"
            )
        else:
            watch.take(message, capture_ns)
