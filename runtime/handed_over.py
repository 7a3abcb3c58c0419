"""The messages that a component of a session was handed, in the order in which it was handed them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from google.protobuf.message import DecodeError

from runtime.journal import entries
from runtime.mcap_items import Fault
from runtime.recording import Logged, Recording
from runtime.system import ComponentSpec
from runtime.window import SEQUENCE_MASK
from schemas.session_pb2 import Journal

JOURNAL_ORDER = "journal"


@dataclass
class HandedOver:
    """Small messages of a whole session; images are never asked for in this way."""

    inputs: list[tuple[str, Logged]] = field(default_factory=list)
    """(input port, message)."""
    others: list[Logged] = field(default_factory=list)
    """Messages of the further topics that were asked for."""
    order: str = JOURNAL_ORDER
    """`journal`, or why the order of the file had to do."""
    missing: str = ""
    """What of the session can not be read or is not there, in words; empty = nothing that matters here."""
    restarted: bool = False
    """The component was started again within the session."""


def handed_over(recording: Recording, spec: ComponentSpec, others: Iterable[str] = ()) -> HandedOver:
    """Read a session once.

    Args:
        recording: the session.
        spec: of the component.
        others: topics to read along.
    """
    ports = {key: port for port, key in spec.inputs.items()}
    journal_key, wanted = f"{spec.name}/journal", set(others)
    found, journal, faults = HandedOver(), [], list[Fault]()
    for logged in recording.messages({*ports, *wanted, journal_key}, faults):
        if logged.topic in ports:
            found.inputs.append((ports[logged.topic], logged))
        elif logged.topic == journal_key:
            journal.append(logged)
        if logged.topic in wanted:
            found.others.append(logged)
    found.restarted = len({logged.run for logged in journal}) > 1
    try:
        found.inputs = _in_order(found.inputs, journal)
    except (ValueError, DecodeError) as reason:
        found.order = f"file ({reason})"
        if journal and not found.restarted:
            found.missing = str(reason)
    if faults:
        found.missing = f"byte {faults[0].offset}: {faults[0].words}"
    return found


def _in_order(inputs: list[tuple[str, Logged]], journal: list[Logged]) -> list[tuple[str, Logged]]:
    """Inputs in the journal's order.

    Raises:
        ValueError: there is none, or it does not cover one whole run; says why.
    """
    if not journal:
        raise ValueError("no journal")
    if len({logged.run for logged in journal}) > 1:
        raise ValueError("the component was started again")
    by_source = {(port, logged.run, logged.sequence): logged for port, logged in inputs}
    ports = {port for port, _ in inputs}
    ordered = []
    for number, entry in enumerate(entries(Journal.FromString(logged.payload) for logged in journal)):
        if entry.number != number:
            raise ValueError(f"event {number} of the journal is missing")
        if entry.port in ports:
            source = by_source.get((entry.port, entry.source_run, entry.source_sequence & SEQUENCE_MASK))
            if source is None:
                raise ValueError(f"message {entry.source_sequence} on {entry.port} is missing")
            ordered.append((entry.port, source))
    return ordered
