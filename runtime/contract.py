"""What a component is: ports, events, outputs. Standard library only.

A component is a fold over events (`handle`). Time, randomness and configuration come in as arguments, so one
class runs live over the bus, in lockstep in one process, and over a recording.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any, ClassVar, NamedTuple, Protocol, runtime_checkable

TICK, GONE, STALL = "tick", "gone", "stall"
"""Names of the inputs that the shell itself feeds."""
STOP = "stop"
"""The last event of a run; every component gets it, none declares it."""
DEVICE, ACTUATE = "device", "actuate"
"""Ports of a component that has a device: what the device reads, and what it is told (see `DeviceKind`)."""


class Message(Protocol):
    """A protobuf message, as far as a shell needs to know it."""

    DESCRIPTOR: ClassVar[Any]

    def SerializeToString(self, *, deterministic: bool = ...) -> bytes: ...  # noqa: D102, N802
    @classmethod
    def FromString(cls, s: bytes) -> Message: ...  # noqa: D102, N802


class Kind(Enum):
    """What a port carries; `runtime.qos` gives each kind its priority and its behaviour under congestion."""

    COMMAND = "command"
    STATE = "state"
    IMAGE = "image"
    EVENT = "event"


@dataclass(frozen=True, slots=True)
class Port:
    """One named input or output of a component.

    Input and output ports of one schema can be wired together by a launch file.
    """

    schema: type[Any]
    """Generated protobuf class."""
    kind: Kind = Kind.STATE
    hz: float | None = None
    """Expected rate, for the reader and `berth topic hz`; None = on occasion."""
    queue: int = 64
    """Input: samples the inbox holds before it refuses more. 1 = only the latest (a replaced one is *skipped*)."""
    optional: bool = False
    """Input: may stay unwired."""
    per_frame: bool = False
    """On the control path. Output: answers every frame exactly once. Input: never skipped in lockstep."""
    on: tuple[str, ...] = ()
    """Output: the input ports whose messages can cause it at once. The others are only remembered, close no cycle."""
    delayed: bool = False
    """Output: published at a later time than the input that caused it (the world's next frame)."""
    reserved: bool = False
    """Output: for evaluation only (ground truth); no component may be wired to it."""


@dataclass(frozen=True, slots=True)
class Tick:
    """An input named `tick`: the shell's clock calls, at most once a period; late ticks coalesce."""

    hz: float


@dataclass(frozen=True, slots=True)
class Peers:
    """An input named `gone`: a component of the launch has died; the event's message is its name (text)."""


@dataclass(frozen=True, slots=True)
class Stall:
    """An input named `stall`: in lockstep on the bus nothing came for the session's `stall_s` of wall time."""


Input = Port | Tick | Peers | Stall


@dataclass(frozen=True, slots=True)
class DeviceKind:
    """One thing of the world that a component can be given: an entry of its ports' table `DEVICES`.

    An entry None is a kind that another component of the system plays: the input `device` is wired to it.

    The launch file chooses it with `device = { kind = "NAME", ... }`. The live shell opens it, reads it on a thread of
    its own, publishes each reading on the component's output `device` and hands it over on the input `device`, so that
    it is in the log and a replay needs no device. What `handle` says on the output `actuate` is written to it.
    """

    run: str
    """`module:Class` of a `Device`, made with the parameters; imported only where it is opened."""
    params: type[Any]
    """Frozen dataclass of the rest of the launch file's table."""
    terminal: bool = False
    """Reads the terminal that the session was started in, so its process must be in the foreground with it."""
    usage: str = ""
    """What a person must know to use it, shown while the session runs."""
    rest: str = ""
    """`module:function` of the parameters that brings it to rest without its driver, within a second. The supervisor
    calls it when the driver's process has died."""


class Late(NamedTuple):
    """A reading that was taken a moment before the device could give it."""

    message: Any
    age_s: float


class Device(Protocol):
    """What stands between a component and the world; lives in the component's process, in its folder `devices/`.

    `read` and `close` are called on the reader's thread, `write` on the thread that calls `handle`.
    """

    def read(self, timeout_s: float) -> Message | Late | None:
        """Wait for a reading, at most so long; None = nothing yet. Raises DeviceError when the device is gone."""
        ...

    def write(self, message: Any) -> None:
        """Carry a command out at once, without waiting. Raises DeviceError."""
        ...

    def close(self) -> None:
        """Leave the device as it was found, at rest; never raises."""
        ...


class Event(NamedTuple):
    """One call of `handle`."""

    time_ns: int
    """Session time at hand-over; never decreases, never before `capture_ns` unless another host's clock says that."""
    port: str
    """Input port, or `tick`, `gone`, `stall`, `stop`."""
    message: Any = None
    """Decoded message of the port's schema; the name (text) for gone; None for tick, stall and stop."""
    capture_ns: int = 0
    """When the light or the encoder was read that this message goes back to, session time."""
    source_run: int = 0
    """Run id of the publisher; a restart has a new one."""
    sequence: int = 0
    """Of the publisher on this port, from 0."""


class Output(NamedTuple):
    """A message to publish. The shell stamps the capture time of the event that caused it unless given."""

    port: str
    message: Any
    capture_ns: int | None = None


@runtime_checkable
class Component(Protocol):
    """What a shell runs. `save` and `load` exist where state must outlive the process (pilot, learner)."""

    Params: ClassVar[type[Any]]
    inputs: ClassVar[Mapping[str, Input]]
    outputs: ClassVar[Mapping[str, Port]]

    def handle(self, event: Event) -> tuple[Output, ...]: ...  # noqa: D102


class ComponentError(Exception):
    """A component can not go on; the shell ends its process with this one line."""


class DeviceError(ComponentError):
    """A device can not be opened, or is gone; the message names it and says what to do."""
