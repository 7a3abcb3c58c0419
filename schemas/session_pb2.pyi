from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable
from typing import ClassVar as _ClassVar, Optional as _Optional

DESCRIPTOR: _descriptor.FileDescriptor

class Journal(_message.Message):
    __slots__ = ("first", "ports", "port", "source_run", "source_sequence", "time_delta_ns")
    FIRST_FIELD_NUMBER: _ClassVar[int]
    PORTS_FIELD_NUMBER: _ClassVar[int]
    PORT_FIELD_NUMBER: _ClassVar[int]
    SOURCE_RUN_FIELD_NUMBER: _ClassVar[int]
    SOURCE_SEQUENCE_FIELD_NUMBER: _ClassVar[int]
    TIME_DELTA_NS_FIELD_NUMBER: _ClassVar[int]
    first: int
    ports: _containers.RepeatedScalarFieldContainer[str]
    port: _containers.RepeatedScalarFieldContainer[int]
    source_run: _containers.RepeatedScalarFieldContainer[int]
    source_sequence: _containers.RepeatedScalarFieldContainer[int]
    time_delta_ns: _containers.RepeatedScalarFieldContainer[int]
    def __init__(self, first: _Optional[int] = ..., ports: _Optional[_Iterable[str]] = ..., port: _Optional[_Iterable[int]] = ..., source_run: _Optional[_Iterable[int]] = ..., source_sequence: _Optional[_Iterable[int]] = ..., time_delta_ns: _Optional[_Iterable[int]] = ...) -> None: ...

class Status(_message.Message):
    __slots__ = ("component", "handled", "published", "lost", "skipped", "malformed", "note")
    COMPONENT_FIELD_NUMBER: _ClassVar[int]
    HANDLED_FIELD_NUMBER: _ClassVar[int]
    PUBLISHED_FIELD_NUMBER: _ClassVar[int]
    LOST_FIELD_NUMBER: _ClassVar[int]
    SKIPPED_FIELD_NUMBER: _ClassVar[int]
    MALFORMED_FIELD_NUMBER: _ClassVar[int]
    NOTE_FIELD_NUMBER: _ClassVar[int]
    component: str
    handled: int
    published: int
    lost: int
    skipped: int
    malformed: int
    note: str
    def __init__(self, component: _Optional[str] = ..., handled: _Optional[int] = ..., published: _Optional[int] = ..., lost: _Optional[int] = ..., skipped: _Optional[int] = ..., malformed: _Optional[int] = ..., note: _Optional[str] = ...) -> None: ...

class RecorderAck(_message.Message):
    __slots__ = ("messages", "lost")
    MESSAGES_FIELD_NUMBER: _ClassVar[int]
    LOST_FIELD_NUMBER: _ClassVar[int]
    messages: int
    lost: int
    def __init__(self, messages: _Optional[int] = ..., lost: _Optional[int] = ...) -> None: ...

class LearnerPace(_message.Message):
    __slots__ = ("version",)
    VERSION_FIELD_NUMBER: _ClassVar[int]
    version: int
    def __init__(self, version: _Optional[int] = ...) -> None: ...

class SessionEnd(_message.Message):
    __slots__ = ("reason",)
    REASON_FIELD_NUMBER: _ClassVar[int]
    reason: str
    def __init__(self, reason: _Optional[str] = ...) -> None: ...

class Snapshot(_message.Message):
    __slots__ = ("version", "table_sha256", "state")
    VERSION_FIELD_NUMBER: _ClassVar[int]
    TABLE_SHA256_FIELD_NUMBER: _ClassVar[int]
    STATE_FIELD_NUMBER: _ClassVar[int]
    version: int
    table_sha256: bytes
    state: bytes
    def __init__(self, version: _Optional[int] = ..., table_sha256: _Optional[bytes] = ..., state: _Optional[bytes] = ...) -> None: ...

class Gap(_message.Message):
    __slots__ = ("key", "run", "first_missing", "count")
    KEY_FIELD_NUMBER: _ClassVar[int]
    RUN_FIELD_NUMBER: _ClassVar[int]
    FIRST_MISSING_FIELD_NUMBER: _ClassVar[int]
    COUNT_FIELD_NUMBER: _ClassVar[int]
    key: str
    run: int
    first_missing: int
    count: int
    def __init__(self, key: _Optional[str] = ..., run: _Optional[int] = ..., first_missing: _Optional[int] = ..., count: _Optional[int] = ...) -> None: ...

class Hold(_message.Message):
    __slots__ = ("active", "component")
    ACTIVE_FIELD_NUMBER: _ClassVar[int]
    COMPONENT_FIELD_NUMBER: _ClassVar[int]
    active: bool
    component: str
    def __init__(self, active: _Optional[bool] = ..., component: _Optional[str] = ...) -> None: ...

class Playback(_message.Message):
    __slots__ = ("epoch", "time_ns", "rate", "paused")
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    TIME_NS_FIELD_NUMBER: _ClassVar[int]
    RATE_FIELD_NUMBER: _ClassVar[int]
    PAUSED_FIELD_NUMBER: _ClassVar[int]
    epoch: int
    time_ns: int
    rate: float
    paused: bool
    def __init__(self, epoch: _Optional[int] = ..., time_ns: _Optional[int] = ..., rate: _Optional[float] = ..., paused: _Optional[bool] = ...) -> None: ...
