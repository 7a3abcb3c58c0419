"""One component in a shell: events in, stamped bytes out. The same for every shell; no I/O, no clock."""

from __future__ import annotations

from typing import Any, NamedTuple

from google.protobuf.message import DecodeError

from runtime.contract import ComponentError, Event, Output, Port
from runtime.system import ComponentSpec, class_of, params_of
from schemas.session_pb2 import Journal, Snapshot


class Sample(NamedTuple):
    """A message as bytes, on its way."""

    key: str
    schema: str
    payload: bytes
    run: int
    sequence: int
    capture_ns: int


class Hosted:
    """A component with its run id and its sequences."""

    def __init__(self, spec: ComponentSpec, run: int, file: str = "") -> None:
        """Make the component.

        Args:
            spec: from the launch file.
            run: run id; a restart has a new one.
            file: launch file, for error messages.
        """
        kind = class_of(spec.run)
        self.spec = spec
        self.run = run
        self.component: Any = kind(params_of(spec, file), spec.seed)
        self.inputs = kind.inputs
        self.outputs: dict[str, Port] = dict(kind.outputs)
        self._sequences = dict.fromkeys(self.outputs, 0)
        self._schemas = {port: declared.schema.DESCRIPTOR.full_name for port, declared in self.outputs.items()}
        self._journals = 0
        self.handled = 0
        self.published = 0

    def decode(self, port: str, payload: bytes) -> Any:
        """Message of an input port. Raises protobuf's DecodeError."""
        return self.inputs[port].schema.FromString(payload)

    def handle(self, event: Event) -> list[Sample]:
        """Hand over one event and stamp what comes back.

        Raises:
            ComponentError: an output port that was not declared, or a message of another schema.
        """
        self.handled += 1
        return [self._stamped(output, event.capture_ns) for output in self.component.handle(event)]

    def load(self, payload: bytes) -> None:
        """Go on where a snapshot was taken.

        Args:
            payload: a `Snapshot` of a former run.

        Raises:
            ValueError: it is none of this component with these parameters; nothing has changed.
        """
        try:
            self.component.load(Snapshot.FromString(payload).state)
        except (AttributeError, DecodeError) as error:
            raise ValueError(str(error) or "it is damaged") from None

    def journal(self, batch: Journal, time_ns: int) -> Sample:
        """A batch of the journal, stamped; it has a sequence of its own."""
        sequence = self._journals
        self._journals += 1
        payload = batch.SerializeToString(deterministic=True)
        return Sample(f"{self.spec.name}/journal", "berth.Journal", payload, self.run, sequence, time_ns)

    def _stamped(self, output: Output, caused_ns: int) -> Sample:
        port, message, capture_ns = output
        declared = self.outputs.get(port)
        if declared is None or not isinstance(message, declared.schema):
            raise ComponentError(f"{self.spec.name}.{port}: is not declared as a port of {type(message).__name__}")
        sequence = self._sequences[port]
        self._sequences[port] = sequence + 1
        self.published += 1
        payload = message.SerializeToString(deterministic=True)
        stamp = caused_ns if capture_ns is None else capture_ns
        return Sample(self.spec.outputs[port], self._schemas[port], payload, self.run, sequence, stamp)
