"""Connections whose other end is silent are closed at once, and what they hold is delivered all the same."""

import socket
import struct
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from runtime.bus import free_endpoint, open_peer, open_router
from runtime.lingering import forbid_lingering, keep_from_lingering
from tests.runtime.system import wait_for

LINGER_S = 3
SAID = bytes(4_000_000)
"""More than the system takes from one end without the other one's reading."""


def lingers(connection: socket.socket) -> bool:
    return bool(struct.unpack("ii", connection.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, 8))[0])


@contextmanager
def silent() -> Iterator[tuple[socket.socket, socket.socket]]:
    """A lingering connection that holds more than its other end has room for."""
    with socket.create_server(("127.0.0.1", 0)) as gate, socket.create_connection(gate.getsockname()) as near:
        far = gate.accept()[0]
        near.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, LINGER_S))
        near.setblocking(False)
        with far:
            yield near, far


def test_closing_waits_for_nobody():
    with silent() as (near, _):
        near.send(SAID)
        forbid_lingering()
        began_s = time.monotonic()
        near.close()
        assert time.monotonic() - began_s < LINGER_S / 3


def test_what_was_said_before_the_close_still_arrives():
    with silent() as (near, far):
        taken = near.send(SAID)
        forbid_lingering()
        near.close()
        heard = 0
        while data := far.recv(65536):
            heard += len(data)
        assert heard == taken


def test_other_files_of_the_process_are_left_alone(tmp_path):
    with (tmp_path / "file").open("w+b") as file, socket.socket(socket.AF_UNIX) as local:
        forbid_lingering()
        file.write(b"still open")
        local.setblocking(False)
    assert (tmp_path / "file").read_bytes() == b"still open"


@pytest.mark.xdist_group("live")
def test_while_the_bus_is_open_no_connection_of_the_process_lingers_for_long():
    endpoint = free_endpoint()
    with silent() as (near, _), open_router(endpoint), open_peer(endpoint):
        assert keep_from_lingering().is_alive()
        assert wait_for(lambda: not lingers(near), 10.0)
