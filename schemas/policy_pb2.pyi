from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable
from typing import ClassVar as _ClassVar, Optional as _Optional

DESCRIPTOR: _descriptor.FileDescriptor

class Policy(_message.Message):
    __slots__ = ("version", "method", "beta_cells", "alpha_cells", "beta_range_rad", "alpha_range_rad", "action", "value", "table_sha256", "transitions", "action_v_mps", "action_omega_radps")
    VERSION_FIELD_NUMBER: _ClassVar[int]
    METHOD_FIELD_NUMBER: _ClassVar[int]
    BETA_CELLS_FIELD_NUMBER: _ClassVar[int]
    ALPHA_CELLS_FIELD_NUMBER: _ClassVar[int]
    BETA_RANGE_RAD_FIELD_NUMBER: _ClassVar[int]
    ALPHA_RANGE_RAD_FIELD_NUMBER: _ClassVar[int]
    ACTION_FIELD_NUMBER: _ClassVar[int]
    VALUE_FIELD_NUMBER: _ClassVar[int]
    TABLE_SHA256_FIELD_NUMBER: _ClassVar[int]
    TRANSITIONS_FIELD_NUMBER: _ClassVar[int]
    ACTION_V_MPS_FIELD_NUMBER: _ClassVar[int]
    ACTION_OMEGA_RADPS_FIELD_NUMBER: _ClassVar[int]
    version: int
    method: str
    beta_cells: int
    alpha_cells: int
    beta_range_rad: float
    alpha_range_rad: float
    action: bytes
    value: _containers.RepeatedScalarFieldContainer[float]
    table_sha256: bytes
    transitions: int
    action_v_mps: _containers.RepeatedScalarFieldContainer[float]
    action_omega_radps: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, version: _Optional[int] = ..., method: _Optional[str] = ..., beta_cells: _Optional[int] = ..., alpha_cells: _Optional[int] = ..., beta_range_rad: _Optional[float] = ..., alpha_range_rad: _Optional[float] = ..., action: _Optional[bytes] = ..., value: _Optional[_Iterable[float]] = ..., table_sha256: _Optional[bytes] = ..., transitions: _Optional[int] = ..., action_v_mps: _Optional[_Iterable[float]] = ..., action_omega_radps: _Optional[_Iterable[float]] = ...) -> None: ...
