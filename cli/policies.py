"""Policies as the command line names them: a file, or a word."""

from __future__ import annotations

from pathlib import Path

from components.pilot.ports import is_policy
from runtime.params import ConfigurationError
from runtime.system import ComponentSpec, System

LC, LEARNER = "lc", "learner"
"""The linear law; what the session's own learner has learned so far."""
_PILOT = "components.pilot"


def controller_and_file(name: str, option: str) -> tuple[str, str]:
    """(controller, path of the policy) for the pilot's parameters; the path is empty where there is none.

    Raises:
        ConfigurationError: neither a word that is known nor a policy file.
    """
    if name in {LC, LEARNER}:
        return (LC if name == LC else "greedy"), ""
    try:
        content = Path(name).read_bytes()
    except OSError as error:
        raise ConfigurationError(f"{option} must be lc or a policy file; got {name!r}: {error.strerror}") from None
    if not content or not is_policy(content):
        raise ConfigurationError(f"{option} must be lc or a policy file; {name!r} holds no policy")
    return "greedy", name


def pilot_of(system: System) -> ComponentSpec:
    """The component that drives.

    Raises:
        ConfigurationError: the launch file has none.
    """
    for spec in system.components:
        if spec.run == _PILOT:
            return spec
    raise ConfigurationError(f"{system.file}: must have a component that runs {_PILOT}")
