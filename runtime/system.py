"""A resolved system: its components, and how their code is found."""

from __future__ import annotations

import base64
import dataclasses
import importlib
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any, cast

from runtime.params import ConfigurationError, build

_PACKAGE = re.compile(r"[^\W\d]\w*(\.[^\W\d]\w*)*")


@dataclass(frozen=True)
class ComponentSpec:
    """One process, resolved: everything that its shell needs to run it."""

    name: str
    run: str
    """Package of the component, e.g. `components.tracker`."""
    host: str
    restart: str
    restart_limit: int
    device: Mapping[str, Any]
    inputs: Mapping[str, str]
    """Input port -> key below the realm, e.g. `vision/view`."""
    outputs: Mapping[str, str]
    """Every output port -> key below the realm; `component/port` unless the launch file gives an alias."""
    params: Mapping[str, Any]
    """Plain values of every parameter, task and clock included."""
    seed: int
    tap: bool
    """A tap gets the whole bus instead of ports (recorder, viewer)."""


@dataclass(frozen=True)
class System:
    """A launch file, checked and resolved."""

    file: str
    realm: str
    clock: str
    """`lockstep` or `real`."""
    pace: float | None
    """Session seconds per wall second; None = as fast as possible."""
    seed: int
    stall_s: float
    end: str
    trial: str
    truth: str
    components: tuple[ComponentSpec, ...]
    text: str
    """The resolved launch file, for the session's log."""
    host: str = ""
    """This machine, one of the components' hosts; empty = all components run here."""
    security: str = "none"
    """`none` or `tls`: how the hosts know one another."""
    keys: str = ""
    """Directory with this host's credentials, for `tls`."""

    @property
    def here(self) -> tuple[ComponentSpec, ...]:
        """The components that run on this machine."""
        return tuple(spec for spec in self.components if self.is_here(spec.name))

    @property
    def other_hosts(self) -> tuple[str, ...]:
        """The machines that run the other components, in launch order."""
        return tuple(dict.fromkeys(spec.host for spec in self.components if self.host and spec.host != self.host))

    def is_here(self, name: str) -> bool:
        """Whether a component, or `supervisor`, runs on this machine."""
        return not any(spec.name == name and self.host and spec.host != self.host for spec in self.components)

    @property
    def recording(self) -> Path | None:
        """File that the system's recorder writes on this machine; None without one."""
        files = [str(spec.params.get("file", "")) for spec in self.here if spec.tap]
        return next((Path(file) for file in files if file), None)

    def component(self, name: str) -> ComponentSpec:
        """The component of this name."""
        for spec in self.components:
            if spec.name == name:
                return spec
        raise ConfigurationError(
            f"{self.file}: component {name} is unknown; known are {', '.join(c.name for c in self.components)}"
        )

    def to_json(self) -> str:
        """Text from which `from_json` makes the same system."""
        return json.dumps(dataclasses.asdict(self), default=_plain, sort_keys=True)

    @staticmethod
    def from_json(text: str) -> System:
        """Inverse of `to_json`; for text of our own supervisor."""
        table = json.loads(text, object_hook=_bytes)
        table["components"] = tuple(ComponentSpec(**spec) for spec in table["components"])
        return System(**table)


def ports_of(run: str, where: str = "run") -> ModuleType:
    """Module that declares Params, INPUTS and OUTPUTS of a component.

    Raises:
        ConfigurationError: there is no such component.
    """
    if not _PACKAGE.fullmatch(run):
        raise ConfigurationError(f"{where} must name a package with a ports.py; got {run!r}")
    try:
        return importlib.import_module(run + ".ports")
    except ModuleNotFoundError as missing:
        if missing.name is not None and not (run + ".ports").startswith(missing.name):
            raise
        raise ConfigurationError(f"{where} must name a package with a ports.py; got {run!r}") from None


def class_of(run: str) -> type[Any]:
    """The component's class: the CamelCase of its folder's name."""
    module = importlib.import_module(run + ".component")
    name = "".join(part.capitalize() for part in run.rsplit(".", 1)[-1].split("_"))
    return cast("type[Any]", getattr(module, name))


def params_of(spec: ComponentSpec, file: str = "") -> Any:
    """The component's parameter dataclass, built from its resolved values."""
    return build(ports_of(spec.run).Params, spec.params, f"{file}: {spec.name}.params")


def _plain(value: object) -> object:
    if isinstance(value, bytes):
        return {"base64": base64.b64encode(value).decode()}
    raise TypeError(f"{value!r} has no JSON form")


def _bytes(table: dict[str, Any]) -> Any:
    return base64.b64decode(table["base64"]) if set(table) == {"base64"} else table
