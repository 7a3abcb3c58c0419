"""A robot's system with the simulator in the place of its devices, so that it can be tried where there is no robot."""

from __future__ import annotations

import dataclasses

from runtime.contract import ACTUATE, DEVICE, Port, Stall
from runtime.device import kind_of
from runtime.launch import resolve
from runtime.params import ConfigurationError
from runtime.system import ComponentSpec, System, ports_of
from runtime.wiring import check_wiring, wires
from schemas.image_pb2 import CompressedImage

_WORLD, _RUN = "simulator", "components.simulator"


def has_world(system: System) -> bool:
    """Whether a component shows frames by itself, in lockstep."""
    inputs = (port for spec in system.components for port in ports_of(spec.run).INPUTS.values())
    return any(isinstance(port, Stall) for port in inputs)


def devices(system: System) -> list[str]:
    """The components that have a real device, with its kind."""
    return [f"{spec.name} ({spec.device['kind']})" for spec in system.components if kind_of(spec) is not None]


def simulated(system: System) -> System:
    """The system with one component more, the simulator, and without the cameras whose pictures it draws.

    Raises:
        ConfigurationError: a part that the simulator needs is missing, or does not fit.
    """
    cameras = [spec for spec in system.components if _picture_keys(system, spec)]
    kept = [spec for spec in system.components if spec not in cameras]
    keys = [key for spec in cameras for key in _picture_keys(system, spec)]
    if len(keys) != 1:
        raise ConfigurationError(f"{system.file}: must have one camera to be tried with the simulator; has {len(keys)}")
    world = _world(system, kept, keys[0])
    made = dataclasses.replace(system, components=(world, *(_fed(spec, world) for spec in kept)))
    check_wiring(made)
    return made


def _picture_keys(system: System, spec: ComponentSpec) -> list[str]:
    """Keys on which a component publishes pictures that another one reads."""
    outputs = ports_of(spec.run).OUTPUTS
    read = {wire.key for wire in wires(system) if wire.source == spec.name != wire.target}
    return [key for port, key in spec.outputs.items() if outputs[port].schema is CompressedImage and key in read]


def _world(system: System, kept: list[ComponentSpec], picture_key: str) -> ComponentSpec:
    table = {
        "realm": system.realm,
        "session": {"clock": system.clock, "seed": system.seed},
        "task": next((spec.params["task"] for spec in kept if "task" in spec.params), {}),
        "component": {_WORLD: {"run": _RUN, "outputs": {"image": picture_key}}},
    }
    inputs = {"trial": system.trial}
    wanted = {port.schema: name for name, port in ports_of(_RUN).INPUTS.items() if isinstance(port, Port)}
    for spec in kept:
        said = ports_of(spec.run).OUTPUTS.get(ACTUATE)
        if said is not None and said.schema in wanted:
            inputs[wanted[said.schema]] = spec.outputs[ACTUATE]
    (world,) = resolve(table, system.file).components
    return dataclasses.replace(world, inputs=inputs)


def _fed(spec: ComponentSpec, world: ComponentSpec) -> ComponentSpec:
    """The component with its device's readings from the simulator."""
    port = ports_of(spec.run).INPUTS.get(DEVICE)
    if not isinstance(port, Port):
        return spec
    outputs = ports_of(world.run).OUTPUTS
    keys = [key for name, key in world.outputs.items() if outputs[name].schema is port.schema]
    if not keys:
        return spec
    return dataclasses.replace(spec, device={}, inputs={**spec.inputs, DEVICE: keys[0]})
