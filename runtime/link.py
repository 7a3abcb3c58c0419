"""The link between two hosts of one system: router to router, everything else stays on loopback."""

from __future__ import annotations

import ipaddress
import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from runtime.params import ConfigurationError

_ENDPOINT = re.compile(r"(?:tcp|tls)/(\[[0-9a-fA-F:.]+\]|[A-Za-z0-9._-]+):([0-9]{1,5})")
_LEASE_MS = 1000
"""Real time: a link that is silent for so long is down."""
_RETRY_MS = 500
"""Longest wait between two attempts to connect."""
_OPEN_MS = 1000
"""An attempt on a dead network is given up after this; TCP itself would wait for seconds between two tries."""
_BATCHES = 16
"""64 KiB each, of ordinary data: what waits while the air is busy, before it is dropped."""


@dataclass(frozen=True)
class Link:
    """Where this host's router meets that of another host. Both empty = this host is alone."""

    listen: str = ""
    """Endpoint, e.g. `tcp/0.0.0.0:7447`."""
    connect: str = ""
    """Endpoint of the other host's router."""
    guard: Mapping[str, object] = field(default_factory=dict, compare=False, repr=False)
    """Settings that let in only whom the keys and the launch file name (`runtime.guard`); empty = everybody."""

    def options(self, clock: str) -> dict[str, object]:
        """Settings of the router's session.

        In real time nothing that crosses a router may block: a dead link would hold back the processes of this host
        for 3.7 s (measured with a cut of 3 s). Lockstep waits for the link as it waits for everything.
        """
        if self == Link():
            return {}
        options: dict[str, object] = {
            **self.guard,
            "connect/retry": {"period_init_ms": 200, "period_max_ms": _RETRY_MS, "period_increase_factor": 1.5},
            "transport/unicast/open_timeout": _OPEN_MS,
        }
        if clock == "real":
            options["transport/link/tx/lease"] = _LEASE_MS
            options["transport/link/tx/queue/size/data"] = _BATCHES
            options["qos/network"] = [
                {
                    "id": "link",
                    "messages": ["put", "delete"],
                    "flows": ["egress"],
                    "key_exprs": ["**"],
                    "overwrite": {"congestion_control": "drop"},
                }
            ]
        return options


def checked_link(listen: str, connect: str, *, insecure: bool, tls: bool = False) -> Link:
    """A link as asked for on the command line.

    Args:
        listen: endpoint, or empty.
        connect: endpoint, or empty.
        insecure: whoever reaches this host may come in.
        tls: the launch file has security; the link's guard is added later.

    Raises:
        ConfigurationError: no endpoint, or one that would let strangers in without being asked for.
    """
    for option, endpoint in (("--listen", listen), ("--connect", connect)):
        protocol, why = ("tls", " with security") if tls else ("tcp", "")
        if endpoint and not (_ENDPOINT.fullmatch(endpoint) and endpoint.startswith(protocol)):
            raise ConfigurationError(f"{option} must be {protocol}/ADDRESS:PORT{why}; got {endpoint[:80]!r}")
    if tls and insecure:
        raise ConfigurationError("--insecure must stand without security: take one or the other")
    if listen and not (insecure or tls) and not is_loopback(listen):
        raise ConfigurationError(
            "--listen must be on loopback, or stand with --keys (or --insecure): without keys whoever reaches this "
            f"endpoint can drive the robot; got {listen!r}"
        )
    return Link(listen, connect)


def is_loopback(endpoint: str) -> bool:
    """Whether an endpoint is reached from its own machine alone."""
    found = _ENDPOINT.fullmatch(endpoint)
    if found is None:
        return False
    try:
        return ipaddress.ip_address(found[1].strip("[]")).is_loopback
    except ValueError:
        return found[1] == "localhost"
