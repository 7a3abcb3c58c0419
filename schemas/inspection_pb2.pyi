from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Finding(_message.Message):
    __slots__ = ("thing", "verdict", "words", "measured", "unit", "component", "param", "change", "value")
    class Verdict(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        GOOD: _ClassVar[Finding.Verdict]
        WRONG: _ClassVar[Finding.Verdict]
        UNKNOWN: _ClassVar[Finding.Verdict]
    GOOD: Finding.Verdict
    WRONG: Finding.Verdict
    UNKNOWN: Finding.Verdict
    class Change(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        NOTHING: _ClassVar[Finding.Change]
        MULTIPLY: _ClassVar[Finding.Change]
        FLIP: _ClassVar[Finding.Change]
        SET: _ClassVar[Finding.Change]
    NOTHING: Finding.Change
    MULTIPLY: Finding.Change
    FLIP: Finding.Change
    SET: Finding.Change
    THING_FIELD_NUMBER: _ClassVar[int]
    VERDICT_FIELD_NUMBER: _ClassVar[int]
    WORDS_FIELD_NUMBER: _ClassVar[int]
    MEASURED_FIELD_NUMBER: _ClassVar[int]
    UNIT_FIELD_NUMBER: _ClassVar[int]
    COMPONENT_FIELD_NUMBER: _ClassVar[int]
    PARAM_FIELD_NUMBER: _ClassVar[int]
    CHANGE_FIELD_NUMBER: _ClassVar[int]
    VALUE_FIELD_NUMBER: _ClassVar[int]
    thing: str
    verdict: Finding.Verdict
    words: str
    measured: float
    unit: str
    component: str
    param: str
    change: Finding.Change
    value: float
    def __init__(self, thing: _Optional[str] = ..., verdict: _Optional[_Union[Finding.Verdict, str]] = ..., words: _Optional[str] = ..., measured: _Optional[float] = ..., unit: _Optional[str] = ..., component: _Optional[str] = ..., param: _Optional[str] = ..., change: _Optional[_Union[Finding.Change, str]] = ..., value: _Optional[float] = ...) -> None: ...
