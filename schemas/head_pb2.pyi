from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Optional as _Optional

DESCRIPTOR: _descriptor.FileDescriptor

class HeadState(_message.Message):
    __slots__ = ("pan_rad", "tilt_rad")
    PAN_RAD_FIELD_NUMBER: _ClassVar[int]
    TILT_RAD_FIELD_NUMBER: _ClassVar[int]
    pan_rad: float
    tilt_rad: float
    def __init__(self, pan_rad: _Optional[float] = ..., tilt_rad: _Optional[float] = ...) -> None: ...

class HeadCommand(_message.Message):
    __slots__ = ("pan_rad", "tilt_rad", "pan_rate_radps", "tilt_rate_radps")
    PAN_RAD_FIELD_NUMBER: _ClassVar[int]
    TILT_RAD_FIELD_NUMBER: _ClassVar[int]
    PAN_RATE_RADPS_FIELD_NUMBER: _ClassVar[int]
    TILT_RATE_RADPS_FIELD_NUMBER: _ClassVar[int]
    pan_rad: float
    tilt_rad: float
    pan_rate_radps: float
    tilt_rate_radps: float
    def __init__(self, pan_rad: _Optional[float] = ..., tilt_rad: _Optional[float] = ..., pan_rate_radps: _Optional[float] = ..., tilt_rate_radps: _Optional[float] = ...) -> None: ...
