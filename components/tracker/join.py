"""Brings together what was seen in an image and what the encoders read at its exposure."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

HEADS = 32
"""Readings kept: 4 s at 8 Hz, 1 s at 30 Hz."""
SIGHTS = 16
"""Images that may wait for a reading."""


@dataclass
class Sight:
    """What vision found in one image, made finite."""

    capture_ns: int = 0
    object: bool = False
    u_px: float = 0.0
    v_px: float = 0.0
    edge: bool = False
    slope: float = 0.0
    edge_v_px: float = 0.0


@dataclass
class Reading:
    """Encoders at a time; NaN where they could not be read."""

    capture_ns: int = 0
    pan_rad: float = math.nan
    tilt_rad: float = math.nan

    @property
    def readable(self) -> bool:
        """Whether both angles are known."""
        return math.isfinite(self.pan_rad) and math.isfinite(self.tilt_rad)


@dataclass
class Join:
    """Every image is answered once, oldest first, as soon as the encoders at its exposure are known."""

    answered_ns: int = -1
    sights: list[Sight] = field(default_factory=list)
    readings: list[Reading] = field(default_factory=list)
    held: list[Sight] = field(default_factory=list)
    """Images whose encoders are still to come, where encoders are later than images."""

    def sight(self, sight: Sight) -> None:
        """Take what was seen; images that are older than another one, or come twice, are dropped."""
        newest_ns = self.sights[-1].capture_ns if self.sights else self.answered_ns
        if sight.capture_ns > newest_ns:
            del self.sights[: max(0, len(self.sights) - SIGHTS + 1)]
            self.sights.append(sight)

    def reading(self, reading: Reading) -> None:
        """Take what the encoders read; readings out of order are dropped."""
        if not self.readings or reading.capture_ns > self.readings[-1].capture_ns:
            del self.readings[: max(0, len(self.readings) - HEADS + 1)]
            self.readings.append(reading)

    def ready(self, shift_ns: int = 0) -> Iterator[tuple[int, Sight, Reading]]:
        """Each image once: its capture time, and the newest image whose encoders are known, with them.

        That is the image itself unless encoders are later than images; then an older one, because a head that is
        believed to be elsewhere than it is swings (guessing where it went on to makes it worse).

        Args:
            shift_ns: how much later than an image's capture time the encoders of its exposure are stamped.
        """
        while self.sights and self.readings and self.readings[-1].capture_ns >= self.sights[0].capture_ns:
            newest = self.sights.pop(0)
            self.answered_ns = newest.capture_ns
            sight = self._matched(newest, shift_ns)
            yield newest.capture_ns, sight, self._at(min(sight.capture_ns + shift_ns, self.readings[-1].capture_ns))

    def _matched(self, newest: Sight, shift_ns: int) -> Sight:
        """The newest image whose encoders have been read; in the very beginning the newest of all."""
        if shift_ns <= 0:
            return newest
        self.held = [*self.held[-SIGHTS:], newest]
        known = [sight for sight in self.held if sight.capture_ns + shift_ns <= self.readings[-1].capture_ns]
        if not known:
            return newest
        self.held = [sight for sight in self.held if sight.capture_ns >= known[-1].capture_ns]
        return known[-1]

    def _at(self, time_ns: int) -> Reading:
        """Encoders at a time not after the newest reading, interpolated between the two around it."""
        after = self.readings[-1]
        if after.capture_ns == time_ns:
            return after
        for before in reversed(self.readings):
            if before.capture_ns <= time_ns:
                return _between(before, after, time_ns)
            after = before
        return Reading(time_ns, after.pan_rad, after.tilt_rad)


def _between(before: Reading, after: Reading, time_ns: int) -> Reading:
    share = (time_ns - before.capture_ns) / (after.capture_ns - before.capture_ns)
    if share == 0.0:
        return before
    return Reading(
        time_ns,
        before.pan_rad + share * (after.pan_rad - before.pan_rad),
        before.tilt_rad + share * (after.tilt_rad - before.tilt_rad),
    )
