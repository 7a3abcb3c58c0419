"""How each kind of port travels: one table, with reasons."""

from __future__ import annotations

from dataclasses import dataclass

from zenoh import CongestionControl, Priority

from runtime.contract import Kind


@dataclass(frozen=True, slots=True)
class Qos:
    """Options of a publisher."""

    priority: Priority
    congestion: CongestionControl


BLOCK, DROP = CongestionControl.BLOCK, CongestionControl.DROP

REAL: dict[Kind, Qos] = {
    # A command overtakes everything else; a command that waited is a stale one, so it is dropped, not queued.
    Kind.COMMAND: Qos(Priority.REAL_TIME, DROP),
    # The next state comes within a frame: never make the control loop wait for a slow reader.
    Kind.STATE: Qos(Priority.INTERACTIVE_HIGH, DROP),
    # Ten kilobytes that must not delay forty bytes.
    Kind.IMAGE: Qos(Priority.DATA_LOW, DROP),
    # Happens once: a policy, the end of a session. Reliable.
    Kind.EVENT: Qos(Priority.DATA, BLOCK),
}
LOCKSTEP: dict[Kind, Qos] = {
    # Time waits for every answer, so nothing may be dropped; one priority keeps the order of publication.
    kind: Qos(Priority.DATA, BLOCK)
    for kind in Kind
}
JOURNAL = Qos(Priority.DATA, BLOCK)
"""A hole in it ends replayability."""
STATUS = Qos(Priority.BACKGROUND, DROP)
"""The next one says the same and more."""


def qos(kind: Kind, clock: str) -> Qos:
    """Options of a publisher of this kind under this clock (`lockstep` or `real`)."""
    return (LOCKSTEP if clock == "lockstep" else REAL)[kind]
