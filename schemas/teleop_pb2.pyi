from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Hands(_message.Message):
    __slots__ = ("dead_man", "forward", "left", "request")
    class Request(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        NOTHING: _ClassVar[Hands.Request]
        TAKE: _ClassVar[Hands.Request]
        GIVE: _ClassVar[Hands.Request]
        FASTER: _ClassVar[Hands.Request]
        SLOWER: _ClassVar[Hands.Request]
    NOTHING: Hands.Request
    TAKE: Hands.Request
    GIVE: Hands.Request
    FASTER: Hands.Request
    SLOWER: Hands.Request
    DEAD_MAN_FIELD_NUMBER: _ClassVar[int]
    FORWARD_FIELD_NUMBER: _ClassVar[int]
    LEFT_FIELD_NUMBER: _ClassVar[int]
    REQUEST_FIELD_NUMBER: _ClassVar[int]
    dead_man: bool
    forward: float
    left: float
    request: Hands.Request
    def __init__(self, dead_man: _Optional[bool] = ..., forward: _Optional[float] = ..., left: _Optional[float] = ..., request: _Optional[_Union[Hands.Request, str]] = ...) -> None: ...
