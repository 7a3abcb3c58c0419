"""Launch files: one whole system in one flat TOML table, checked before anything starts."""

from __future__ import annotations

import copy
import dataclasses
import hashlib
import json
import re
import tomllib
import typing
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import Any, cast

from runtime import shared_task
from runtime.brought import launch_file
from runtime.device import checked_device
from runtime.params import ConfigurationError, build
from runtime.system import ComponentSpec, System, ports_of
from runtime.toml_file import read_toml

_REALM = re.compile(r"[A-Za-z0-9_-]+(/[A-Za-z0-9_-]+)*")
_NAME = re.compile(r"[a-z][a-z0-9_]*")
RESTARTS = ("never", "on-failure", "always")
SECURITIES = ("none", "tls")
KEYS = "keys"
"""Directory of credentials where the launch file and the command line name none."""
_TOP = ("realm", "session", "task", "component", "security", "keys")
_SESSION = {"clock": "lockstep", "seed": 1, "stall_s": 10.0, "end": "", "trial": "", "truth": ""}
_COMPONENT = ("run", "host", "restart", "restart_limit", "device", "inputs", "outputs", "params")


def load(
    file: str | Path,
    overrides: Iterable[str] = (),
    *,
    clock: str = "",
    seed: int | None = None,
    host: str = "",
    only: Collection[str] = (),
    recording: Path | None = None,
    keys: str = "",
) -> System:
    """Read, check and resolve a launch file.

    Args:
        file: path of the TOML file; see `runtime.brought`.
        overrides: `component.param=value`, `task.key=value`, `session.key=value`, or `task=FILE` for the fields of a
            task file; the value as in TOML, text may stand without quotes.
        clock: as on the command line; empty = as in the file.
        seed: as on the command line; None = as in the file.
        host: the machine that this is; empty = all components run here.
        only: keep only these components, on every host; empty = all.
        recording: file for the recorder (a tap with a parameter `file`); None = leave recorders out.
        keys: directory of credentials; given, the hosts know one another by TLS. Empty = as in the file.

    Raises:
        ConfigurationError: one line that names file, key, value and rule.
    """
    file = launch_file(file)
    table = read_toml(file)
    shared_task.include(table, str(file))
    for override in overrides:
        _override(table, override)
    if keys:
        table |= {"security": "tls", "keys": keys}
    session = dict(_table(table, "session", str(file), _SESSION))
    if clock:
        session["clock"] = clock
    if seed is not None:
        session["seed"] = seed
    from runtime.wiring import check_wiring  # noqa: PLC0415  (wiring names this module's types)

    system = _resolved(table, session, str(file))
    check_wiring(system)
    system = _selected(system, host, only, recording)
    return dataclasses.replace(system, text=_text(system, table))


def resolve(table: Mapping[str, Any], file: str, overrides: Iterable[str] = ()) -> System:
    """Check and resolve a table such as a launch file holds, or a part of one; its wiring is not looked at.

    Raises:
        ConfigurationError: as `load`.
    """
    own = copy.deepcopy(dict(table))
    for override in overrides:
        _override(own, override)
    return _resolved(own, _table(own, "session", file, _SESSION), file)


def _selected(system: System, host: str, only: Collection[str], recording: Path | None) -> System:
    """The part of a system that is to run, and which of it here. Wires to what is left out stay."""
    for name in only:
        system.component(name)
    hosts = {spec.host for spec in system.components}
    if host and host not in hosts:
        raise ConfigurationError(f"{system.file}: --host must be one of {', '.join(sorted(hosts))}; got {host!r}")
    kept = []
    for spec in system.components:
        if only and spec.name not in only:
            continue
        if spec.tap and "file" in spec.params:
            if recording is None:
                continue
            file = str(recording) if host in {"", spec.host} else ""
            spec = dataclasses.replace(spec, params={**spec.params, "file": file})  # noqa: PLW2901
        kept.append(spec)
    return dataclasses.replace(system, components=tuple(kept), host=host)


def _override(table: dict[str, Any], override: str) -> None:
    key, sign, text = override.partition("=")
    owner, _, name = key.partition(".")
    if not sign or not (name or key == shared_task.TASK):
        raise ConfigurationError(f"--set {override}: must be COMPONENT.PARAM=VALUE or task=FILE")
    try:
        value = tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        value = text
    if shared_task.is_file(table, owner, name, value):
        shared_task.take(table, value, f"--set {override}:")
        return
    if owner in {"session", "task"}:
        table.setdefault(owner, {})[name] = value
        return
    components = table.get("component", {})
    if owner not in components:
        raise ConfigurationError(f"--set {override}: component {owner} is unknown; known are {', '.join(components)}")
    components[owner].setdefault("params", {})[name] = value


def _table(table: Mapping[str, Any], key: str, where: str, defaults: Mapping[str, Any]) -> Mapping[str, Any]:
    given = table.get(key, {})
    if not isinstance(given, dict):
        raise ConfigurationError(f"{where}: {key} must be a table; got {given!r}")
    for name in given:
        if name not in defaults:
            raise ConfigurationError(f"{where}: {key}.{name} is unknown; known are {', '.join(defaults)}")
    return {**defaults, **given}


def _resolved(table: Mapping[str, Any], session: Mapping[str, Any], file: str) -> System:
    for key in table:
        if key not in _TOP:
            raise ConfigurationError(f"{file}: {key} is unknown; known are {', '.join(_TOP)}")
    realm = table.get("realm")
    if not isinstance(realm, str) or not _REALM.fullmatch(realm):
        raise ConfigurationError(f"{file}: realm must be words joined by /; got {realm!r}")
    security = table.get("security", "none")
    if security not in SECURITIES:
        raise ConfigurationError(f"{file}: security must be one of {', '.join(SECURITIES)}; got {security!r}")
    keys = table.get("keys", KEYS if security == "tls" else "")
    if not isinstance(keys, str) or bool(keys) != (security == "tls"):
        raise ConfigurationError(f'{file}: keys must be a directory, and stand with security = "tls"; got {keys!r}')
    clock, pace = _clock(session["clock"], file)
    seed, stall_s = session["seed"], session["stall_s"]
    if not isinstance(seed, int) or isinstance(seed, bool) or seed < 0:
        raise ConfigurationError(f"{file}: session.seed must be a whole number >= 0; got {seed!r}")
    if not isinstance(stall_s, int | float) or isinstance(stall_s, bool) or not 0 < stall_s < float("inf"):
        raise ConfigurationError(f"{file}: session.stall_s must be > 0; got {stall_s!r}")
    components = table.get("component", {})
    if not isinstance(components, dict) or not components:
        raise ConfigurationError(f"{file}: component must be a table of at least one component")
    specs = tuple(_component(name, entry, _shared(table, clock), seed, file) for name, entry in components.items())
    shared_task.check_same(specs, file)
    followed = {key: str(session[key]) for key in ("end", "trial", "truth")}
    return System(
        file,
        realm,
        clock,
        pace,
        seed,
        float(stall_s),
        **followed,
        components=specs,
        text="",
        security=security,
        keys=keys,
    )


def _clock(value: object, file: str) -> tuple[str, float | None]:
    if value == "lockstep":
        return "lockstep", None
    if value == "real":
        return "real", 1.0
    try:
        pace = float(cast("Any", value))
    except (TypeError, ValueError):
        pace = 0.0
    if not 0 < pace < float("inf"):
        raise ConfigurationError(f"{file}: session.clock must be lockstep, real or a factor > 0; got {value!r}")
    return "real", pace


def _shared(table: Mapping[str, Any], clock: str) -> dict[str, Any]:
    return {"task": table.get("task", {}), "clock": clock}


def _component(name: str, entry: Any, shared: Mapping[str, Any], seed: int, file: str) -> ComponentSpec:
    where = f"{file}: {name}"
    if not _NAME.fullmatch(name):
        raise ConfigurationError(f"{where} must be a lower-case word")
    if not isinstance(entry, dict):
        raise ConfigurationError(f"{where} must be a table; got {entry!r}")
    for key in entry:
        if key not in _COMPONENT:
            raise ConfigurationError(f"{where}.{key} is unknown; known are {', '.join(_COMPONENT)}")
    run = _string(entry, "run", "", where)
    ports = ports_of(run, f"{where}.run")
    host = _string(entry, "host", "robot", where)
    if not _NAME.fullmatch(host):
        raise ConfigurationError(f"{where}.host must be a lower-case word; got {host!r}")
    restart = _string(entry, "restart", "never", where)
    if restart not in RESTARTS:
        raise ConfigurationError(f"{where}.restart must be one of {', '.join(RESTARTS)}; got {restart!r}")
    limit = entry.get("restart_limit", 3)
    if not isinstance(limit, int) or isinstance(limit, bool) or limit < 0:
        raise ConfigurationError(f"{where}.restart_limit must be a whole number >= 0; got {limit!r}")
    aliases = _strings(entry, "outputs", where)
    for port in aliases:
        if port not in ports.OUTPUTS:
            raise ConfigurationError(f"{where}.outputs.{port} is unknown; known are {', '.join(ports.OUTPUTS)}")
    return ComponentSpec(
        name=name,
        run=run,
        host=host,
        restart=restart,
        restart_limit=limit,
        device=checked_device(run, _mapping(entry, "device", where), f"{where}.device"),
        inputs=_strings(entry, "inputs", where),
        outputs={port: aliases.get(port, f"{name}/{port}") for port in ports.OUTPUTS},
        params=_params(ports.Params, _mapping(entry, "params", where), shared, where),
        seed=int.from_bytes(hashlib.sha256(f"{seed}/{name}".encode()).digest()[:4], "little"),
        tap=bool(getattr(ports, "TAP", False)),
    )


def _params(kind: type[Any], given: Mapping[str, Any], shared: Mapping[str, Any], where: str) -> dict[str, Any]:
    hints = typing.get_type_hints(kind)
    values = {key: value for key, value in shared.items() if key in hints}
    values.update(given)
    for key, value in values.items():
        if hints.get(key) is bytes and isinstance(value, str):
            values[key] = _content(value, f"{where}.params.{key}")
    return dataclasses.asdict(build(kind, values, f"{where}.params"))


def _content(path: str, where: str) -> bytes:
    """A parameter of type bytes is given as the path of a file; the session then holds the file itself."""
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise ConfigurationError(f"{where} must be a readable file; got {path!r}: {error.strerror}") from None


def _string(entry: Mapping[str, Any], key: str, default: str, where: str) -> str:
    value = entry.get(key, default)
    if not isinstance(value, str) or not value:
        raise ConfigurationError(f"{where}.{key} must be a text; got {value!r}")
    return value


def _mapping(entry: Mapping[str, Any], key: str, where: str) -> dict[str, Any]:
    value = entry.get(key, {})
    if not isinstance(value, dict):
        raise ConfigurationError(f"{where}.{key} must be a table; got {value!r}")
    return value


def _strings(entry: Mapping[str, Any], key: str, where: str) -> dict[str, str]:
    value = _mapping(entry, key, where)
    for name, text in value.items():
        if not isinstance(text, str) or text.count("/") != 1:
            raise ConfigurationError(f'{where}.{key}.{name} must be "component/port"; got {text!r}')
    return value


def _text(system: System, table: Mapping[str, Any]) -> str:
    """The resolved system as JSON, every parameter with its value: what the session's log keeps."""
    plain = json.loads(system.to_json())
    plain["task"] = table.get("task", {})
    del plain["text"]
    return json.dumps(plain, indent=1, sort_keys=True)
