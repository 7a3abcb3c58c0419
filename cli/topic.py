"""`berth topic list / echo / hz / info`: look at the bus of a running system."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator
from typing import Annotated, Any

import typer
from google.protobuf import json_format

from cli.observer import Observer, Seen, observe
from runtime.messages import message_class
from runtime.params import ConfigurationError
from runtime.runfile import Run, find

KEY = Annotated[str, typer.Argument(help="Key below the realm, e.g. tracker/percept; wildcards as in zenoh.")]
REALM = Annotated[str, typer.Option(help="Which system, if more than one runs.")]
JSON = Annotated[bool, typer.Option("--json", help="JSON on standard output.")]
COUNT = Annotated[int, typer.Option("-n", "--count", help="Messages to show; 0 = until Ctrl-C.", min=0)]
WINDOW = Annotated[float, typer.Option("-w", "--window", help="Seconds to count.", min=0.1)]
_BYTES_SHOWN = 32
_SLICE_S = 0.1

topic = typer.Typer(
    help="Look at the bus of a running system.", no_args_is_help=True, rich_markup_mode=None, add_completion=False
)


@topic.command("list")
def list_topics(realm: REALM = "", as_json: JSON = False) -> None:
    """Show every key and its schema. Example: berth topic list."""
    run = find(realm)
    _print(dict(run.topics), [f"{key:24} {schema}" for key, schema in run.topics.items()], as_json=as_json)


@topic.command()
def echo(key: KEY, realm: REALM = "", count: COUNT = 0, as_json: JSON = False) -> None:
    """Show messages as they come. Example: berth topic echo tracker/percept -n 3."""
    run = _run(realm, key)
    with observe(run, key) as observer:
        for shown, seen in enumerate(_stream(observer), 1):
            _print(_table(seen), [_line(seen)], as_json=as_json)
            if shown == count:
                return


@topic.command()
def hz(key: KEY = "**", realm: REALM = "", window: WINDOW = 2.0, as_json: JSON = False) -> None:
    """Count messages and bytes a second of wall time. Example: berth topic hz vision/view."""
    run = _run(realm, key)
    counts: dict[str, list[int]] = {}
    with observe(run, key) as observer:
        deadline_s = time.monotonic() + window
        while (left_s := deadline_s - time.monotonic()) > 0:
            for seen in observer.take(min(left_s, _SLICE_S)):
                row = counts.setdefault(seen.key, [0, 0])
                row[0] += 1
                row[1] += len(seen.payload)
    rates = {name: {"hz": n / window, "bytes_per_s": size / window} for name, (n, size) in sorted(counts.items())}
    lines = [f"{name:24} {rate['hz']:9.1f} Hz {rate['bytes_per_s']:12.0f} B/s" for name, rate in rates.items()]
    _print(rates, lines or [f"nothing on {key} in {window:g} s"], as_json=as_json)


@topic.command()
def info(key: KEY, realm: REALM = "", as_json: JSON = False) -> None:
    """Show a key's schema and its fields. Example: berth topic info tracker/percept."""
    run = _run(realm, key)
    schema = run.topics.get(key, "")
    kind = message_class(schema)
    if kind is None:
        raise ConfigurationError(f"key must be one of {', '.join(run.topics)}; got {key!r}")
    fields = {field.name: _type(field) for field in kind.DESCRIPTOR.fields}
    table = {"key": f"{run.realm}/{key}", "schema": schema, "fields": fields}
    lines = [f"{run.realm}/{key}  {schema}", *(f"  {name:24} {kind}" for name, kind in fields.items())]
    _print(table, lines, as_json=as_json)


def _run(realm: str, key: str) -> Run:
    run = find(realm)
    if "*" not in key and key not in run.topics:
        raise ConfigurationError(f"key must be one of {', '.join(run.topics)}; got {key!r}")
    return run


def _stream(observer: Observer) -> Iterator[Seen]:
    try:
        while True:
            yield from observer.take(_SLICE_S)
    except KeyboardInterrupt:
        return


def _table(seen: Seen) -> dict[str, Any]:
    kind = message_class(seen.schema)
    table: dict[str, Any] = {"key": seen.key, "schema": seen.schema, "bytes": len(seen.payload)}
    if seen.stamp is not None:
        table |= {"run": f"{seen.stamp.run:016x}", "sequence": seen.stamp.sequence}
        table |= {"capture_s": seen.stamp.capture_ns / 1e9}
    if kind is not None:
        table["message"] = _fields(kind.FromString(seen.payload))
    return table


def _fields(message: Any) -> dict[str, Any]:
    """Fields with their default values too, long bytes cut."""
    table = json_format.MessageToDict(
        message, always_print_fields_with_no_presence=True, preserving_proto_field_name=True
    )
    for field, value in message.ListFields():
        if isinstance(value, bytes) and len(value) > _BYTES_SHOWN:
            table[field.name] = f"{value[:8].hex()}... ({len(value)} bytes)"
    return table


def _line(seen: Seen) -> str:
    table = _table(seen)
    fields = "  ".join(f"{name}={value}" for name, value in table.get("message", {}).items())
    stamp = f"{table['capture_s']:.3f} s #{table['sequence']}" if "run" in table else "no attachment"
    return f"{seen.key}  {stamp}  {fields or table['schema'] or 'no protobuf'}"


def _type(field: Any) -> str:
    name = field.message_type.full_name if field.message_type else (field.enum_type or field.cpp_type)
    kinds = {1: "int32", 2: "int64", 3: "uint32", 4: "uint64", 5: "double", 6: "float", 7: "bool", 9: "string"}
    text = kinds.get(name, getattr(name, "full_name", str(name)))
    return f"repeated {text}" if field.is_repeated else str(text)


def _print(table: Any, lines: list[str], *, as_json: bool) -> None:
    sys.stdout.write((json.dumps(table) if as_json else "\n".join(lines)) + "\n")
    sys.stdout.flush()
