"""What a component said in a replay, beside what the session holds of it."""

from __future__ import annotations

from typing import NamedTuple

from runtime.difference import FieldDifference, differences
from runtime.hosted import Sample
from runtime.recording import Logged
from runtime.window import SEQUENCE_MASK

_SHOWN = 10
"""Differences kept to be shown; the others are counted."""
_WAITING = 4096
"""Messages of one key and side that wait for their counterpart."""


class Difference(NamedTuple):
    """One output that is not what it was."""

    time_ns: int
    """Capture time."""
    key: str
    sequence: int
    fields: tuple[FieldDifference, ...]

    def __str__(self) -> str:
        """One line a field."""
        where = f"{self.time_ns / 1e9:.3f} s {self.key} {self.sequence}"
        return "\n".join(f"{where}: {f.field}: recorded {f.recorded}, replayed {f.replayed}" for f in self.fields)


class Comparison:
    """Pairs the outputs of one run by key and sequence, whichever side comes first."""

    def __init__(self, *, tolerant: bool) -> None:
        """Nothing was compared yet; `tolerant` as in `differences`."""
        self.identical = 0
        self.different = 0
        self.unpaired = 0
        """Said in the replay, but the recorder did not get it."""
        self.beyond = 0
        """Recorded, but said after what can be replayed."""
        self.first: list[Difference] = []
        self.changed: dict[str, int] = {}
        """Key -> outputs that differ."""
        self._tolerant = tolerant
        self._said: dict[str, dict[int, Sample]] = {}
        self._recorded: dict[str, dict[int, Logged]] = {}
        self._newest: dict[str, int] = {}

    @property
    def has_record(self) -> bool:
        """Whether the session holds any output of this run."""
        return bool(self._newest)

    def say(self, sample: Sample) -> None:
        """An output of the replay."""
        sequence = sample.sequence & SEQUENCE_MASK
        recorded = self._recorded.get(sample.key, {}).pop(sequence, None)
        if recorded is not None:
            self._compare(sample, recorded)
            return
        waiting = self._said.setdefault(sample.key, {})
        waiting[sequence] = sample
        if len(waiting) > _WAITING:
            del waiting[next(iter(waiting))]
            self.unpaired += 1

    def record(self, logged: Logged) -> None:
        """An output in the session."""
        self._newest[logged.topic] = logged.sequence
        said = self._said.get(logged.topic, {}).pop(logged.sequence, None)
        if said is not None:
            self._compare(said, logged)
            return
        waiting = self._recorded.setdefault(logged.topic, {})
        waiting[logged.sequence] = logged
        if len(waiting) > _WAITING:
            del waiting[next(iter(waiting))]
            self.beyond += 1

    def finish(self, *, to_the_end: bool) -> None:
        """Nothing comes any more.

        Args:
            to_the_end: the replay went as far as the run itself, so an output without counterpart differs, unless the
                recorder lost it (a later one of its key is there).
        """
        for sample in [sample for waiting in self._said.values() for sample in waiting.values()]:
            if to_the_end and sample.sequence & SEQUENCE_MASK > self._newest.get(sample.key, 1 << 32):
                self._differ(sample, FieldDifference("message", "none", "one"))
            else:
                self.unpaired += 1
        for logged in [logged for waiting in self._recorded.values() for logged in waiting.values()]:
            if to_the_end:
                self._differ(logged, FieldDifference("message", "one", "none"))
            else:
                self.beyond += 1

    def _compare(self, said: Sample, recorded: Logged) -> None:
        fields = differences(recorded.schema, recorded.payload, said.payload, tolerant=self._tolerant)
        if max(said.capture_ns, 0) != recorded.capture_ns:
            fields = (FieldDifference("capture time", str(recorded.capture_ns), str(said.capture_ns)), *fields)
        if fields:
            self._differ(recorded, *fields)
        else:
            self.identical += 1

    def _differ(self, message: Sample | Logged, *fields: FieldDifference) -> None:
        key = message.key if isinstance(message, Sample) else message.topic
        self.different += 1
        self.changed[key] = self.changed.get(key, 0) + 1
        if len(self.first) < _SHOWN:
            self.first.append(Difference(message.capture_ns, key, message.sequence, fields))
