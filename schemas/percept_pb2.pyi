from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Optional as _Optional

DESCRIPTOR: _descriptor.FileDescriptor

class Percept(_message.Message):
    __slots__ = ("visible", "slope", "pan_rad", "tilt_rad", "capture_time_ns", "pan_error_px", "tilt_error_px", "focal_px")
    VISIBLE_FIELD_NUMBER: _ClassVar[int]
    SLOPE_FIELD_NUMBER: _ClassVar[int]
    PAN_RAD_FIELD_NUMBER: _ClassVar[int]
    TILT_RAD_FIELD_NUMBER: _ClassVar[int]
    CAPTURE_TIME_NS_FIELD_NUMBER: _ClassVar[int]
    PAN_ERROR_PX_FIELD_NUMBER: _ClassVar[int]
    TILT_ERROR_PX_FIELD_NUMBER: _ClassVar[int]
    FOCAL_PX_FIELD_NUMBER: _ClassVar[int]
    visible: bool
    slope: float
    pan_rad: float
    tilt_rad: float
    capture_time_ns: int
    pan_error_px: float
    tilt_error_px: float
    focal_px: float
    def __init__(self, visible: _Optional[bool] = ..., slope: _Optional[float] = ..., pan_rad: _Optional[float] = ..., tilt_rad: _Optional[float] = ..., capture_time_ns: _Optional[int] = ..., pan_error_px: _Optional[float] = ..., tilt_error_px: _Optional[float] = ..., focal_px: _Optional[float] = ...) -> None: ...
