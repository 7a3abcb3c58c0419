"""What is wrong with a session's file: its order, schemas, sequences and journals, each fault by name."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any, NamedTuple

from google.protobuf import descriptor_pool, message_factory
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from google.protobuf.message import DecodeError
from mcap.records import Channel, Schema

from runtime.journal import entries
from runtime.mcap_items import Fault, RawMessage
from runtime.params import ConfigurationError
from runtime.recorded_launch import specs_of
from runtime.recording import Recording, run_of
from runtime.window import SEQUENCE_MASK
from schemas.session_pb2 import Journal

_KEPT = 1000
"""Holes and open questions remembered; a file with more than that is beyond counting."""
_JOURNAL = "berth.Journal"


class Finding(NamedTuple):
    """One fault, or several alike."""

    kind: str
    """file, session, schema, order, sequence, payload or journal."""
    words: str


class _Stream:
    """The messages of one key and run: their sequence, and which of them are missing."""

    def __init__(self, first: int) -> None:
        self.next = first
        self.holes: set[int] = set()
        self.lost = 0
        self.repeated = 0
        self.log_ns = 0

    def add(self, sequence: int) -> None:
        if sequence < self.next:
            self.repeated += 1
            return
        self.lost += sequence - self.next
        self.holes.update(range(self.next, min(sequence, self.next + _KEPT - len(self.holes))))
        self.next = sequence + 1


class _Track:
    """The journal of one run."""

    def __init__(self) -> None:
        self.next = 0
        self.time_ns = 0
        self.ended = False


class Examination:
    """One pass over a file."""

    def __init__(self, recording: Recording) -> None:
        self._recording = recording
        self._found: dict[tuple[str, str], int] = {}
        self._kinds: dict[int, Any] = {}
        self._names: dict[int, str] = {}
        self._channels: dict[int, tuple[str, int, int]] = {}
        self._streams: dict[tuple[str, int], _Stream] = {}
        self._tracks: dict[tuple[str, int], _Track] = {}
        self._awaited: dict[tuple[str, int, int], str] = {}
        self._inputs: dict[str, Mapping[str, str]] = {}
        self.messages = 0

    def run(self) -> list[Finding]:
        """Everything that is wrong.

        Raises:
            ConfigurationError: it is somebody else's file.
        """
        self._look_at_head()
        faults: list[Fault] = []
        for item in self._recording.items(faults):
            if isinstance(item, RawMessage):
                self._message(item)
            elif isinstance(item, Schema):
                self._schema(item)
            elif isinstance(item, Channel):
                self._channels[item.id] = (item.topic, run_of(item), item.schema_id)
        for fault in faults:
            self._note("file", f"byte {fault.offset}: {fault.words}")
        if not faults and not self._recording.whole():
            self._note("file", "it does not end as a finished file does")
        self._look_back()
        return [Finding(kind, words if n == 1 else f"{words} ({n} times)") for (kind, words), n in self._found.items()]

    def _note(self, kind: str, words: str) -> None:
        key = (kind, words)
        if key in self._found or len(self._found) < _KEPT:
            self._found[key] = self._found.get(key, 0) + 1

    def _look_at_head(self) -> None:
        session, launch = self._recording.session(), self._recording.launch()
        if not session and not launch:
            raise ConfigurationError(f"{self._recording.file}: must be a session of ours; it does not describe itself")
        if not session:
            self._note("session", "no metadata of a session of ours")
        if not launch:
            self._note("session", "no launch file")
        specs = launch.get("components")
        if launch and not (isinstance(specs, list) and all(isinstance(s, dict) and s.get("name") for s in specs)):
            self._note("session", "the launch file holds no list of components with names")
        folds = [spec for spec in specs_of(launch) if spec.get("name") and not spec.get("tap")]
        self._inputs.update((str(spec["name"]), spec["inputs"]) for spec in folds)

    def _schema(self, schema: Schema) -> None:
        self._names[schema.id] = schema.name
        if schema.encoding != "protobuf":
            self._note("schema", f"{schema.name} is of encoding {schema.encoding[:40]!r}; it must be protobuf")
            return
        try:
            pool = descriptor_pool.DescriptorPool()
            for file in FileDescriptorSet.FromString(schema.data).file:
                pool.Add(file)
            descriptor = pool.FindMessageTypeByName(schema.name)
            self._kinds[schema.id] = message_factory.GetMessageClass(descriptor)
        except (DecodeError, KeyError, TypeError, ValueError):
            self._note("schema", f"{schema.name[:80]} can not be parsed")

    def _message(self, message: RawMessage) -> None:
        self.messages += 1
        known = self._channels.get(message.channel)
        if known is None:
            self._note("file", f"messages of channel {message.channel}, which is not described")
            return
        topic, run, schema = known
        stream = self._streams.get((topic, run))
        if stream is None:
            stream = self._streams[topic, run] = _Stream(message.sequence)
        stream.add(message.sequence)
        if message.log_ns < stream.log_ns:
            self._note("order", f"{topic}: its log time is before that of the message in front of it")
        stream.log_ns = max(stream.log_ns, message.log_ns)
        self._awaited.pop((topic, run, message.sequence), None)
        decoded = self._decoded(topic, schema, message.payload)
        if self._names.get(schema) == _JOURNAL and decoded is not None:
            self._journal(topic.rpartition("/")[0], run, message.payload)

    def _decoded(self, topic: str, schema: int, payload: bytes) -> Any:
        kind = self._kinds.get(schema)
        try:
            return kind.FromString(payload) if kind is not None else None
        except DecodeError:
            self._note("payload", f"{topic}: a message can not be decoded")
            return None

    def _journal(self, name: str, run: int, payload: bytes) -> None:
        track = self._tracks.setdefault((name, run), _Track())
        inputs = self._inputs.get(name, {})
        try:
            for entry in entries([Journal.FromString(payload)]):
                if entry.number != track.next:
                    self._note("journal", f"{name}: event {entry.number} follows event {track.next - 1}")
                if entry.time_ns < track.time_ns:
                    self._note("journal", f"{name}: event {entry.number} is earlier than the one before it")
                track.next, track.time_ns = entry.number + 1, max(track.time_ns, entry.time_ns)
                track.ended = track.ended or entry.port == "stop"
                if entry.port in inputs:
                    self._look_for(name, str(inputs[entry.port]), entry.source_run, entry.source_sequence)
        except (DecodeError, ValueError) as damage:
            self._note("journal", f"{name}: {damage}")

    def _look_for(self, name: str, key: str, run: int, sequence: int) -> None:
        """A message that a component was handed must be in the file, now or a little later."""
        sequence &= SEQUENCE_MASK
        stream = self._streams.get((key, run))
        if stream is None or sequence >= stream.next:
            if len(self._awaited) < _KEPT:
                self._awaited[key, run, sequence] = name
        elif sequence in stream.holes:
            self._note("journal", f"{name} was handed message {sequence} of {key}, which is missing")

    def _look_back(self) -> None:
        for (topic, run), stream in self._streams.items():
            if stream.lost:
                self._note("sequence", f"{topic} (run {run:016x}): {stream.lost} lost")
            if stream.repeated:
                self._note("sequence", f"{topic} (run {run:016x}): {stream.repeated} out of order")
        for (key, _, sequence), name in self._awaited.items():
            self._note("journal", f"{name} was handed message {sequence} of {key}, which is missing")
        for (name, run), track in self._tracks.items():
            if not track.ended:
                self._note("journal", f"{name} (run {run:016x}) ends at {track.time_ns / 1e9:.3f} s without a stop")
        journals = Counter(name for name, _ in self._tracks)
        for name in self._inputs:
            if not journals[name]:
                self._note("journal", f"{name} has none: it can not be replayed")
