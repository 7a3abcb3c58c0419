"""The one task of a system, out of the launch file's `[task]` and of task files: the same for all its components."""

from __future__ import annotations

import typing
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from runtime.params import ConfigurationError, build
from runtime.system import ComponentSpec, ports_of
from runtime.toml_file import read_toml

TASK = "task"
"""Table of a launch file, and the parameter of every component that is given it."""


def owner_of(override: str) -> str:
    """Whom an override `OWNER.NAME=VALUE` is for: a component, `session`, or the task, whoever is named with it."""
    key, sign, _ = override.partition("=")
    owner, _, name = key.partition(".")
    return TASK if sign and TASK in {key, name} else owner


def include(table: dict[str, Any], where: str) -> None:
    """Put the fields of `[task] file = "..."` in its place; what the launch file itself has goes before.

    Raises:
        ConfigurationError: there is no such file, or it holds no task.
    """
    task = table.get(TASK)
    if isinstance(task, dict) and "file" in task:
        own = {key: value for key, value in task.items() if key != "file"}
        table[TASK] = {**_fields(task["file"], table, f"{where}: task.file"), **own}


def is_file(table: Mapping[str, Any], owner: str, name: str, value: object) -> bool:
    """Whether an override names a task file: `task=FILE`, or `COMPONENT.task=FILE`, which means the same."""
    return (not name and owner == TASK) or (name == TASK and isinstance(value, str) and _kind(table, owner) is not None)


def take(table: dict[str, Any], value: object, where: str) -> None:
    """The fields of a task file go before those of the launch file.

    Raises:
        ConfigurationError: as `include`.
    """
    own = table.get(TASK, {})
    table[TASK] = {**(own if isinstance(own, dict) else {}), **_fields(value, table, where)}


def check_same(specs: Iterable[ComponentSpec], file: str) -> None:
    """Refuse two components with different tasks: one would drive to another goal than the other learns.

    Raises:
        ConfigurationError: names the two.
    """
    tasked = [spec for spec in specs if TASK in spec.params]
    for spec in tasked:
        if spec.params[TASK] != tasked[0].params[TASK]:
            raise ConfigurationError(
                f"{file}: {spec.name}.params.task must be that of {tasked[0].name}; give it once, in [task]"
            )


def _fields(path: object, table: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Fields of a task file, refused in its own name if they are none of a task."""
    if not isinstance(path, str) or not path:
        raise ConfigurationError(f"{where} must be the path of a task file; got {path!r}")
    fields = read_toml(Path(path))
    kinds = [kind for owner in _components(table) if (kind := _kind(table, owner)) is not None]
    if kinds:
        build(kinds[0], fields, path)
    return fields


def _components(table: Mapping[str, Any]) -> Mapping[str, Any]:
    components = table.get("component", {})
    return components if isinstance(components, dict) else {}


def _kind(table: Mapping[str, Any], owner: str) -> type[Any] | None:
    """Type of a component's task; None if it has none. What is wrong with the component is said elsewhere."""
    entry = _components(table).get(owner, {})
    run = entry.get("run") if isinstance(entry, dict) else None
    if not isinstance(run, str) or not run:
        return None
    try:
        return typing.get_type_hints(ports_of(run).Params).get(TASK)
    except ConfigurationError:
        return None
