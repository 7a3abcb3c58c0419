"""Tables of parameters: name, default, unit, rule and the words that stand below each field."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import itertools
import math
import typing
from collections.abc import Iterator
from typing import Any

from docs.reference.tables import code, table
from runtime.params import Rule

UNITS = {
    "radps": "rad/s",
    "mps2": "m/s²",
    "radps2": "rad/s²",
    "mps": "m/s",
    "rad": "rad",
    "px": "px",
    "pixels": "px",
    "m": "m",
    "s": "s",
    "hz": "Hz",
    "k": "K",
    "bytes": "bytes",
    "percent": "%",
    "frames": "frames",
    "samples": "samples",
    "baud": "baud",
}
"""Last word of a name -> the unit of the number that it names."""


def unit(name: str) -> str:
    """Unit that a field's name tells; empty if it tells none. `k_beta_per_s` is a rate: 1/s."""
    words = name.split("_")
    found = UNITS.get(words[-1], "")
    return f"1/{found}" if found and words[-2:-1] == ["per"] else found


def parameters(kind: type[Any]) -> str:
    """The table of a parameter dataclass, without what the shell fills in (`task`, `clock`)."""
    words = dict(_docstrings(kind))
    rows = [
        (code(field.name), _default(field), unit(field.name), _rule(field), words.get(field.name, ""))
        for field in dataclasses.fields(kind)
        if field.name not in {"task", "clock"}
    ]
    return table(("parameter", "default", "unit", "must be", "what it is"), rows)


def _docstrings(kind: type[Any]) -> Iterator[tuple[str, str]]:
    """(field, the docstring that follows it), of a class and of those it inherits from."""
    for owner in reversed(kind.__mro__):
        if not dataclasses.is_dataclass(owner):
            continue
        (tree,) = ast.parse(inspect.getsource(owner)).body
        body = typing.cast("ast.ClassDef", tree).body
        for field, text in itertools.pairwise(body):
            if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name) and _is_text(text):
                yield field.target.id, str(ast.literal_eval(typing.cast("ast.Expr", text).value))


def _is_text(node: ast.stmt) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def _default(field: dataclasses.Field[Any]) -> str:
    if field.default is dataclasses.MISSING:
        return "" if field.default_factory is dataclasses.MISSING else "see below"
    value = field.default
    if value in ("", b"", ()):
        return "empty"
    if isinstance(value, bool):
        return code(str(value).lower())
    if isinstance(value, float):
        return code(f"{value:.6g}") + _in_degrees(field.name, value)
    if isinstance(value, tuple):
        return code("[" + ", ".join(f"{item}" for item in value) + "]")
    return code(str(value))


def _in_degrees(name: str, value: float) -> str:
    return f" ({math.degrees(value):.4g}°)" if "rad" in unit(name) and value else ""


def _rule(field: dataclasses.Field[Any]) -> str:
    rule = field.metadata.get("rule")
    return rule.words if isinstance(rule, Rule) else ""
