from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class GripperAction(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    GRIPPER_KEEP: _ClassVar[GripperAction]
    GRIPPER_LOWER: _ClassVar[GripperAction]
    GRIPPER_CLOSE: _ClassVar[GripperAction]
    GRIPPER_LIFT: _ClassVar[GripperAction]
    GRIPPER_RELEASE: _ClassVar[GripperAction]
GRIPPER_KEEP: GripperAction
GRIPPER_LOWER: GripperAction
GRIPPER_CLOSE: GripperAction
GRIPPER_LIFT: GripperAction
GRIPPER_RELEASE: GripperAction

class Drive(_message.Message):
    __slots__ = ("engaged", "v_mps", "omega_radps", "gripper", "dead_man")
    ENGAGED_FIELD_NUMBER: _ClassVar[int]
    V_MPS_FIELD_NUMBER: _ClassVar[int]
    OMEGA_RADPS_FIELD_NUMBER: _ClassVar[int]
    GRIPPER_FIELD_NUMBER: _ClassVar[int]
    DEAD_MAN_FIELD_NUMBER: _ClassVar[int]
    engaged: bool
    v_mps: float
    omega_radps: float
    gripper: GripperAction
    dead_man: bool
    def __init__(self, engaged: _Optional[bool] = ..., v_mps: _Optional[float] = ..., omega_radps: _Optional[float] = ..., gripper: _Optional[_Union[GripperAction, str]] = ..., dead_man: _Optional[bool] = ...) -> None: ...

class Applied(_message.Message):
    __slots__ = ("v_mps", "omega_radps", "commander", "gripper")
    V_MPS_FIELD_NUMBER: _ClassVar[int]
    OMEGA_RADPS_FIELD_NUMBER: _ClassVar[int]
    COMMANDER_FIELD_NUMBER: _ClassVar[int]
    GRIPPER_FIELD_NUMBER: _ClassVar[int]
    v_mps: float
    omega_radps: float
    commander: str
    gripper: GripperAction
    def __init__(self, v_mps: _Optional[float] = ..., omega_radps: _Optional[float] = ..., commander: _Optional[str] = ..., gripper: _Optional[_Union[GripperAction, str]] = ...) -> None: ...

class BaseCommand(_message.Message):
    __slots__ = ("v_mps", "omega_radps", "gripper", "lift_reversed", "fingers_reversed")
    V_MPS_FIELD_NUMBER: _ClassVar[int]
    OMEGA_RADPS_FIELD_NUMBER: _ClassVar[int]
    GRIPPER_FIELD_NUMBER: _ClassVar[int]
    LIFT_REVERSED_FIELD_NUMBER: _ClassVar[int]
    FINGERS_REVERSED_FIELD_NUMBER: _ClassVar[int]
    v_mps: float
    omega_radps: float
    gripper: GripperAction
    lift_reversed: bool
    fingers_reversed: bool
    def __init__(self, v_mps: _Optional[float] = ..., omega_radps: _Optional[float] = ..., gripper: _Optional[_Union[GripperAction, str]] = ..., lift_reversed: _Optional[bool] = ..., fingers_reversed: _Optional[bool] = ...) -> None: ...

class BaseState(_message.Message):
    __slots__ = ("odometry_x_m", "odometry_y_m", "odometry_heading_rad", "v_mps", "omega_radps", "bumper", "inner_beam", "outer_beam", "lift_up", "lift_down", "fingers_closed", "guard", "rear_range_m", "rear_bumper", "battery_v", "fault", "watchdog_s")
    ODOMETRY_X_M_FIELD_NUMBER: _ClassVar[int]
    ODOMETRY_Y_M_FIELD_NUMBER: _ClassVar[int]
    ODOMETRY_HEADING_RAD_FIELD_NUMBER: _ClassVar[int]
    V_MPS_FIELD_NUMBER: _ClassVar[int]
    OMEGA_RADPS_FIELD_NUMBER: _ClassVar[int]
    BUMPER_FIELD_NUMBER: _ClassVar[int]
    INNER_BEAM_FIELD_NUMBER: _ClassVar[int]
    OUTER_BEAM_FIELD_NUMBER: _ClassVar[int]
    LIFT_UP_FIELD_NUMBER: _ClassVar[int]
    LIFT_DOWN_FIELD_NUMBER: _ClassVar[int]
    FINGERS_CLOSED_FIELD_NUMBER: _ClassVar[int]
    GUARD_FIELD_NUMBER: _ClassVar[int]
    REAR_RANGE_M_FIELD_NUMBER: _ClassVar[int]
    REAR_BUMPER_FIELD_NUMBER: _ClassVar[int]
    BATTERY_V_FIELD_NUMBER: _ClassVar[int]
    FAULT_FIELD_NUMBER: _ClassVar[int]
    WATCHDOG_S_FIELD_NUMBER: _ClassVar[int]
    odometry_x_m: float
    odometry_y_m: float
    odometry_heading_rad: float
    v_mps: float
    omega_radps: float
    bumper: bool
    inner_beam: bool
    outer_beam: bool
    lift_up: bool
    lift_down: bool
    fingers_closed: bool
    guard: bool
    rear_range_m: float
    rear_bumper: bool
    battery_v: float
    fault: str
    watchdog_s: float
    def __init__(self, odometry_x_m: _Optional[float] = ..., odometry_y_m: _Optional[float] = ..., odometry_heading_rad: _Optional[float] = ..., v_mps: _Optional[float] = ..., omega_radps: _Optional[float] = ..., bumper: _Optional[bool] = ..., inner_beam: _Optional[bool] = ..., outer_beam: _Optional[bool] = ..., lift_up: _Optional[bool] = ..., lift_down: _Optional[bool] = ..., fingers_closed: _Optional[bool] = ..., guard: _Optional[bool] = ..., rear_range_m: _Optional[float] = ..., rear_bumper: _Optional[bool] = ..., battery_v: _Optional[float] = ..., fault: _Optional[str] = ..., watchdog_s: _Optional[float] = ...) -> None: ...
