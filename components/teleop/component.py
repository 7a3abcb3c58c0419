"""Messages to and from a person's hands: one drive for each frame of the base, and one whenever the hands change."""

from __future__ import annotations

from dataclasses import replace

from components.teleop import ports
from components.teleop.core import OPEN, Command, Grip, Hand, command, read
from runtime.contract import STOP, TICK, Event, Output
from schemas.drive_pb2 import Drive
from schemas.teleop_pb2 import Hands


class Teleop:
    """Commands the base by hand.

    Each drive answers the newest frame that base has sent, so base knows its age by its own clock, wherever this runs:
    with the link cut, no newer frame is answered and base stops. The hands' own age is counted here.
    """

    Params = ports.Params
    inputs = ports.INPUTS
    outputs = ports.OUTPUTS

    def __init__(self, params: ports.Params, seed: int) -> None:
        del seed  # nothing is random here
        self._params = params
        self._grip = Grip(has_robot=params.begin == "hand")
        self._frame_ns = -1
        self._said: Command | None = None

    def handle(self, event: Event) -> tuple[Output, ...]:
        """Take what the hands or the base say; see to it that a released key ends its drive."""
        if event.port == "base":
            if event.capture_ns <= self._frame_ns:
                return ()
            self._frame_ns = event.capture_ns
            return self._drive(event.time_ns, always=True)
        if event.port == "device":
            self._grip = read(self._params, self._grip, _hand(event.message), event.capture_ns)
            return self._drive(event.time_ns)
        if event.port == STOP:
            self._grip = replace(self._grip, hand=OPEN)
        return self._drive(event.time_ns) if event.port in {TICK, STOP} else ()

    def _drive(self, time_ns: int, *, always: bool = False) -> tuple[Output, ...]:
        now = command(self._params, self._grip, time_ns)
        if self._frame_ns < 0 or (now == self._said and not always):
            return ()
        self._said = now
        return (Output("drive", Drive(**now._asdict()), self._frame_ns),)


def _hand(message: Hands) -> Hand:
    """A reading whose shares lie in -1 to 1."""
    forward, left = (min(max(share, -1.0), 1.0) for share in (message.forward, message.left))
    return Hand(message.dead_man, forward, left, message.request)
