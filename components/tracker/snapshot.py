"""A tree of dataclasses as bytes, and back from untrusted bytes."""

from __future__ import annotations

import dataclasses
import json
import typing
from typing import Any, TypeVar, cast

T = TypeVar("T")


def saved(state: Any) -> bytes:
    """A dataclass of numbers, booleans, dataclasses and lists of dataclasses as JSON; floats survive bit for bit."""
    return json.dumps(dataclasses.asdict(state)).encode()


def loaded(kind: type[T], data: bytes) -> T:
    """The dataclass that `saved` made the bytes of.

    Raises:
        ValueError: the bytes are something else.
    """
    try:
        return cast("T", _value(kind, json.loads(data), kind.__name__))
    except (UnicodeDecodeError, json.JSONDecodeError, RecursionError) as error:
        raise ValueError(f"no saved {kind.__name__}: {error}") from error


def _value(hint: Any, value: Any, where: str) -> Any:
    if dataclasses.is_dataclass(hint):
        return _record(cast("type[Any]", hint), value, where)
    if typing.get_origin(hint) is list:
        if not isinstance(value, list):
            raise ValueError(f"{where} must be a list; got {value!r}")
        return [_value(typing.get_args(hint)[0], entry, where) for entry in value]
    if type(value) is not hint:
        raise ValueError(f"{where} must be {hint.__name__}; got {value!r}")
    return value


def _record(kind: type[Any], table: Any, where: str) -> Any:
    hints = typing.get_type_hints(kind)
    if not isinstance(table, dict) or table.keys() != hints.keys():
        raise ValueError(f"{where} must have {', '.join(hints)}; got {table!r}")
    return kind(**{name: _value(hint, table[name], f"{where}.{name}") for name, hint in hints.items()})
