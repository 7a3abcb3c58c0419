"""Sessions on the bus: one router per host on loopback, every process a peer of it, no multicast.

Peers listen on loopback and learn of one another from the router, so they form a mesh that outlives it. Routers of
two hosts do not tell one another of their peers, so nobody dials the other host's loopback (measured).
"""

from __future__ import annotations

import ctypes
import json
import os
import socket
from collections.abc import Callable, Mapping
from types import MappingProxyType

import zenoh

from runtime.foreign_thread import keep_thread_state
from runtime.lingering import keep_from_lingering
from runtime.link import Link
from runtime.params import ConfigurationError

LOOPBACK = "127.0.0.1"
_THREADS = "(app:(worker_threads:1),rx:(handover:app),acc:(handover:app),tx:(handover:app),net:(handover:app))"
"""One thread for all of zenoh: fewer hops between threads, a fifth less processor time per message (measured)."""
ALONE = Link()
_NOTHING: Mapping[str, object] = MappingProxyType({})
_GUEST_S = 0.5
"""A router elsewhere that does not answer within this is not there."""
_RETRY = {"period_init_ms": 500, "period_max_ms": 500, "period_increase_factor": 1}
_READY = "@ready"
"""A verbatim chunk: `REALM/**` does not match it."""


def open_router(endpoint: str, link: Link = ALONE, clock: str = "lockstep") -> zenoh.Session:
    """The host's rendezvous.

    Args:
        endpoint: e.g. `tcp/127.0.0.1:7447`; `free_endpoint()` finds one.
        link: to another host's router.
        clock: of the session, `lockstep` or `real`.

    Raises:
        ConfigurationError: an endpoint is busy or malformed.
    """
    listen = [endpoint, link.listen] if link.listen else [endpoint]
    connect = [link.connect] if link.connect else []
    try:
        session = zenoh.open(_config("router", listen, connect, link.options(clock)))
    except zenoh.ZError as error:
        raise ConfigurationError(f"endpoint {' and '.join(listen)} must be free: {_reason(error)}") from None
    never_drop(session)
    return session


def open_peer(endpoint: str) -> zenoh.Session:
    """A process of the system, connected to its host's router."""
    return zenoh.open(_config("peer", [f"tcp/{LOOPBACK}:0"], [endpoint]))


def open_observer(endpoint: str) -> zenoh.Session:
    """A tool that looks at the bus.

    Raises:
        ConfigurationError: nobody is there.
    """
    try:
        with socket.create_connection(_address(endpoint), timeout=1.0):
            pass
        return open_peer(endpoint)
    except (OSError, zenoh.ZError) as error:
        raise ConfigurationError(f"endpoint {endpoint} must be a running system: {_reason(error)}") from None


def open_client(endpoint: str, zid: str) -> zenoh.Session:
    """A guest at somebody else's router, a robot's for instance; zenoh finds it again after every loss.

    A client: with `peers_failover_brokering` off, as routers of rmw_zenoh have it, one peer hears nothing of another.

    Args:
        endpoint: of the router.
        zid: id of the session, hexadecimal, without leading zeros.

    Raises:
        OSError: nobody is there.
    """
    with socket.create_connection(_address(endpoint), timeout=_GUEST_S):
        pass
    more = {"id": zid, "connect/retry": _RETRY, "transport/link/tx/lease": 1000}
    try:
        return zenoh.open(_config("client", [], [endpoint], more))
    except zenoh.ZError as error:
        raise ConnectionError(_reason(error)) from None


def is_listened_on(endpoint: str) -> bool:
    """Whether somebody accepts connections there."""
    try:
        with socket.create_connection(_address(endpoint), timeout=1.0):
            return True
    except OSError:
        return False


def free_endpoint() -> str:
    """An endpoint on loopback that nobody listened on a moment ago."""
    with socket.socket() as probe:
        probe.bind((LOOPBACK, 0))
        return f"tcp/{LOOPBACK}:{probe.getsockname()[1]}"


def ready_key(realm: str, stage: int, name: str, run: int) -> str:
    """Liveliness token of a process: stage 1 = it listens, stage 2 = it has seen that all others listen."""
    return f"{realm}/{_READY}/{stage}/{name}/{run:016x}"


def ready_keys(realm: str) -> str:
    """All liveliness tokens of a realm."""
    return f"{realm}/{_READY}/*/*/*"


def parse_ready_key(key: str) -> tuple[int, str, int]:
    """Inverse of `ready_key`: (stage, component, run)."""
    stage, name, run = key.rsplit("/", 3)[1:]
    return int(stage), name, int(run, 16)


def direct(receive: Callable[[zenoh.Sample], None]) -> zenoh.handlers.Callback[zenoh.Sample]:
    """Handler that is called on zenoh's own thread: no thread, no second queue in between."""

    def call(sample: zenoh.Sample) -> None:
        keep_thread_state()
        receive(sample)

    return zenoh.handlers.Callback(call, indirect=False)


def _config(mode: str, listen: list[str], connect: list[str], more: Mapping[str, object] = _NOTHING) -> zenoh.Config:
    os.environ.setdefault("ZENOH_RUNTIME", _THREADS)  # read once, when the process opens its first session
    keep_from_lingering()
    config = zenoh.Config()
    options: dict[str, object] = {
        "mode": mode,
        "listen/endpoints": listen,
        "connect/endpoints": connect,
        "scouting/multicast/enabled": False,
        # Else two peers that hear of one another dial both, and four of five pairs keep two connections (measured).
        "scouting/gossip/autoconnect_strategy": {"peer": {"to_router": "always", "to_peer": "greater-zid"}},
        # Waited out by a race at half of the opens; 0 would lose the first message (both measured).
        "scouting/delay": 50,
        # Leaves segments in /dev/shm behind when killed, and images of 10 kB gain nothing.
        "transport/shared_memory/enabled": False,
        # Images in a queue of two are lost to a recorder that a busy machine keeps waiting for a tenth of a second.
        "transport/link/tx/queue/size/data_low": 8,
        **more,
    }
    for key, value in options.items():
        config.insert_json5(key, json.dumps(value))
    return config


def never_drop(router: zenoh.Session) -> None:
    """Let a router's session, closed or not, live as long as its process.

    To drop one, zenoh 1.10.2 waits for its own thread while it holds Python's lock; that thread may be waiting for this
    lock, to call back for another session of the process, and then both wait for ever (seen with gdb).
    """
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(router))


def _address(endpoint: str) -> tuple[str, int]:
    host, _, port = endpoint.partition("/")[2].rpartition(":")
    return host.strip("[]"), int(port)


def _reason(error: Exception) -> str:
    return str(error).splitlines()[0].partition(" at ")[0]
