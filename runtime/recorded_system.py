"""The system that a session was recorded from, made again from the launch file that the session holds."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterable, Mapping
from typing import Any

from runtime.launch import resolve
from runtime.params import ConfigurationError
from runtime.recording import Recording
from runtime.shared_task import owner_of
from runtime.system import ComponentSpec, System

_PACKAGE = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*")
_SHARED = ("task", "clock")
"""Parameters that the launch file gives to every component that has them."""


def recorded_component(recording: Recording, name: str, overrides: Iterable[str] = ()) -> tuple[System, ComponentSpec]:
    """A component as it was run, with other parameters where asked. The system returned holds it alone.

    Args:
        recording: the session.
        name: of the component in the session.
        overrides: `component.param=value`, `task.key=value` or `session.key=value`.

    Raises:
        ConfigurationError: no session of ours, no such component, a tap, or parameters that this release does not
            understand.
    """
    file = str(recording.file)
    launch = recording.launch()
    if not launch:
        raise ConfigurationError(f"{file}: must be a session of ours; it holds no launch file")
    specs = _specs(launch, file)
    if name not in specs:
        raise ConfigurationError(f"{file}: component {name} is unknown; known are {', '.join(specs)}")
    if specs[name].get("tap"):
        raise ConfigurationError(f"{file}: component {name} must be no tap; a tap has nothing that could be replayed")
    own = tuple(overrides)
    given = {owner_of(override) for override in own}
    for override in own:
        if owner_of(override) not in {name, "task", "session"}:
            raise ConfigurationError(f"--set {override}: must begin with {name}, task or session")
    if not _PACKAGE.fullmatch(str(specs[name].get("run"))):
        raise ConfigurationError(f"{file}: {name}.run must be a package; got {str(specs[name].get('run'))[:80]!r}")
    try:
        system = resolve(_table(launch, name, specs[name], given), file, own)
    except RecursionError:
        raise ConfigurationError(f"{file}: launch.json must not be nested so deep") from None
    return system, system.component(name)


def _specs(launch: Mapping[str, Any], file: str) -> dict[str, Mapping[str, Any]]:
    specs = launch.get("components")
    if not isinstance(specs, list) or not all(isinstance(s, dict) and isinstance(s.get("name"), str) for s in specs):
        raise ConfigurationError(f"{file}: launch.json must hold a list of components with names")
    return {spec["name"]: spec for spec in specs}


def _table(launch: Mapping[str, Any], name: str, spec: Mapping[str, Any], given: set[str]) -> dict[str, Any]:
    """The session's launch file with this component alone, as `resolve` takes it."""
    session = {key: launch[key] for key in ("seed", "stall_s", "end", "trial", "truth") if key in launch}
    clock = launch.get("clock")
    session["clock"] = clock if clock == "lockstep" else launch.get("pace") or "real"
    params = spec.get("params", {})
    if isinstance(params, dict):
        shared = {key for key in _SHARED if {"task": "task", "clock": "session"}[key] in given}
        params = {key: _restored(value) for key, value in params.items() if key not in shared}
    entry = {key: spec[key] for key in ("run", "host", "device", "inputs", "outputs") if key in spec}
    return {
        "realm": launch.get("realm"),
        "session": session,
        "task": launch.get("task", {}),
        "component": {name: {**entry, "params": params}},
    }


def _restored(value: Any) -> Any:
    """Bytes stand in a session as {"base64": text}."""
    if not (isinstance(value, dict) and set(value) == {"base64"}):
        return value
    try:
        return base64.b64decode(value["base64"], validate=True)
    except (TypeError, ValueError):
        return value
