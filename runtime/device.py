"""Which device a component is given: the launch file's table, checked, and opened."""

from __future__ import annotations

import contextlib
import importlib
import threading
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, cast

from runtime.contract import ComponentError, Device, DeviceKind
from runtime.params import ConfigurationError, build
from runtime.system import ComponentSpec, System, ports_of

_REST_S = 1.5
"""A device that can not be brought to rest within this is left to its own watchdog."""


@dataclass(frozen=True)
class _Nothing:
    """Parameters of what has none."""


def kind_of(spec: ComponentSpec) -> DeviceKind | None:
    """The device that a component is to be given; None for one that has none or a simulated one."""
    return kinds(spec.run).get(str(spec.device.get("kind")))


def kinds(run: str) -> Mapping[str, DeviceKind | None]:
    """The devices that a component knows; None = a kind that another component of the system plays, over the bus."""
    return cast("Mapping[str, DeviceKind | None]", getattr(ports_of(run), "DEVICES", {}))


def checked_device(run: str, table: Mapping[str, Any], where: str) -> Mapping[str, Any]:
    """A launch file's `device` table, as it is.

    Raises:
        ConfigurationError: an unknown kind or key, a broken rule.
    """
    if not table:
        return table
    known, name = kinds(run), table.get("kind")
    if not isinstance(name, str) or name not in known:
        raise ConfigurationError(f"{where}.kind must be one of {', '.join(known) or 'none'}; got {name!r}")
    kind = known[name]
    build(_Nothing if kind is None else kind.params, _without_kind(table), where)
    return table


def check_clock(system: System) -> None:
    """Refuse devices in lockstep: the world does not wait for anybody's answer.

    Raises:
        ConfigurationError: names the first device.
    """
    for spec in system.here:
        if system.clock == "lockstep" and kind_of(spec) is not None:
            raise ConfigurationError(
                f"{system.file}: {spec.name}.device must not be {spec.device['kind']!r} in lockstep: the world waits "
                "for nobody (--clock real)"
            )


def opened(spec: ComponentSpec, file: str) -> Device | None:
    """Open a component's device, if it has one.

    Raises:
        DeviceError: it can not be opened.
        ConfigurationError: its table is not valid.
    """
    kind = kind_of(spec)
    if kind is None:
        return None
    params = build(kind.params, _without_kind(spec.device), f"{file}: {spec.name}.device")
    module, _, name = kind.run.partition(":")
    device: Device = getattr(importlib.import_module(module), name)(params)
    return device


def lay_to_rest(spec: ComponentSpec) -> None:
    """Bring a component's device to rest after the component's process has died; wait for it a moment at the most."""
    kind = kind_of(spec)
    if kind is not None and kind.rest:
        thread = threading.Thread(target=_rest, args=(kind, spec), daemon=True, name="rest")
        thread.start()
        thread.join(_REST_S)


def _rest(kind: DeviceKind, spec: ComponentSpec) -> None:
    module, _, name = kind.rest.partition(":")
    with contextlib.suppress(ComponentError, OSError):  # it is gone, too
        getattr(importlib.import_module(module), name)(build(kind.params, _without_kind(spec.device), spec.name))


def _without_kind(table: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in table.items() if key != "kind"}
