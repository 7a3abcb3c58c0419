"""Outlets: the publishers of one process, each with a sequence of its own."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import zenoh

from runtime.contract import Port
from runtime.qos import JOURNAL, STATUS, Qos, qos
from runtime.wire import encoding_of, pack_stamp
from schemas.session_pb2 import Journal, Status


class Outlet:
    """One key that this process publishes."""

    def __init__(self, session: zenoh.Session, realm: str, key: str, schema: type[Any], how: Qos, run: int) -> None:
        """Declare the publisher of `REALM/KEY`. Its messages do not come back to this process."""
        self.key = key
        self.schema = schema
        self.sequence = 0
        """Of the next message."""
        self.run = run
        """Run id that every message names."""
        self._publisher = session.declare_publisher(
            f"{realm}/{key}",
            encoding=zenoh.Encoding(encoding_of(schema)),
            priority=how.priority,
            congestion_control=how.congestion,
            allowed_destination=zenoh.Locality.REMOTE,
        )

    def put(self, message: Any, capture_ns: int) -> bytes:
        """Publish a message.

        Returns:
            Its bytes.

        Raises:
            TypeError: not a message of this outlet's schema.
        """
        if type(message) is not self.schema:
            raise TypeError(f"{self.key} carries {self.schema.__name__}; got {type(message).__name__}")
        payload: bytes = message.SerializeToString(deterministic=True)
        self.send(payload, self.sequence, capture_ns)
        return payload

    def send(self, payload: bytes, sequence: int, capture_ns: int) -> None:
        """Publish bytes that have their sequence already."""
        self._publisher.put(payload, attachment=pack_stamp(self.run, sequence, capture_ns))
        self.sequence = sequence + 1


class Outlets:
    """All outlets of a process: its output ports, status and journal."""

    def __init__(
        self, session: zenoh.Session, realm: str, name: str, run: int, clock: str, outputs: Mapping[str, Port]
    ) -> None:
        """Declare status and journal; `declare` adds the ports."""
        self._session, self._realm, self._name, self._run, self._clock = session, realm, name, run, clock
        self._outputs = outputs
        self.status = Outlet(session, realm, f"{name}/status", Status, STATUS, run)
        self.journal = Outlet(session, realm, f"{name}/journal", Journal, JOURNAL, run)
        self.ports: dict[str, Outlet] = {}

    def declare(self, keys: Mapping[str, str]) -> None:
        """Declare the output ports under their keys below the realm."""
        for port, declared in self._outputs.items():
            how = qos(declared.kind, self._clock)
            key = keys.get(port, f"{self._name}/{port}")
            self.ports[port] = Outlet(self._session, self._realm, key, declared.schema, how, self._run)

    @property
    def published(self) -> int:
        """Messages published on output ports."""
        return sum(outlet.sequence for outlet in self.ports.values())
