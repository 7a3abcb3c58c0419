"""Sessions on the bus: one router per host on loopback, every process a peer of it, no multicast.

Peers listen on loopback and learn of one another from the router, so they form a mesh that outlives it.
"""

from __future__ import annotations

import json
import os
import socket
from collections.abc import Callable

import zenoh

from runtime.foreign_thread import keep_thread_state
from runtime.params import ConfigurationError

LOOPBACK = "127.0.0.1"
_THREADS = "(app:(worker_threads:1),rx:(handover:app),acc:(handover:app),tx:(handover:app),net:(handover:app))"
"""One thread for all of zenoh: fewer hops between threads, a fifth less processor time per message (measured)."""
_READY = "@ready"
"""A verbatim chunk: `REALM/**` does not match it."""


def open_router(endpoint: str) -> zenoh.Session:
    """The host's rendezvous.

    Args:
        endpoint: e.g. `tcp/127.0.0.1:7447`; `free_endpoint()` finds one.

    Raises:
        ConfigurationError: the endpoint is busy or malformed.
    """
    try:
        return zenoh.open(_config("router", listen=endpoint))
    except zenoh.ZError as error:
        raise ConfigurationError(f"endpoint {endpoint} must be free: {_reason(error)}") from None


def open_peer(endpoint: str) -> zenoh.Session:
    """A process of the system, connected to its host's router."""
    return zenoh.open(_config("peer", listen=f"tcp/{LOOPBACK}:0", connect=endpoint))


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


def _config(mode: str, *, listen: str, connect: str = "") -> zenoh.Config:
    os.environ.setdefault("ZENOH_RUNTIME", _THREADS)  # read once, when the process opens its first session
    config = zenoh.Config()
    options: dict[str, object] = {
        "mode": mode,
        "listen/endpoints": [listen],
        "connect/endpoints": [connect] if connect else [],
        "scouting/multicast/enabled": False,
        # Waited out by a race at half of the opens; 0 would lose the first message (both measured).
        "scouting/delay": 50,
        # Leaves segments in /dev/shm behind when killed, and images of 10 kB gain nothing.
        "transport/shared_memory/enabled": False,
    }
    for key, value in options.items():
        config.insert_json5(key, json.dumps(value))
    return config


def _address(endpoint: str) -> tuple[str, int]:
    host, _, port = endpoint.partition("/")[2].rpartition(":")
    return host, int(port)


def _reason(error: Exception) -> str:
    return str(error).splitlines()[0].partition(" at ")[0]
