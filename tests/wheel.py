"""A device of base, opened, with somebody at the wheel who says the same speed eight times a second."""

import time

from runtime.contract import Late
from schemas.drive_pb2 import BaseCommand

DEADLINE_S = 30.0


class Wheel:
    """Reads the device all the while."""

    def __init__(self, device):
        self.device = device
        self.v_mps = 0.0
        self.state = None
        self._said_s = 0.0

    def until(self, condition):
        end_s = time.monotonic() + DEADLINE_S
        while not condition():
            assert time.monotonic() < end_s, self.state
            if time.monotonic() - self._said_s > 0.125:
                self._said_s = time.monotonic()
                self.device.write(BaseCommand(v_mps=self.v_mps))
            reading = self.device.read(0.05)
            self.state = (reading.message if isinstance(reading, Late) else reading) or self.state
        return self

    def ready(self):
        return self.until(lambda: self.state is not None and not self.state.guard)


def come_to_rest(robot):
    """Wait until the wheels of a living robot stand still."""
    end_s = time.monotonic() + DEADLINE_S
    while robot.v_mps:
        assert time.monotonic() < end_s
        time.sleep(0.01)
