"""Which host may say and hear what: the access control of a host's router, made from the launch file's graph. Pure.

Default is to deny. A neighbour is known by the common name of its certificate. It may put the keys that the components
behind it publish, announce those components, and subscribe to what they read; a host that records may hear everything
and still says only its recorder's own words. Whatever comes over loopback is this host's own.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import NamedTuple

from runtime.bus import ready_keys
from runtime.contract import Peers, Port
from runtime.live import HOLD_KEY
from runtime.neighbours import HERE, OVER, half_keys
from runtime.params import ConfigurationError
from runtime.system import ComponentSpec, System, ports_of
from runtime.tap import known_keys
from runtime.wishes import wish_key

SUPERVISOR = "supervisor"
_INGRESS, _EGRESS = "ingress", "egress"
_ALL = (
    "put",
    "delete",
    "query",
    "reply",
    "declare_subscriber",
    "declare_queryable",
    "liveliness_token",
    "liveliness_query",
    "declare_liveliness_subscriber",
)


class Right(NamedTuple):
    """What may pass between this host and a neighbour."""

    flow: str
    """As this host's router sees it."""
    messages: tuple[str, ...]
    keys: tuple[str, ...]
    """Whole keys or key expressions, realm included."""


def access_control(system: System) -> dict[str, object]:
    """Zenoh's `access_control` for the router of this host.

    Args:
        system: with `host`; of several hosts.
    """
    rules = [_rule("here", Right(flow, _ALL, _everything(system.realm))) for flow in (_INGRESS, _EGRESS)]
    subjects: list[dict[str, object]] = [{"id": "here", "link_protocols": ["tcp"]}]
    policies = [{"rules": [str(rule["id"]) for rule in rules], "subjects": ["here"]}]
    for neighbour in system.other_hosts:
        granted = [_rule(f"{neighbour}-{i}", right) for i, right in enumerate(rights(system, neighbour))]
        rules += granted
        subjects.append({"id": neighbour, "cert_common_names": [neighbour], "link_protocols": ["tls"]})
        policies.append({"rules": [str(rule["id"]) for rule in granted], "subjects": [neighbour]})
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": rules,
        "subjects": subjects,
        "policies": policies,
    }


def rights(system: System, neighbour: str) -> list[Right]:
    """All that a neighbour may do, and be told, at this host's router."""
    behind = _behind(system, neighbour)
    ours = tuple(host for host in _hosts(system) if host not in behind)
    heard = _read(system, behind)
    told = [key for key in _written(system, ours) if key in heard or _hears_all(system, behind)]
    tokens = tuple(half_keys(system.realm, state) for state in (HERE, OVER))
    looks = (ready_keys(system.realm), *tokens)
    found = [
        Right(_INGRESS, ("put",), tuple(_written(system, behind))),
        Right(_EGRESS, ("put",), tuple(told)),
        Right(_INGRESS, ("declare_subscriber",), tuple(heard)),
        Right(_EGRESS, ("declare_subscriber",), tuple(_read(system, ours))),
        Right(_INGRESS, ("liveliness_token",), tuple(_tokens(system, behind))),
        Right(_EGRESS, ("liveliness_token",), tuple(_tokens(system, ours))),
        *(Right(flow, ("liveliness_query", "declare_liveliness_subscriber"), looks) for flow in (_INGRESS, _EGRESS)),
    ]
    return [right for right in found if right.keys]


def check_topology(system: System, *, listens: bool, connects: bool) -> None:
    """With three hosts or more, all links meet where the robot is stopped: only this host passes on what others say.

    Raises:
        ConfigurationError: this host listens or connects and must not.
    """
    centre = _centre(system)
    if len(_hosts(system)) < 3 or (listens, connects) == (system.host == centre, system.host != centre):
        return
    must = "--listen, not --connect" if system.host == centre else f"--connect, not --listen: {centre} listens"
    raise ConfigurationError(f"{system.file}: with three hosts, --host {system.host} must stand with {must}")


def _rule(name: str, right: Right) -> dict[str, object]:
    return {
        "id": f"{name}-{right.flow}",
        "permission": "allow",
        "flows": [right.flow],
        "messages": list(right.messages),
        "key_exprs": list(right.keys),
    }


def _everything(realm: str) -> tuple[str, ...]:
    """`**` does not match verbatim chunks (those with @)."""
    tokens = (half_keys(realm, HERE), half_keys(realm, OVER))
    return ("**", ready_keys(realm), *tokens, wish_key(realm, "*"))


def _hosts(system: System) -> tuple[str, ...]:
    return tuple(dict.fromkeys(spec.host for spec in system.components))


def _centre(system: System) -> str:
    """The host that stops the robot; in a system without one, the first."""
    stops = [spec.host for spec in system.components if any(isinstance(p, Peers) for p in _inputs(spec).values())]
    return (stops or [system.components[0].host])[0]


def _behind(system: System, neighbour: str) -> tuple[str, ...]:
    """The hosts whose words come from this neighbour: the centre passes on what the others say."""
    if neighbour == _centre(system):
        return tuple(host for host in _hosts(system) if host != system.host)
    return (neighbour,)


def _on(system: System, hosts: Collection[str]) -> Iterator[ComponentSpec]:
    return (spec for spec in system.components if spec.host in hosts)


def _written(system: System, hosts: Collection[str]) -> list[str]:
    """Keys, realm included, that these hosts publish."""
    names = {spec.name for spec in _on(system, hosts)}
    if system.clock == "lockstep" and hosts:
        names.add(SUPERVISOR)  # holds time while it starts a component again
    return [f"{system.realm}/{key}" for key, _, publisher in known_keys(system) if publisher in names]


def _read(system: System, hosts: Collection[str]) -> list[str]:
    """Keys, realm included, that these hosts subscribe to: inputs, and what every supervisor follows."""
    if not hosts:
        return []
    own = [key for spec in _on(system, hosts) for key in spec.inputs.values()]
    own += [key for key in (system.end, system.trial, system.truth) if key]
    own += [key for spec in system.components if spec.tap for key in spec.outputs.values()]
    own += [HOLD_KEY] if system.clock == "lockstep" else []
    everything = ["**"] if _hears_all(system, hosts) else []
    return [f"{system.realm}/{key}" for key in dict.fromkeys([*everything, *own])]


def _hears_all(system: System, hosts: Collection[str]) -> bool:
    return any(spec.tap for spec in _on(system, hosts))


def _tokens(system: System, hosts: Collection[str]) -> list[str]:
    """Key expressions of the tokens that these hosts may declare: who runs there, and that they are there."""
    names = [spec.name for spec in _on(system, hosts)] + ([SUPERVISOR] if hosts else [])
    ready = [ready_keys(system.realm).replace("*/*/*", f"*/{name}/*") for name in names]
    halves = [f"{system.realm}/{state}/{host}/*/*" for state in (HERE, OVER) for host in hosts]
    return ready + halves


def _inputs(spec: ComponentSpec) -> dict[str, Port | object]:
    return dict(ports_of(spec.run).INPUTS)
