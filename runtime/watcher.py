"""Follows one key of a running system, as its supervisor does: what nobody announced has said is passed over."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import zenoh

from runtime.presence import LISTENS, Presence
from runtime.wire import Decoder, Refused, encoding_of, unpack_stamp


class Watcher:
    """Believes only the announced runs of the component that publishes a key, as every component does."""

    def __init__(
        self,
        schema: type[Any],
        publisher: str,
        presence: Presence,
        call: Callable[[Any, int], None],
        fail: Callable[[BaseException], None],
    ) -> None:
        """Nothing was heard.

        Args:
            schema: generated protobuf class of the key's messages.
            publisher: component that publishes the key; empty = some component of the realm.
            presence: who is announced; kept up to date by somebody else.
            call: gets each message and its capture time, on zenoh's thread.
            fail: gets what `call` raised; zenoh would swallow it.
        """
        self._encoding = encoding_of(schema)
        self._decoder = Decoder(schema)
        self._publisher = publisher
        self._presence = presence
        self._call, self._fail = call, fail
        self._runs: set[int] = set()
        """Heard before. A run's last word may come after the word that it has left."""

    def receive(self, sample: zenoh.Sample) -> None:
        """Take one sample, on zenoh's thread."""
        try:
            if sample.attachment is None or str(sample.encoding) != self._encoding:
                return
            stamp = unpack_stamp(sample.attachment.to_bytes())
            if stamp.run in self._runs or self._presence.is_announced(LISTENS, self._publisher, stamp.run):
                self._runs.add(stamp.run)
                self._call(self._decoder(sample.payload.to_bytes()), stamp.capture_ns)
        except Refused:
            return  # its readers count it
        except Exception as failure:  # noqa: BLE001  (zenoh would swallow it)
            self._fail(failure)
