"""A link between two routers that falls silent must not hold back the processes of this host."""

import selectors
import socket
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from threading import Event, Thread

import pytest
import zenoh

from runtime.bus import free_endpoint, open_peer, open_router
from runtime.link import Link
from tests.runtime.system import wait_for

pytestmark = pytest.mark.xdist_group("live")
KEY = "test/dead-link/event"
EVENT_BYTES, PERIOD_S = 50_000, 0.005
"""A hundred times what a camera says, so that what the operating system holds is full at once."""
DEAD_S = 2.5
"""Longer than the link's lease, after which the router gives its connection up."""


class Wire:
    """Carries bytes both ways between a socket and a listener, until it is dead."""

    def __init__(self, near: socket.socket, far: socket.socket) -> None:
        self.alive = True
        self._other = {near: far, far: near}

    def carry(self) -> None:
        with selectors.DefaultSelector() as selector:
            for end in self._other:
                selector.register(end, selectors.EVENT_READ)
            while self.alive:
                for key, _ in selector.select(0.05):
                    self._other[key.fileobj].sendall(key.fileobj.recv(65536))


def port_of(endpoint: str) -> int:
    return int(endpoint.rpartition(":")[2])


def small(made: socket.socket) -> socket.socket:
    """A socket that holds little, so that a dead wire is felt soon."""
    made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    return made


@contextmanager
def wired(clock: str) -> Iterator[tuple[zenoh.Session, zenoh.Session, Wire]]:
    """A peer of one router, a peer of the other, and the wire between the routers."""
    robot, laptop, listen, connect = (free_endpoint() for _ in range(4))
    with ExitStack() as stack:
        gate = stack.enter_context(small(socket.socket()))
        gate.bind(("127.0.0.1", port_of(connect)))
        gate.listen()
        stack.enter_context(open_router(robot, Link(listen), clock))
        stack.enter_context(open_router(laptop, Link("", connect), clock))
        near = stack.enter_context(gate.accept()[0])
        gate.close()
        far = stack.enter_context(small(socket.socket()))
        far.connect(("127.0.0.1", port_of(listen)))
        wire = Wire(near, far)
        carrier = Thread(target=wire.carry)
        carrier.start()
        stack.callback(carrier.join)
        stack.callback(lambda: setattr(wire, "alive", False))
        yield stack.enter_context(open_peer(robot)), stack.enter_context(open_peer(laptop)), wire


def test_in_real_time_a_dead_link_holds_no_publisher_back():
    with wired("real") as (publisher, subscriber, wire):
        heard = subscriber.declare_subscriber(KEY, zenoh.handlers.RingChannel(4))
        event = publisher.declare_publisher(KEY, congestion_control=zenoh.CongestionControl.BLOCK)
        assert wait_for(lambda: event.put(b"first") or heard.try_recv() is not None, 10.0)
        wire.alive = False
        longest_s, until_s = 0.0, time.monotonic() + DEAD_S
        while time.monotonic() < until_s:
            began_s = time.monotonic()
            event.put(bytes(EVENT_BYTES))
            longest_s = max(longest_s, time.monotonic() - began_s)
            Event().wait(PERIOD_S)
        assert longest_s < 0.3
