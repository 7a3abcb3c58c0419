from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from collections.abc import Iterable as _Iterable, Mapping as _Mapping
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Policy(_message.Message):
    __slots__ = ("version", "method", "beta_cells", "alpha_cells", "beta_range_rad", "alpha_range_rad", "action", "value", "table_sha256", "transitions", "action_v_mps", "action_omega_radps", "fine")
    class Fine(_message.Message):
        __slots__ = ("beta_range_rad", "alpha_range_rad", "d_min", "d_max", "beta_nodes", "alpha_nodes", "d_nodes", "action_zlib", "docking", "functions", "theta", "delay_samples", "noise", "back_samples")
        BETA_RANGE_RAD_FIELD_NUMBER: _ClassVar[int]
        ALPHA_RANGE_RAD_FIELD_NUMBER: _ClassVar[int]
        D_MIN_FIELD_NUMBER: _ClassVar[int]
        D_MAX_FIELD_NUMBER: _ClassVar[int]
        BETA_NODES_FIELD_NUMBER: _ClassVar[int]
        ALPHA_NODES_FIELD_NUMBER: _ClassVar[int]
        D_NODES_FIELD_NUMBER: _ClassVar[int]
        ACTION_ZLIB_FIELD_NUMBER: _ClassVar[int]
        DOCKING_FIELD_NUMBER: _ClassVar[int]
        FUNCTIONS_FIELD_NUMBER: _ClassVar[int]
        THETA_FIELD_NUMBER: _ClassVar[int]
        DELAY_SAMPLES_FIELD_NUMBER: _ClassVar[int]
        NOISE_FIELD_NUMBER: _ClassVar[int]
        BACK_SAMPLES_FIELD_NUMBER: _ClassVar[int]
        beta_range_rad: float
        alpha_range_rad: float
        d_min: float
        d_max: float
        beta_nodes: int
        alpha_nodes: int
        d_nodes: int
        action_zlib: bytes
        docking: bool
        functions: str
        theta: _containers.RepeatedScalarFieldContainer[float]
        delay_samples: float
        noise: _containers.RepeatedScalarFieldContainer[float]
        back_samples: int
        def __init__(self, beta_range_rad: _Optional[float] = ..., alpha_range_rad: _Optional[float] = ..., d_min: _Optional[float] = ..., d_max: _Optional[float] = ..., beta_nodes: _Optional[int] = ..., alpha_nodes: _Optional[int] = ..., d_nodes: _Optional[int] = ..., action_zlib: _Optional[bytes] = ..., docking: _Optional[bool] = ..., functions: _Optional[str] = ..., theta: _Optional[_Iterable[float]] = ..., delay_samples: _Optional[float] = ..., noise: _Optional[_Iterable[float]] = ..., back_samples: _Optional[int] = ...) -> None: ...
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
    FINE_FIELD_NUMBER: _ClassVar[int]
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
    fine: Policy.Fine
    def __init__(self, version: _Optional[int] = ..., method: _Optional[str] = ..., beta_cells: _Optional[int] = ..., alpha_cells: _Optional[int] = ..., beta_range_rad: _Optional[float] = ..., alpha_range_rad: _Optional[float] = ..., action: _Optional[bytes] = ..., value: _Optional[_Iterable[float]] = ..., table_sha256: _Optional[bytes] = ..., transitions: _Optional[int] = ..., action_v_mps: _Optional[_Iterable[float]] = ..., action_omega_radps: _Optional[_Iterable[float]] = ..., fine: _Optional[_Union[Policy.Fine, _Mapping]] = ...) -> None: ...
