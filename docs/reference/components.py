"""The page of the components: ports, devices and parameters, from every `ports.py`."""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

from docking.task import Task
from docs.reference.parameters import parameters
from docs.reference.tables import code, table
from runtime.contract import DeviceKind, Port, Tick

ROOT = Path(__file__).parents[2]


def names() -> list[str]:
    """Folders of `components/`, sorted."""
    return sorted(file.parent.name for file in (ROOT / "components").glob("*/ports.py"))


HEAD = """# Components

Written from each component's `ports.py` and from `docking/task.py`. A parameter is set in the launch file
(`params = { ... }`) or with `--set COMPONENT.PARAMETER=VALUE`; those of the task stand in `[task]`, or
`--set task.PARAMETER=VALUE`.

## task
"""


def page() -> str:
    """The page."""
    parts = [HEAD, f"{Task.__doc__}\n", parameters(Task)]
    for name in names():
        parts += _component(name)
    return "\n".join(parts)


def _component(name: str) -> Iterator[str]:
    ports = importlib.import_module(f"components.{name}.ports")
    yield f"## {name}\n"
    yield f"{_purpose(ports)}\n"
    yield from _ports("### Inputs of " + name, getattr(ports, "INPUTS", {}))
    yield from _ports("### Outputs of " + name, getattr(ports, "OUTPUTS", {}))
    yield from _devices(name, getattr(ports, "DEVICES", {}))
    if rows := parameters(ports.Params):
        yield f"### Parameters of {name}\n"
        yield rows


def _purpose(ports: ModuleType) -> str:
    """First sentence of the module's docstring, without its last words, which are the same everywhere."""
    first = (ports.__doc__ or "").split("\n\n")[0]
    return first.removesuffix(": parameters and ports.").removesuffix(".") + "."


def _ports(head: str, declared: Mapping[str, Any]) -> Iterator[str]:
    if declared:
        yield f"{head}\n"
        yield table(
            ("port", "message", "kind", "rate", "notes"), [_port(name, port) for name, port in declared.items()]
        )


def _port(name: str, port: Any) -> tuple[str, ...]:
    if isinstance(port, Tick):
        return code(name), "", "the shell's clock", f"{port.hz:g} Hz", ""
    if not isinstance(port, Port):
        return code(name), "", "from the shell", "", " ".join((type(port).__doc__ or "").split(": ", 1)[-1].split())
    schema = port.schema.DESCRIPTOR.full_name
    rate = f"{port.hz:g} Hz" if port.hz else "on occasion"
    return code(name), f"[`{schema}`](messages.md#{_anchor(schema)})", port.kind.value, rate, ", ".join(_notes(port))


def _notes(port: Port) -> Iterator[str]:
    if port.optional:
        yield "may stay unwired"
    if port.per_frame:
        yield "once for every frame"
    if port.on:
        yield "caused by " + ", ".join(code(name) for name in port.on)
    if port.delayed:
        yield "published at a later time than its cause"
    if port.reserved:
        yield "for evaluation only"


def _anchor(schema: str) -> str:
    return schema.rpartition(".")[2].lower()


def _devices(name: str, kinds: Mapping[str, DeviceKind | None]) -> Iterator[str]:
    for kind, device in kinds.items():
        yield f'### `device = {{ kind = "{kind}" }}` of {name}\n'
        if device is None:
            yield "Played by another component of the system: the input `device` is wired to it.\n"
            continue
        yield f"{' '.join((device.params.__doc__ or '').split())} {device.usage}\n"
        yield parameters(device.params)
