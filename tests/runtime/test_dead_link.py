"""A link between two routers that falls silent must not hold back the processes of this host."""

import selectors
import socket
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
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


def test_one_of_two_connections_that_breaks_is_made_again_and_nothing_stops():
    robot, laptop, listen, connect = (free_endpoint() for _ in range(4))
    with ExitStack() as stack:
        gate = stack.enter_context(socket.create_server(("127.0.0.1", port_of(connect))))
        gate.settimeout(10.0)
        stack.enter_context(open_router(robot, Link(listen), "real"))
        stack.enter_context(open_router(laptop, Link("", connect), "real"))
        wires = [Carried(gate, listen, stack) for _ in range(2)]
        publisher, subscriber = (stack.enter_context(open_peer(endpoint)) for endpoint in (robot, laptop))
        heard = subscriber.declare_subscriber(KEY, zenoh.handlers.RingChannel(4))
        kinds = [publisher.declare_publisher(KEY, priority=p) for p in (zenoh.Priority.REAL_TIME, zenoh.Priority.DATA)]

        def arrives(number: int) -> bool:
            for kind in kinds:
                kind.put(b"%d" % number)
            return any(sample.payload.to_bytes() == b"%d" % number for sample in iter(heard.try_recv, None))

        assert wait_for(lambda: arrives(0), 10.0)
        for number, wire in enumerate(wires, 1):
            wire.end()
            Carried(gate, listen, stack)  # dialled again
            assert wait_for(partial(arrives, number), 10.0)


class Carried:
    """A connection that a gate accepts, carried on to a listener."""

    def __init__(self, gate: socket.socket, listen: str, stack: ExitStack) -> None:
        self._near = stack.enter_context(gate.accept()[0])
        self._far = stack.enter_context(socket.create_connection(("127.0.0.1", port_of(listen))))
        self.wire = Wire(self._near, self._far)
        self._carrier = Thread(target=self.wire.carry)
        self._carrier.start()
        stack.callback(self.end)

    def end(self) -> None:
        self.wire.alive = False
        self._carrier.join()
        for end in (self._near, self._far):
            end.close()
