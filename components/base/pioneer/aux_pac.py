"""SERAUX: bytes that a device on the robot's auxiliary serial port has said. Pure.

A client asks for a number of bytes (GETAUX) and sends its own (TTY2), in either order; the robot answers when so many
have come.
"""

from __future__ import annotations

from components.base.pioneer.command import Command, integer, text

_TYPES = {1: 0xB0, 2: 0xB8}
_ASK = {1: Command.GETAUX, 2: Command.GETAUX2}
_TELL = {1: Command.TTY2, 2: Command.TTY3}
"""By number of the port; P2OS knows only the first."""


def asked(content: bytes, answer_bytes: int, port: int = 1) -> tuple[bytes, ...]:
    """Packets that forget what came before, ask for an answer's bytes, and say something."""
    flush, ask = integer(_ASK[port], 0), integer(_ASK[port], answer_bytes)
    return (flush, ask, text(_TELL[port], content)) if answer_bytes else (flush, text(_TELL[port], content))


def answer_of(payload: bytes, port: int = 1) -> bytes | None:
    """Bytes of the device; None if the packet is another."""
    return payload[1:] if payload[:1] == bytes((_TYPES[port],)) else None
