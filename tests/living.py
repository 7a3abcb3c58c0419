"""A driven world in real time, in a thread, as long as a context."""

from __future__ import annotations

import threading
import time

STEP_NS = 1_000_000_000 // 64


class Living:
    """It may be looked at while `turn` is held."""

    def __init__(self, body):
        self.body = body
        self.turn = threading.Lock()
        self._done = threading.Event()
        self._thread = threading.Thread(target=self._live, daemon=True)

    def exchange(self, now_ns):
        """Hear and speak; `now_ns` is the world's time."""
        raise NotImplementedError

    def close(self):
        """Let go of what it speaks through."""

    def _live(self):
        began_ns = time.monotonic_ns() - self.body.time_ns
        while not self._done.wait(0.003):
            with self.turn:
                now_ns = time.monotonic_ns() - began_ns
                while self.body.time_ns + STEP_NS <= now_ns:
                    self.body.step()
                self.exchange(now_ns)

    @property
    def v_mps(self):
        with self.turn:
            return self.body.base.v_mps

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._done.set()
        self._thread.join()
        self.close()
