"""`berth run --shadow POLICY`: a second pilot sees what the one that drives sees, and is obeyed by nobody."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from pathlib import Path

from cli.policies import LEARNER, controller_and_file, pilot_of
from runtime.params import ConfigurationError
from runtime.system import ComponentSpec, System, params_of

NAME = "shadow"


def with_shadow(system: System, policy: str) -> System:
    """The system with a pilot named `shadow`, whose drive is wired to nobody and never engaged.

    Args:
        system: resolved; one of its components runs the pilot.
        policy: a policy file, `lc`, or `learner` for what the session's own learner has learned so far.

    Raises:
        ConfigurationError: no such policy, no pilot, or a component named shadow already.
    """
    pilot = pilot_of(system)
    if any(spec.name == NAME for spec in system.components):
        raise ConfigurationError(f"{system.file}: must have no component named {NAME} if --shadow is given")
    if policy == LEARNER and "policy" not in pilot.inputs:
        raise ConfigurationError(f"--shadow learner: {system.file} must wire a policy to {pilot.name}")
    shadow = _shadow(system, pilot, policy)
    params_of(shadow, system.file)
    place = system.components.index(pilot) + 1
    components = (*system.components[:place], shadow, *system.components[place:])
    beside = dataclasses.replace(system, components=components)
    return dataclasses.replace(beside, text=_text(beside))


def _shadow(system: System, pilot: ComponentSpec, policy: str) -> ComponentSpec:
    controller, file = controller_and_file(policy, "--shadow")
    inputs = {"percept", "base", *({"policy"} if policy == LEARNER else ())}
    own = {
        "shadow": True,
        "evaluation_controller": controller,
        "policy": Path(file).read_bytes() if file else b"",
        "rival_controller": "",
    }
    return dataclasses.replace(
        pilot,
        name=NAME,
        restart="on-failure",
        inputs={port: key for port, key in pilot.inputs.items() if port in inputs},
        outputs={port: f"{NAME}/{port}" for port in pilot.outputs},
        params={**pilot.params, **own},
        seed=int.from_bytes(hashlib.sha256(f"{system.seed}/{NAME}".encode()).digest()[:4], "little"),
    )


def _text(system: System) -> str:
    """The resolved launch file of the log, with all components."""
    table = json.loads(system.text)
    table["components"] = json.loads(system.to_json())["components"]
    return json.dumps(table, indent=1, sort_keys=True)
