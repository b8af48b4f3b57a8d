from foxglove_schemas_protobuf import Pose_pb2 as _Pose_pb2
from foxglove_schemas_protobuf import Vector3_pb2 as _Vector3_pb2
from google.protobuf import timestamp_pb2 as _timestamp_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class NavDirective(_message.Message):
    __slots__ = ("timestamp", "number", "action", "amount", "until", "clear_beyond")
    class Action(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        STOP: _ClassVar[NavDirective.Action]
        FOLLOW: _ClassVar[NavDirective.Action]
        SPIN: _ClassVar[NavDirective.Action]
        BACK_UP: _ClassVar[NavDirective.Action]
    STOP: NavDirective.Action
    FOLLOW: NavDirective.Action
    SPIN: NavDirective.Action
    BACK_UP: NavDirective.Action
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    NUMBER_FIELD_NUMBER: _ClassVar[int]
    ACTION_FIELD_NUMBER: _ClassVar[int]
    AMOUNT_FIELD_NUMBER: _ClassVar[int]
    UNTIL_FIELD_NUMBER: _ClassVar[int]
    CLEAR_BEYOND_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    number: int
    action: NavDirective.Action
    amount: float
    until: float
    clear_beyond: float
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., number: _Optional[int] = ..., action: _Optional[_Union[NavDirective.Action, str]] = ..., amount: _Optional[float] = ..., until: _Optional[float] = ..., clear_beyond: _Optional[float] = ...) -> None: ...

class NavReport(_message.Message):
    __slots__ = ("timestamp", "number", "drive", "done", "impossible")
    class Drive(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        DRIVING: _ClassVar[NavReport.Drive]
        NO_PATH: _ClassVar[NavReport.Drive]
        NO_VALID_CONTROL: _ClassVar[NavReport.Drive]
        STOPPED: _ClassVar[NavReport.Drive]
        ARRIVED: _ClassVar[NavReport.Drive]
    DRIVING: NavReport.Drive
    NO_PATH: NavReport.Drive
    NO_VALID_CONTROL: NavReport.Drive
    STOPPED: NavReport.Drive
    ARRIVED: NavReport.Drive
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    NUMBER_FIELD_NUMBER: _ClassVar[int]
    DRIVE_FIELD_NUMBER: _ClassVar[int]
    DONE_FIELD_NUMBER: _ClassVar[int]
    IMPOSSIBLE_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    number: int
    drive: NavReport.Drive
    done: bool
    impossible: bool
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., number: _Optional[int] = ..., drive: _Optional[_Union[NavReport.Drive, str]] = ..., done: bool = ..., impossible: bool = ...) -> None: ...

class PreviewRequest(_message.Message):
    __slots__ = ("position", "source", "start")
    POSITION_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    START_FIELD_NUMBER: _ClassVar[int]
    position: _Vector3_pb2.Vector3
    source: str
    start: _Vector3_pb2.Vector3
    def __init__(self, position: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., source: _Optional[str] = ..., start: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ...) -> None: ...

class PreviewReply(_message.Message):
    __slots__ = ("accepted", "reason", "poses", "length", "duration", "clearance")
    ACCEPTED_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    POSES_FIELD_NUMBER: _ClassVar[int]
    LENGTH_FIELD_NUMBER: _ClassVar[int]
    DURATION_FIELD_NUMBER: _ClassVar[int]
    CLEARANCE_FIELD_NUMBER: _ClassVar[int]
    accepted: bool
    reason: str
    poses: _containers.RepeatedCompositeFieldContainer[_Pose_pb2.Pose]
    length: float
    duration: float
    clearance: float
    def __init__(self, accepted: bool = ..., reason: _Optional[str] = ..., poses: _Optional[_Iterable[_Union[_Pose_pb2.Pose, _Mapping]]] = ..., length: _Optional[float] = ..., duration: _Optional[float] = ..., clearance: _Optional[float] = ...) -> None: ...

class MovingObstacle(_message.Message):
    __slots__ = ("position", "velocity", "radius")
    POSITION_FIELD_NUMBER: _ClassVar[int]
    VELOCITY_FIELD_NUMBER: _ClassVar[int]
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    position: _Vector3_pb2.Vector3
    velocity: _Vector3_pb2.Vector3
    radius: float
    def __init__(self, position: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., velocity: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., radius: _Optional[float] = ...) -> None: ...

class MovingObstacles(_message.Message):
    __slots__ = ("timestamp", "obstacles")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    OBSTACLES_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    obstacles: _containers.RepeatedCompositeFieldContainer[MovingObstacle]
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., obstacles: _Optional[_Iterable[_Union[MovingObstacle, _Mapping]]] = ...) -> None: ...
