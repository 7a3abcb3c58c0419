"""When a device's readings are from."""

import threading
import time

from runtime.attached import Attached
from runtime.contract import Late
from schemas.drive_pb2 import BaseState


class Slow:
    """Says one thing that it knew half a second ago, and one that it knows now."""

    def __init__(self):
        self.readings = [Late(BaseState(battery_v=1.0), 0.5), BaseState(battery_v=2.0)]

    def read(self, timeout_s):
        if self.readings:
            return self.readings.pop(0)
        time.sleep(timeout_s)
        return None

    def write(self, message):
        pass

    def close(self):
        pass


class Outlet:
    run, sequence, key = 1, 0, "base/device"

    def __init__(self):
        self.said = []
        self.both = threading.Event()

    def send(self, payload, _sequence, capture_ns):
        self.said.append((BaseState.FromString(payload).battery_v, capture_ns))
        if len(self.said) == 2:
            self.both.set()


def test_a_late_reading_counts_for_when_it_was_taken():
    outlet = Outlet()
    attached = Attached(Slow(), None, outlet, lambda _: None, lambda _: None)
    began_ns = time.monotonic_ns()
    attached.start(lambda monotonic_ns: monotonic_ns)
    assert outlet.both.wait(30.0)
    ended_ns = time.monotonic_ns()
    attached.close()
    (late, late_ns), (prompt, prompt_ns) = outlet.said
    assert (late, prompt) == (1.0, 2.0)
    assert began_ns - 500_000_000 <= late_ns <= ended_ns - 500_000_000
    assert began_ns <= prompt_ns <= ended_ns
