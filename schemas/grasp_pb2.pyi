from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Grasp(_message.Message):
    __slots__ = ("stage", "picked")
    class Stage(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        IDLE: _ClassVar[Grasp.Stage]
        LOWERING: _ClassVar[Grasp.Stage]
        CLOSING: _ClassVar[Grasp.Stage]
        LIFTING: _ClassVar[Grasp.Stage]
        RELEASING: _ClassVar[Grasp.Stage]
        DONE: _ClassVar[Grasp.Stage]
    IDLE: Grasp.Stage
    LOWERING: Grasp.Stage
    CLOSING: Grasp.Stage
    LIFTING: Grasp.Stage
    RELEASING: Grasp.Stage
    DONE: Grasp.Stage
    STAGE_FIELD_NUMBER: _ClassVar[int]
    PICKED_FIELD_NUMBER: _ClassVar[int]
    stage: Grasp.Stage
    picked: bool
    def __init__(self, stage: _Optional[_Union[Grasp.Stage, str]] = ..., picked: _Optional[bool] = ...) -> None: ...
