"""A whole system under a virtual clock that waits for nobody: real time without processes, repeatable.

Every message takes a few milliseconds, in order on each way, and passes through its bytes and the door of its reader.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Sequence
from functools import partial
from itertools import count

import numpy as np

from experiments.faults.seat import Seat
from runtime.hosted import Sample
from runtime.system import System

MS = 1_000_000
_LEAST_MS, _MOST_MS = 0.3, 6.0
"""From one handle to the next: handing over, computing, and the bus."""
_WHOLE: tuple[int, ...] = (0,)


class Virtual:
    """Runs the folds of a system; who wants to, tampers."""

    def __init__(self, system: System, seed: int) -> None:
        """Make every component that is no tap.

        Args:
            system: whose clock is real.
            seed: of how long messages take, and of who is served first after a pause.
        """
        self.now_ns = 0
        self.hear: Callable[[Sample], None] = lambda _: None
        """Called with everything that is said."""
        self.ways: Callable[[str, Sample], Sequence[int]] = lambda *_: _WHOLE
        """(component, message) to how much later than usual each copy of it arrives, ns; none = it is lost."""
        self._system = system
        self._rng = np.random.default_rng([seed, 11])
        self._heap: list[tuple[int, int, Callable[[], None]]] = []
        self._count = count()
        self._runs = count(1)
        self._arrived: dict[tuple[str, str], int] = {}
        self.seats: dict[str, Seat] = {}
        for spec in system.components:
            if not spec.tap:
                self.seat(spec.name)

    def seat(self, name: str, snapshot: bytes | None = None) -> None:
        """Start a component, or start it again, from a snapshot if there is one."""
        run = next(self._runs)
        seat = Seat(self._system.component(name), run, self._system.file)
        if snapshot is not None:
            seat.hosted.load(snapshot)
        self.seats[name] = seat
        for other in self.seats.values():
            other.expect(run)
            seat.expect(other.hosted.run)
        if seat.period_ns:
            self.at(self.now_ns, partial(self._tick, name, seat))

    def at(self, time_ns: int, call: Callable[[], None]) -> None:
        """Do something at a time."""
        heapq.heappush(self._heap, (max(time_ns, self.now_ns), next(self._count), call))

    def run(self, until_ns: int) -> None:
        """Let time pass."""
        while self._heap and self._heap[0][0] <= until_ns:
            self.now_ns, _, call = heapq.heappop(self._heap)
            call()
        self.now_ns = until_ns

    def sleep(self, name: str, until_ns: int) -> None:
        """Stop a component until then."""
        seat = self.seats[name]
        seat.asleep = True
        self.at(until_ns, partial(self._wake, name, seat))

    def kill(self, name: str) -> None:
        """A component is no more; the others hear of it."""
        self.seats[name].dead = True
        for other in self.seats.values():
            other.lose(name)
            self.at(self.now_ns + self._hop_ns(), partial(self._serve, other.hosted.spec.name, other))

    def stop(self) -> None:
        """Give everybody the last event, in launch order."""
        for name, seat in self.seats.items():
            self._say(name, seat.stop(self.now_ns))

    def _wake(self, name: str, seat: Seat) -> None:
        """Its clock and its messages wait for it alike: either may come first."""
        seat.asleep = False
        duties = [partial(seat.tick, self.now_ns), partial(seat.serve, self.now_ns)]
        for duty in duties if self._rng.random() < 0.5 else reversed(duties):
            self._say(name, duty())

    def _tick(self, name: str, seat: Seat) -> None:
        self._say(name, seat.tick(self.now_ns))
        if not seat.dead:
            self.at(self.now_ns + seat.period_ns, partial(self._tick, name, seat))

    def _serve(self, name: str, seat: Seat) -> None:
        self._say(name, seat.serve(self.now_ns))

    def _say(self, name: str, samples: Sequence[Sample]) -> None:
        for sample in samples:
            self.hear(sample)
            for copy, late_ns in enumerate(self.ways(name, sample)):
                self._send(name, sample, late_ns, again=copy > 0)

    def _send(self, name: str, sample: Sample, late_ns: int, *, again: bool) -> None:
        """In order on each way; what comes again may come after what is newer."""
        for reader, seat in self.seats.items():
            if seat.reads(sample.key):
                arrives_ns = self.now_ns + self._hop_ns() + late_ns
                if not again:
                    arrives_ns = max(arrives_ns, self._arrived.get((name, reader), 0))
                    self._arrived[name, reader] = arrives_ns
                self.at(arrives_ns, partial(self._bring, reader, sample))

    def _bring(self, reader: str, sample: Sample) -> None:
        seat = self.seats[reader]
        if not seat.dead:
            seat.arrive(sample)
            self._serve(reader, seat)

    def _hop_ns(self) -> int:
        return round(MS * float(self._rng.uniform(_LEAST_MS, _MOST_MS)))
