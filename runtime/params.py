"""Parameters: frozen dataclasses whose fields carry their rule, built from untrusted tables. Standard library only.

@dataclass(frozen=True)
class Params:
    pan_gain_p: float = positive(2.0)
    \"\"\"Proportional gain, 1/s. Tuned in simulation.\"\"\"
"""

from __future__ import annotations

import dataclasses
import math
import typing
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from typing import Any, TypeVar, cast

_SHOWN = 80
"""Characters of a refused value that an error shows."""
T = TypeVar("T")
Number = TypeVar("Number", int, float)


class ConfigurationError(Exception):
    """One line that names file, key, value and rule."""


@dataclass(frozen=True, slots=True)
class Rule:
    """A condition on a value, with the words that finish the sentence `KEY must be ...`."""

    words: str
    holds: Callable[[Any], bool]


def ruled(default: T, words: str, holds: Callable[[Any], bool]) -> T:
    """Dataclass field with a default and a rule."""
    return field(default=default, metadata={"rule": Rule(words, holds)})


def positive(default: Number) -> Number:
    """Field that must be > 0."""
    return ruled(default, "> 0", lambda value: value > 0)


def not_negative(default: Number) -> Number:
    """Field that must be >= 0."""
    return ruled(default, ">= 0", lambda value: value >= 0)


def between(default: Number, low: float, high: float) -> Number:
    """Field that must lie in [low, high]."""
    return ruled(default, f"between {low:g} and {high:g}", lambda value: low <= value <= high)


def scale(default: float = 1.0) -> float:
    """Field of a factor between a robot's units and its device's; negative = the other way round."""
    return ruled(default, "not 0 and between -1000 and 1000", lambda value: value != 0.0 and abs(value) <= 1000.0)


def odd(default: int) -> int:
    """Field that must be an odd number of cells: one is in the middle, and a table of them still fits into memory."""
    return ruled(default, "odd and at least 3, at most 501", lambda value: 3 <= value <= 501 and value % 2 == 1)


def one_of(default: str, *choices: str) -> str:
    """Field that must be one of a few words."""
    return ruled(default, "one of " + ", ".join(choices), lambda value: value in choices)


def build(kind: type[T], table: Mapping[str, Any], where: str) -> T:
    """Make a parameter dataclass from a table.

    Args:
        kind: frozen dataclass; a field that is itself a dataclass takes a table or an instance.
        table: untrusted values.
        where: prefix of error messages, e.g. `launch/sim.toml: tracker.params`.

    Raises:
        ConfigurationError: unknown or missing key, wrong type, broken rule.
    """
    hints = typing.get_type_hints(kind)
    known = {f.name: f for f in fields(cast("Any", kind))}
    for key in table:
        if key not in known:
            raise ConfigurationError(f"{where}.{key} is unknown; known are {', '.join(known)}")
    values = {}
    for name, spec in known.items():
        if name in table:
            values[name] = _checked(table[name], hints[name], spec.metadata.get("rule"), f"{where}.{name}")
        elif spec.default is dataclasses.MISSING and spec.default_factory is dataclasses.MISSING:
            raise ConfigurationError(f"{where}.{name} is missing; it must be a {_name(hints[name])}")
    return kind(**values)


def _checked(value: object, hint: Any, rule: Rule | None, where: str) -> object:
    if dataclasses.is_dataclass(hint):
        if isinstance(value, cast("type", hint)):
            return value
        if not isinstance(value, Mapping):
            raise ConfigurationError(f"{where} must be a table; got {value!r}")
        return build(cast("type[Any]", hint), value, where)
    value = _typed(value, hint, where)
    if rule is not None and not rule.holds(value):
        raise ConfigurationError(f"{where} must be {rule.words}; got {_shown(value)}")
    return value


def _typed(value: object, hint: Any, where: str) -> object:
    if typing.get_origin(hint) is tuple:
        item = typing.get_args(hint)[0]
        if not isinstance(value, list | tuple):
            raise ConfigurationError(f"{where} must be a list of {_name(item)}; got {value!r}")
        return tuple(_typed(entry, item, f"{where}[{i}]") for i, entry in enumerate(value))
    if hint is float and isinstance(value, int) and not isinstance(value, bool):
        value = float(value)
    if not isinstance(value, hint) or (isinstance(value, bool) and hint is not bool):
        raise ConfigurationError(f"{where} must be a {_name(hint)}; got {value!r}")
    if isinstance(value, float) and not math.isfinite(value):
        raise ConfigurationError(f"{where} must be finite; got {value!r}")
    return value


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= _SHOWN else text[: _SHOWN - 3] + "..."


def _name(hint: Any) -> str:
    words = {float: "number", int: "whole number", str: "text", bool: "true or false"}
    return words.get(hint, getattr(hint, "__name__", str(hint)))
