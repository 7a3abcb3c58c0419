from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Trial(_message.Message):
    __slots__ = ("phase", "mode", "number", "outcome", "ended", "controller", "action", "policy_version", "place", "start", "goal_reached", "began_ns", "failure", "failure_ns", "dock_share", "dock_s", "back_off_m", "side")
    class Phase(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        TRAIN: _ClassVar[Trial.Phase]
        EVALUATE: _ClassVar[Trial.Phase]
        FINISHED: _ClassVar[Trial.Phase]
    TRAIN: Trial.Phase
    EVALUATE: Trial.Phase
    FINISHED: Trial.Phase
    class Mode(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        WAIT: _ClassVar[Trial.Mode]
        APPROACH: _ClassVar[Trial.Mode]
        SERVO: _ClassVar[Trial.Mode]
        GRASP: _ClassVar[Trial.Mode]
        REVERSE: _ClassVar[Trial.Mode]
        PLACE: _ClassVar[Trial.Mode]
    WAIT: Trial.Mode
    APPROACH: Trial.Mode
    SERVO: Trial.Mode
    GRASP: Trial.Mode
    REVERSE: Trial.Mode
    PLACE: Trial.Mode
    class Outcome(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        NONE: _ClassVar[Trial.Outcome]
        REACHED: _ClassVar[Trial.Outcome]
        SINK: _ClassVar[Trial.Outcome]
        COLLIDED: _ClassVar[Trial.Outcome]
        LOST: _ClassVar[Trial.Outcome]
        TIMED_OUT: _ClassVar[Trial.Outcome]
        ARRIVED: _ClassVar[Trial.Outcome]
        PICKED: _ClassVar[Trial.Outcome]
        MISSED: _ClassVar[Trial.Outcome]
    NONE: Trial.Outcome
    REACHED: Trial.Outcome
    SINK: Trial.Outcome
    COLLIDED: Trial.Outcome
    LOST: Trial.Outcome
    TIMED_OUT: Trial.Outcome
    ARRIVED: Trial.Outcome
    PICKED: Trial.Outcome
    MISSED: Trial.Outcome
    class Failure(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        NO_FAILURE: _ClassVar[Trial.Failure]
        UNREACHABLE: _ClassVar[Trial.Failure]
        OBJECT_LOST: _ClassVar[Trial.Failure]
        MODEL_WRONG: _ClassVar[Trial.Failure]
        LATE_COMMAND: _ClassVar[Trial.Failure]
        SLIP: _ClassVar[Trial.Failure]
        COLLISION: _ClassVar[Trial.Failure]
        TIMEOUT: _ClassVar[Trial.Failure]
        OFF_COURSE: _ClassVar[Trial.Failure]
        PICK_MISSED: _ClassVar[Trial.Failure]
    NO_FAILURE: Trial.Failure
    UNREACHABLE: Trial.Failure
    OBJECT_LOST: Trial.Failure
    MODEL_WRONG: Trial.Failure
    LATE_COMMAND: Trial.Failure
    SLIP: Trial.Failure
    COLLISION: Trial.Failure
    TIMEOUT: Trial.Failure
    OFF_COURSE: Trial.Failure
    PICK_MISSED: Trial.Failure
    PHASE_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    NUMBER_FIELD_NUMBER: _ClassVar[int]
    OUTCOME_FIELD_NUMBER: _ClassVar[int]
    ENDED_FIELD_NUMBER: _ClassVar[int]
    CONTROLLER_FIELD_NUMBER: _ClassVar[int]
    ACTION_FIELD_NUMBER: _ClassVar[int]
    POLICY_VERSION_FIELD_NUMBER: _ClassVar[int]
    PLACE_FIELD_NUMBER: _ClassVar[int]
    START_FIELD_NUMBER: _ClassVar[int]
    GOAL_REACHED_FIELD_NUMBER: _ClassVar[int]
    BEGAN_NS_FIELD_NUMBER: _ClassVar[int]
    FAILURE_FIELD_NUMBER: _ClassVar[int]
    FAILURE_NS_FIELD_NUMBER: _ClassVar[int]
    DOCK_SHARE_FIELD_NUMBER: _ClassVar[int]
    DOCK_S_FIELD_NUMBER: _ClassVar[int]
    BACK_OFF_M_FIELD_NUMBER: _ClassVar[int]
    SIDE_FIELD_NUMBER: _ClassVar[int]
    phase: Trial.Phase
    mode: Trial.Mode
    number: int
    outcome: Trial.Outcome
    ended: int
    controller: str
    action: int
    policy_version: int
    place: bool
    start: int
    goal_reached: bool
    began_ns: int
    failure: Trial.Failure
    failure_ns: int
    dock_share: float
    dock_s: float
    back_off_m: float
    side: str
    def __init__(self, phase: _Optional[_Union[Trial.Phase, str]] = ..., mode: _Optional[_Union[Trial.Mode, str]] = ..., number: _Optional[int] = ..., outcome: _Optional[_Union[Trial.Outcome, str]] = ..., ended: _Optional[int] = ..., controller: _Optional[str] = ..., action: _Optional[int] = ..., policy_version: _Optional[int] = ..., place: _Optional[bool] = ..., start: _Optional[int] = ..., goal_reached: _Optional[bool] = ..., began_ns: _Optional[int] = ..., failure: _Optional[_Union[Trial.Failure, str]] = ..., failure_ns: _Optional[int] = ..., dock_share: _Optional[float] = ..., dock_s: _Optional[float] = ..., back_off_m: _Optional[float] = ..., side: _Optional[str] = ...) -> None: ...
