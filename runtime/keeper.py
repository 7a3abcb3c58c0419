"""Keeps the newest snapshot of each component that publishes one: started again, it goes on there."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import zenoh

from runtime.assignment import Kept
from runtime.bus import direct
from runtime.presence import LISTENS, Presence
from runtime.system import ComponentSpec, ports_of
from runtime.wire import Refused, Stamp, encoding_of, unpack_stamp
from schemas.session_pb2 import Snapshot


class Keeper:
    """The snapshots of one host's components. Written by zenoh's thread, asked by the supervisor's."""

    def __init__(self, presence: Presence) -> None:
        """Nothing was heard.

        Args:
            presence: only who is announced there is believed.
        """
        self._presence = presence
        self._newest: dict[str, tuple[Stamp, bytes]] = {}

    def listen(self, session: zenoh.Session, realm: str, specs: Iterable[ComponentSpec]) -> None:
        """Subscribe to the snapshots of these components."""
        for spec in specs:
            for port, declared in ports_of(spec.run).OUTPUTS.items():
                if declared.schema is Snapshot:
                    session.declare_subscriber(f"{realm}/{spec.outputs[port]}", direct(self._receiver(spec.name)))

    def _receiver(self, name: str) -> Callable[[zenoh.Sample], None]:
        def receive(sample: zenoh.Sample) -> None:
            if sample.attachment is None or str(sample.encoding) != encoding_of(Snapshot):
                return
            try:
                stamp = unpack_stamp(sample.attachment.to_bytes())
            except Refused:
                return  # its readers count it
            if stamp.run in self._presence.runs(LISTENS, name):
                self._newest[name] = (stamp, sample.payload.to_bytes())

        return receive

    def forget(self) -> None:
        """Whoever is started from now on starts cold."""
        self._newest.clear()

    def kept(self, name: str, directory: Path) -> Kept | None:
        """The newest snapshot of a component, written into a file; None if it has published none.

        Args:
            name: of the component.
            directory: of the run.
        """
        if name not in self._newest:
            return None
        stamp, payload = self._newest[name]
        file = directory / f"{name}.snapshot"
        file.write_bytes(payload)
        return Kept(str(file), stamp.run, stamp.sequence)
