"""A Pioneer or PeopleBot at a serial port or in the network: the line, the clock, and the client between them."""

from __future__ import annotations

import contextlib
import sys
import threading
import time

from components.base.devices.aux_socket import AuxSocket
from components.base.pioneer.client import Client, Reading, Wish
from components.base.pioneer.handshake import REST
from components.base.ports import Pioneer
from runtime.contract import DeviceError
from runtime.line import Line, LineError, listen
from schemas.drive_pb2 import BaseCommand, BaseState

BAUDS = (9600, 38400, 19200, 115200, 57600)
"""In the order in which clients commonly try them."""
_SLICE_S = 0.004
"""While packets wait, the reader looks this often whether the next one may go."""
_REOPEN_S = 0.5
_APART_S = 0.006
"""Between two packets of a farewell."""
_TCP_BAUD = 115200
"""A network takes packets as fast as the robot does."""


class Robot:
    """Never gives up: a line that has ended is opened anew, a robot that was reset is greeted anew, at rest."""

    def __init__(self, params: Pioneer) -> None:
        """Open the line. Whether a robot is there is told by `read`.

        Raises:
            DeviceError: it can not be opened.
        """
        self._params = params
        self._turn = threading.Lock()
        self._bauds = _bauds(params)
        self._round = 0
        self._reopen_s = 0.0
        self._client = Client(params, time.monotonic_ns())
        try:
            self._line: Line | None = Line(params.port, self._baud)
        except LineError as error:
            raise DeviceError(f"robot at {error}") from None
        self._aux = AuxSocket(params.aux) if params.aux else None

    def read(self, timeout_s: float) -> BaseState | None:
        """The robot's next packet, or that it does not answer."""
        until_s = time.monotonic() + timeout_s
        while True:
            with self._turn:
                reading = self._attend()
            if reading is not None:
                return _state(reading)
            left_s = until_s - time.monotonic()
            if left_s <= 0.0:
                return None
            wait_s = min(left_s, _SLICE_S) if self._client.waits or self._aux else left_s
            listen(self._line, wait_s, self._turn, self._client.take, self._lose)

    def write(self, message: BaseCommand) -> None:
        """Say what base wants; the newest word counts."""
        wish = Wish(
            message.v_mps, message.omega_radps, message.gripper, message.lift_reversed, message.fingers_reversed
        )
        with self._turn:
            self._client.command(wish, time.monotonic_ns())
            self._flush()

    def close(self) -> None:
        """Stop the robot and let go of it."""
        with self._turn:
            if self._line is not None:
                with contextlib.suppress(LineError):
                    _say_slowly(self._line, self._client.farewell())
                self._line.close()
                self._line = None
        if self._aux is not None:
            self._aux.close()

    @property
    def _baud(self) -> int:
        return self._bauds[self._round % len(self._bauds)]

    def _attend(self) -> Reading | None:
        self._client.advance(time.monotonic_ns())
        if self._line is None or self._client.failed:
            self._open()
        if self._aux is not None:
            self._aux.exchange(self._client)
        self._flush()
        while self._client.words:
            sys.stdout.write(f"robot at {self._params.port}: {self._client.words.popleft()}\n")
            sys.stdout.flush()
        return self._client.readings.popleft() if self._client.readings else None

    def _flush(self) -> None:
        if self._line is None:
            return
        speed = _TCP_BAUD if self._params.port.startswith("tcp:") else self._baud
        try:
            packet = self._client.packet(time.monotonic_ns(), speed)
            if packet:
                self._line.write(packet)
        except LineError as error:
            self._lose(error)

    def _lose(self, error: LineError) -> None:
        if self._line is None:
            return
        self._client.words.append(f"{error}; opening it again")
        self._line.close()
        self._line = None
        self._reopen_s = time.monotonic() + _REOPEN_S
        self._client.begin(time.monotonic_ns())

    def _open(self) -> None:
        """Once more, at the next speed if nobody has answered at this one."""
        if time.monotonic() < self._reopen_s:
            return
        if self._client.failed:
            self._round += 1
        self._reopen_s = time.monotonic() + _REOPEN_S
        if self._line is not None:
            self._line.close()
            self._line = None
        with contextlib.suppress(LineError):
            self._line = Line(self._params.port, self._baud)
        self._client.begin(time.monotonic_ns())


def rest(params: Pioneer) -> None:
    """Stop a robot whose driver has died, without asking whether it is there."""
    for baud in _bauds(params):
        with contextlib.suppress(LineError):
            line = Line(params.port, baud)
            try:
                _say_slowly(line, REST)
            finally:
                line.close()


def _bauds(params: Pioneer) -> tuple[int, ...]:
    if params.port.startswith("tcp:") or not params.search_baud:
        return (params.baud,)
    return (params.baud, *(baud for baud in BAUDS if baud != params.baud))


def _say_slowly(line: Line, packets: tuple[bytes, ...]) -> None:
    """Each packet with the time that the slowest line takes for it."""
    for packet in packets:
        line.write(packet)
        time.sleep(_APART_S + len(packet) * 10 / 9600)


def _state(reading: Reading) -> BaseState:
    switches = reading.switches
    return BaseState(
        odometry_x_m=reading.x_m,
        odometry_y_m=reading.y_m,
        odometry_heading_rad=reading.heading_rad,
        v_mps=reading.v_mps,
        omega_radps=reading.omega_radps,
        bumper=reading.bumper,
        rear_bumper=reading.rear_bumper,
        inner_beam=switches.inner_beam,
        outer_beam=switches.outer_beam,
        lift_up=switches.lift_up,
        lift_down=switches.lift_down,
        fingers_closed=switches.fingers_closed,
        guard=bool(reading.fault),
        rear_range_m=reading.rear_range_m,
        battery_v=reading.battery_v,
        fault=reading.fault,
        watchdog_s=reading.watchdog_s,
    )
