from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Optional as _Optional

DESCRIPTOR: _descriptor.FileDescriptor

class View(_message.Message):
    __slots__ = ("object_visible", "object_u_px", "object_v_px", "object_pixels", "edge_visible", "edge_slope", "edge_v_px", "edge_pixels", "fault")
    OBJECT_VISIBLE_FIELD_NUMBER: _ClassVar[int]
    OBJECT_U_PX_FIELD_NUMBER: _ClassVar[int]
    OBJECT_V_PX_FIELD_NUMBER: _ClassVar[int]
    OBJECT_PIXELS_FIELD_NUMBER: _ClassVar[int]
    EDGE_VISIBLE_FIELD_NUMBER: _ClassVar[int]
    EDGE_SLOPE_FIELD_NUMBER: _ClassVar[int]
    EDGE_V_PX_FIELD_NUMBER: _ClassVar[int]
    EDGE_PIXELS_FIELD_NUMBER: _ClassVar[int]
    FAULT_FIELD_NUMBER: _ClassVar[int]
    object_visible: bool
    object_u_px: float
    object_v_px: float
    object_pixels: int
    edge_visible: bool
    edge_slope: float
    edge_v_px: float
    edge_pixels: int
    fault: str
    def __init__(self, object_visible: _Optional[bool] = ..., object_u_px: _Optional[float] = ..., object_v_px: _Optional[float] = ..., object_pixels: _Optional[int] = ..., edge_visible: _Optional[bool] = ..., edge_slope: _Optional[float] = ..., edge_v_px: _Optional[float] = ..., edge_pixels: _Optional[int] = ..., fault: _Optional[str] = ...) -> None: ...
