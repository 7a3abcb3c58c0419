"""What findings change in a launch file: the values, the lines to paste, the edit."""

from __future__ import annotations

import dataclasses
import json
import os
import re
import tempfile
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from cli.inspection import of_run
from runtime.params import ConfigurationError
from runtime.system import System, params_of
from schemas.inspection_pb2 import Finding

Table = dict[str, Any]


class Correction(NamedTuple):
    """One parameter of one component."""

    component: str
    param: str
    value: float | bool | list[float]

    @property
    def override(self) -> str:
        """As `--set` takes it."""
        return f"{self.component}.{self.param}={literal(self.value)}"


def corrections(system: System, findings: Iterable[Finding]) -> list[Correction]:
    """The parameters that put right what was found, from those in force."""
    found = []
    for finding in findings:
        if finding.change == Finding.NOTHING:
            continue  # it may name no component
        spec = of_run(system, finding.component)
        if spec is None:
            continue
        now = spec.params[finding.param]
        found.append(Correction(spec.name, finding.param, _new(finding, now)))
    return found


def _new(finding: Finding, now: float | bool) -> float | bool:
    if finding.change == Finding.FLIP:
        return not now
    value = finding.value * now if finding.change == Finding.MULTIPLY else finding.value
    return float(f"{value:.6g}")


def corrected(system: System, changes: Iterable[Correction]) -> System:
    """The system with these parameters.

    Raises:
        ConfigurationError: a value breaks its parameter's rule.
    """
    specs = {spec.name: spec for spec in system.components}
    for component, param, value in changes:
        spec = specs[component]
        specs[component] = dataclasses.replace(spec, params={**spec.params, param: value})
        params_of(specs[component], system.file)
    return dataclasses.replace(system, components=tuple(specs.values()))


def lines(table: Table, changes: Sequence[Correction]) -> str:
    """The changed components as they should stand in the launch file, to paste."""
    shown = []
    for component in dict.fromkeys(change.component for change in changes):
        params = {**table["component"][component].get("params", {}), **_of(component, changes)}
        shown.append(f"[component.{component}]\nparams = {literal(params)}")
    return "\n\n".join(shown)


def write(file: Path, changes: Sequence[Correction]) -> None:
    """Put the changes into the launch file, all or nothing; its comments stay.

    Raises:
        ConfigurationError: the file is not laid out so that this can be done safely, or can not be written.
    """
    if not file.is_file():
        raise ConfigurationError(f"{file}: must be a file of your own for --write; Berth's are not changed")
    text = file.read_text(encoding="utf-8")
    wanted = tomllib.loads(text)
    for component, param, value in changes:
        wanted["component"][component].setdefault("params", {})[param] = value
    for component in dict.fromkeys(change.component for change in changes):
        text = _edited(text, component, _of(component, changes), wanted["component"][component]["params"])
    try:
        kept = tomllib.loads(text) == wanted
    except tomllib.TOMLDecodeError:
        kept = False
    if not kept:
        raise ConfigurationError(f"{file}: is laid out in a way that --write does not know; paste the lines yourself")
    _replace(file, text)


def _of(component: str, changes: Iterable[Correction]) -> Table:
    return {change.param: change.value for change in changes if change.component == component}


def _edited(text: str, component: str, new: Mapping[str, Any], params: Mapping[str, Any]) -> str:
    rows = text.splitlines(keepends=True)
    table = _section(rows, f"component.{component}.params")
    if table is not None:
        begin, end = table
        for key, value in new.items():
            _set(rows, begin, end, key, literal(value))
        return "".join(rows)
    section = _section(rows, f"component.{component}")
    if section is not None:
        _set(rows, *section, "params", literal(params))
    return "".join(rows)


def _section(rows: Sequence[str], name: str) -> tuple[int, int] | None:
    """Rows of a table, without its header and the blank rows after it."""
    header = re.compile(rf"\s*\[\s*{re.escape(name)}\s*\]\s*(#.*)?$")
    begin = next((i + 1 for i, row in enumerate(rows) if header.match(row)), None)
    if begin is None:
        return None
    end = next((i for i in range(begin, len(rows)) if rows[i].lstrip().startswith("[")), len(rows))
    while end > begin and not rows[end - 1].strip():
        end -= 1
    return begin, end


def _set(rows: list[str], begin: int, end: int, key: str, value: str) -> None:
    """Replace the row of a key, or add one; what stands behind a value as a comment stays."""
    for i in range(begin, end):
        if re.match(rf"\s*{re.escape(key)}\s*=", rows[i]):
            comment = re.search(r"\s+#[^\"'{}]*$", rows[i].rstrip("\n"))
            rows[i] = f"{key} = {value}{comment.group(0) if comment else ''}\n"
            return
    if end and not rows[end - 1].endswith("\n"):
        rows[end - 1] += "\n"
    rows[end - 1] += f"{key} = {value}\n"


def literal(value: Any) -> str:
    """A value as TOML writes it on one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {literal(entry)}" for key, entry in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(literal, value)) + "]"
    if isinstance(value, bool):
        return "true" if value else "false"
    return json.dumps(value) if isinstance(value, str) else repr(value)


def _replace(file: Path, text: str) -> None:
    """The file is the old one or the new one, whatever happens."""
    try:
        handle, name = tempfile.mkstemp(dir=file.parent, prefix=f".{file.name}.")
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(text)
            stream.flush()
            os.fsync(stream.fileno())
        Path(name).chmod(file.stat().st_mode & 0o777)
        Path(name).replace(file)
    except OSError as error:
        raise ConfigurationError(f"{file}: can not be written: {error.strerror}") from None
