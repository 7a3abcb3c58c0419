"""A ROS 2 base in the network: the zenoh session, the clocks, and the client between them."""

from __future__ import annotations

import contextlib
import secrets
import sys
import threading
import time
from collections import deque
from typing import Any, cast

import zenoh

from components.base.ports import Ros2
from runtime.bus import direct, open_client
from runtime.contract import DeviceError, Late
from schemas.drive_pb2 import BaseCommand, BaseState

try:
    from components.base.ros2.client import Client, Reading, Sample
except ModuleNotFoundError as missing:
    raise DeviceError(f"device ros2 needs {missing.name}: pip install 'berth[ros2]'") from None

_SLICE_S = 0.02
"""The reader looks this often whether something is to be said."""
_REOPEN_S = 0.5
_APART_S = 0.02
"""Between two messages of a farewell."""
_MEET_S = 0.6
"""Longest wait for the robot's subscriber, before it is told to rest without a driver."""
_WAITING = 256
"""Samples that wait for the reader; the oldest make room."""


class Robot:
    """Never gives up: before the robot is there, and when it is gone, base is told so and nothing moves."""

    def __init__(self, params: Ros2) -> None:
        """Connect by and by. Whether a robot is there is told by `read`."""
        self._params = params
        self._turn = threading.Lock()
        self._arrived = threading.Event()
        self._samples: deque[tuple[str, bytes, int]] = deque(maxlen=_WAITING)
        self._client, self._zid = _client(params)
        self._session: zenoh.Session | None = None
        self._publisher: zenoh.Publisher | None = None
        self._tokens: list[zenoh.LivelinessToken] = []
        self._reopen_s = 0.0
        self._closed = False
        self._said = ""

    def read(self, timeout_s: float) -> Late | None:
        """The robot's next odometry or bumper, or that there is none."""
        until_s = time.monotonic() + timeout_s
        if self._session is None:
            self._connect()
        while True:
            with self._turn:
                reading = self._attend()
            if reading is not None:
                return Late(_state(reading, self._params), (time.monotonic_ns() - reading.time_ns) * 1e-9)
            left_s = until_s - time.monotonic()
            if left_s <= 0.0:
                return None
            self._arrived.wait(min(left_s, _SLICE_S))
            self._arrived.clear()

    def write(self, message: BaseCommand) -> None:
        """Say what base wants; the newest word counts."""
        with self._turn:
            self._client.command(message.v_mps, message.omega_radps, time.monotonic_ns())
            self._publish()

    def close(self) -> None:
        """Stop the robot and let go of it."""
        with self._turn:
            self._closed = True
            if self._publisher is not None:
                _say_slowly(self._publisher, self._client.farewell(time.time_ns()))
            session, self._session, self._publisher = self._session, None, None
        if session is not None:
            with contextlib.suppress(zenoh.ZError):
                session.close()  # type: ignore[no-untyped-call]

    def _connect(self) -> None:
        """Try once, if it is time; takes half a second at the most while nobody is there."""
        if time.monotonic() < self._reopen_s:
            return
        self._reopen_s = time.monotonic() + _REOPEN_S
        try:
            session = open_client(self._params.endpoint, self._zid)
        except OSError as error:
            self._say(f"nobody at {self._params.endpoint}: {error}")
            return
        self._say(f"at {self._params.endpoint}")
        with self._turn:
            if self._closed:
                session.close()  # type: ignore[no-untyped-call]
                return
            self._session, self._publisher = session, _publisher(session, self._client)
            self._tokens = [session.liveliness().declare_token(token) for token in self._client.tokens]
            for key in self._client.keys:
                session.declare_subscriber(key, direct(self._receive))

    def _receive(self, sample: zenoh.Sample) -> None:
        self._samples.append((str(sample.key_expr), sample.payload.to_bytes(), time.monotonic_ns()))
        self._arrived.set()

    def _attend(self) -> Reading | None:
        client = self._client
        while self._samples:
            client.take(*self._samples.popleft())
        client.advance(time.monotonic_ns())
        self._publish()
        while client.words:
            self._say(client.words.popleft())
        return client.readings.popleft() if client.readings else None

    def _publish(self) -> None:
        if self._publisher is None:
            return
        sample = self._client.sample(time.monotonic_ns(), time.time_ns())
        if sample is not None:
            _say(self._publisher, sample)

    def _say(self, words: str) -> None:
        if words != self._said:
            sys.stdout.write(f"robot: {words}\n")
            sys.stdout.flush()
        self._said = words


def rest(params: Ros2) -> None:
    """Stop a robot whose driver has died, without asking whether it is there."""
    client, zid = _client(params)
    with open_client(params.endpoint, zid) as session:
        publisher = _publisher(session, client)
        until_s = time.monotonic() + _MEET_S
        while not cast("Any", publisher.matching_status).matching and time.monotonic() < until_s:
            time.sleep(_APART_S)
        _say_slowly(publisher, client.farewell(time.time_ns()))


def _client(params: Ros2) -> tuple[Client, str]:
    """A client, and the id that its zenoh session shall have."""
    zid = f"{secrets.randbits(128) | 1 << 127:x}"
    return Client(params, zid, time.monotonic_ns()), zid


def _publisher(session: zenoh.Session, client: Client) -> zenoh.Publisher:
    """A lost or late command is worth nothing: it is dropped, and never waits for others."""
    return session.declare_publisher(
        client.command_key,
        congestion_control=zenoh.CongestionControl.DROP,
        priority=zenoh.Priority.REAL_TIME,
        express=True,
    )


def _say(publisher: zenoh.Publisher, sample: Sample) -> None:
    with contextlib.suppress(zenoh.ZError):  # the session ends; so the robot's odometry does
        publisher.put(sample.payload, attachment=sample.attachment)


def _say_slowly(publisher: zenoh.Publisher, samples: tuple[Sample, ...]) -> None:
    for sample in samples:
        _say(publisher, sample)
        time.sleep(_APART_S)


def _state(reading: Reading, params: Ros2) -> BaseState:
    odometry, contact = reading.odometry, reading.contact
    return BaseState(
        odometry_x_m=odometry.x_m,
        odometry_y_m=odometry.y_m,
        odometry_heading_rad=odometry.heading_rad,
        v_mps=odometry.v_mps,
        omega_radps=odometry.omega_radps,
        bumper=contact.front,
        rear_bumper=contact.rear,
        guard=bool(reading.fault),
        battery_v=reading.battery_v,
        fault=reading.fault,
        watchdog_s=params.watchdog_s,
    )
