"""Message classes by their full name, and the descriptors that let a log explain itself."""

from __future__ import annotations

import importlib
import pkgutil
from functools import cache
from typing import Any, cast

from google.protobuf import descriptor_pool, message_factory
from google.protobuf.descriptor import FileDescriptor
from google.protobuf.descriptor_pb2 import FileDescriptorSet

import schemas


@cache
def _import_all() -> None:
    for module in pkgutil.iter_modules(schemas.__path__):
        if module.name.endswith("_pb2"):
            importlib.import_module(f"schemas.{module.name}")


@cache
def message_class(full_name: str) -> type[Any] | None:
    """Generated class of e.g. `berth.Percept`, or None if this release does not know it."""
    _import_all()
    try:
        descriptor = descriptor_pool.Default().FindMessageTypeByName(full_name)
    except KeyError:
        return None
    return cast("type[Any]", message_factory.GetMessageClass(descriptor))


@cache
def descriptor_set(full_name: str) -> bytes:
    """Serialised FileDescriptorSet of a message's file and all that it imports: an MCAP schema."""
    kind = message_class(full_name)
    if kind is None:
        return b""
    files: dict[str, FileDescriptor] = {}
    _collect(kind.DESCRIPTOR.file, files)
    found = FileDescriptorSet()
    for file in files.values():
        file.CopyToProto(found.file.add())
    return found.SerializeToString(deterministic=True)


def _collect(file: FileDescriptor, files: dict[str, FileDescriptor]) -> None:
    for dependency in file.dependencies:
        _collect(dependency, files)
    files.setdefault(file.name, file)
