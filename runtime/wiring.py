"""The graph of a system: who publishes which key, who reads it, and what is wrong with it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from runtime.contract import Peers, Port
from runtime.params import ConfigurationError
from runtime.system import ComponentSpec, System, ports_of


class Wire(NamedTuple):
    """One input port and the output port that feeds it."""

    source: str
    output: str
    key: str
    target: str
    input: str


def publishers(system: System) -> dict[str, tuple[str, str]]:
    """Key below the realm -> (component, output port).

    Raises:
        ConfigurationError: two components on one key.
    """
    found: dict[str, tuple[str, str]] = {}
    for spec in system.components:
        for port, key in spec.outputs.items():
            if key in found:
                raise ConfigurationError(
                    f"{system.file}: {spec.name}.outputs.{port} must not share a key; {key!r} is published by "
                    f"{found[key][0]} already"
                )
            found[key] = (spec.name, port)
    return found


def wires(system: System) -> list[Wire]:
    """Every wire, in launch order."""
    sources = publishers(system)
    return [
        Wire(*sources[key], key, spec.name, port)
        for spec in system.components
        for port, key in spec.inputs.items()
        if key in sources
    ]


def check_wiring(system: System) -> None:
    """Refuse a system that can not work.

    Raises:
        ConfigurationError: unknown port, an input wired to nothing, an unwired input, schemas that differ, a wire to
            ground truth, a device that can not do the task, a cycle without delay, camera and base on different hosts.
    """
    sources = publishers(system)
    for spec in system.components:
        _check_inputs(system, spec, sources)
    _check_session_keys(system, sources)
    _check_devices(system)
    _check_cycles(system)
    _check_hosts(system)


def _check_inputs(system: System, spec: ComponentSpec, sources: dict[str, tuple[str, str]]) -> None:
    ports = ports_of(spec.run).INPUTS
    where = f"{system.file}: {spec.name}.inputs"
    wired = {name: port for name, port in ports.items() if isinstance(port, Port)}
    for name, key in spec.inputs.items():
        if name not in wired:
            raise ConfigurationError(f"{where}.{name} is unknown; known are {', '.join(wired)}")
        if key not in sources:
            raise ConfigurationError(f"{where}.{name} must be published by some component; got {key!r}")
        source = _output(system, *sources[key])
        if source.reserved:
            raise ConfigurationError(f"{where}.{name} must not be {key!r}: ground truth is for evaluation only")
        if source.schema is not wired[name].schema:
            raise ConfigurationError(
                f"{where}.{name} must be a {wired[name].schema.DESCRIPTOR.full_name}; {key!r} is a "
                f"{source.schema.DESCRIPTOR.full_name}"
            )
    for name, port in wired.items():
        if not port.optional and name not in spec.inputs:
            raise ConfigurationError(f"{where}.{name} is missing; it must be the key of a {port.schema.__name__}")


def _output(system: System, component: str, port: str) -> Port:
    declared: Port = ports_of(system.component(component).run).OUTPUTS[port]
    return declared


def _check_session_keys(system: System, sources: dict[str, tuple[str, str]]) -> None:
    for name in ("end", "trial", "truth"):
        key = getattr(system, name)
        if key and key not in sources:
            raise ConfigurationError(f"{system.file}: session.{name} must be published by some component; got {key!r}")


def _check_devices(system: System) -> None:
    """A component may know what its device can not do: `check_device(device, params, task, where)` of its ports.

    Raises:
        ConfigurationError: the task needs more.
    """
    task = next((spec.params["task"] for spec in system.components if "task" in spec.params), None)
    for spec in system.components:
        check = getattr(ports_of(spec.run), "check_device", None)
        if check is not None and spec.device and task is not None:
            check(spec.device, spec.params, task, f"{system.file}: {spec.name}")


def _check_cycles(system: System) -> None:
    """Depth-first search over (component, output port): an output follows from the inputs that it is `on`."""
    by_input = {(wire.target, wire.input): (wire.source, wire.output) for wire in wires(system)}
    done: set[tuple[str, str]] = set()
    for spec in system.components:
        for port in spec.outputs:
            _visit(system, (spec.name, port), by_input, done, [])


def _check_hosts(system: System) -> None:
    """Whoever must stop the robot compares capture times with its own clock, so its frames come from its own host."""
    for spec in system.components:
        if any(isinstance(port, Peers) for port in ports_of(spec.run).INPUTS.values()):
            for name in control_path(system, spec.name):
                if (host := system.component(name).host) != spec.host:
                    raise ConfigurationError(
                        f"{system.file}: {name}.host must be {spec.host!r}, that of {spec.name}, which stops by the "
                        f"age of its frames and compares clocks of one machine only; got {host!r}"
                    )


def control_path(system: System, target: str) -> list[str]:
    """The components whose answer to a frame decides what `target` does in that frame, itself included."""
    found, waiting = [target], [target]
    while waiting:
        name = waiting.pop()
        for wire in wires(system):
            per_frame = wire.target == name and _output(system, wire.source, wire.output).per_frame
            if per_frame and wire.source not in found:
                found.append(wire.source)
                waiting.append(wire.source)
    return found


def _visit(
    system: System,
    node: tuple[str, str],
    by_input: dict[tuple[str, str], tuple[str, str]],
    done: set[tuple[str, str]],
    path: list[tuple[str, str]],
) -> None:
    if node in path:
        ring = " <- ".join("/".join(step) for step in [*path[path.index(node) :], node])
        raise ConfigurationError(f"{system.file}: inputs must not form a cycle without delay; got {ring}")
    if node in done:
        return
    for cause in _causes(system, node, by_input):
        _visit(system, cause, by_input, done, [*path, node])
    done.add(node)


def _causes(
    system: System, node: tuple[str, str], by_input: dict[tuple[str, str], tuple[str, str]]
) -> Iterator[tuple[str, str]]:
    port = _output(system, *node)
    if port.delayed:
        return
    for name in port.on:
        if (node[0], name) in by_input:
            yield by_input[node[0], name]
