from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Optional as _Optional

DESCRIPTOR: _descriptor.FileDescriptor

class Truth(_message.Message):
    __slots__ = ("x_m", "y_m", "heading_rad", "v_mps", "omega_radps", "beta_rad", "alpha_rad", "d_axle_m", "gripper_lateral_m", "gripper_longitudinal_m", "collided", "holding", "pan_rad", "tilt_rad", "object_u_px", "object_v_px", "start", "placed")
    X_M_FIELD_NUMBER: _ClassVar[int]
    Y_M_FIELD_NUMBER: _ClassVar[int]
    HEADING_RAD_FIELD_NUMBER: _ClassVar[int]
    V_MPS_FIELD_NUMBER: _ClassVar[int]
    OMEGA_RADPS_FIELD_NUMBER: _ClassVar[int]
    BETA_RAD_FIELD_NUMBER: _ClassVar[int]
    ALPHA_RAD_FIELD_NUMBER: _ClassVar[int]
    D_AXLE_M_FIELD_NUMBER: _ClassVar[int]
    GRIPPER_LATERAL_M_FIELD_NUMBER: _ClassVar[int]
    GRIPPER_LONGITUDINAL_M_FIELD_NUMBER: _ClassVar[int]
    COLLIDED_FIELD_NUMBER: _ClassVar[int]
    HOLDING_FIELD_NUMBER: _ClassVar[int]
    PAN_RAD_FIELD_NUMBER: _ClassVar[int]
    TILT_RAD_FIELD_NUMBER: _ClassVar[int]
    OBJECT_U_PX_FIELD_NUMBER: _ClassVar[int]
    OBJECT_V_PX_FIELD_NUMBER: _ClassVar[int]
    START_FIELD_NUMBER: _ClassVar[int]
    PLACED_FIELD_NUMBER: _ClassVar[int]
    x_m: float
    y_m: float
    heading_rad: float
    v_mps: float
    omega_radps: float
    beta_rad: float
    alpha_rad: float
    d_axle_m: float
    gripper_lateral_m: float
    gripper_longitudinal_m: float
    collided: bool
    holding: bool
    pan_rad: float
    tilt_rad: float
    object_u_px: float
    object_v_px: float
    start: int
    placed: bool
    def __init__(self, x_m: _Optional[float] = ..., y_m: _Optional[float] = ..., heading_rad: _Optional[float] = ..., v_mps: _Optional[float] = ..., omega_radps: _Optional[float] = ..., beta_rad: _Optional[float] = ..., alpha_rad: _Optional[float] = ..., d_axle_m: _Optional[float] = ..., gripper_lateral_m: _Optional[float] = ..., gripper_longitudinal_m: _Optional[float] = ..., collided: _Optional[bool] = ..., holding: _Optional[bool] = ..., pan_rad: _Optional[float] = ..., tilt_rad: _Optional[float] = ..., object_u_px: _Optional[float] = ..., object_v_px: _Optional[float] = ..., start: _Optional[int] = ..., placed: _Optional[bool] = ...) -> None: ...
