from foxglove_schemas_protobuf import Vector3_pb2 as _Vector3_pb2
from google.protobuf import timestamp_pb2 as _timestamp_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class DriveCommand(_message.Message):
    __slots__ = ("timestamp", "linear", "angular", "lateral")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    LINEAR_FIELD_NUMBER: _ClassVar[int]
    ANGULAR_FIELD_NUMBER: _ClassVar[int]
    LATERAL_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    linear: float
    angular: float
    lateral: float
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., linear: _Optional[float] = ..., angular: _Optional[float] = ..., lateral: _Optional[float] = ...) -> None: ...

class WheelCommand(_message.Message):
    __slots__ = ("timestamp", "left", "right", "each", "steering")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    LEFT_FIELD_NUMBER: _ClassVar[int]
    RIGHT_FIELD_NUMBER: _ClassVar[int]
    EACH_FIELD_NUMBER: _ClassVar[int]
    STEERING_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    left: float
    right: float
    each: _containers.RepeatedScalarFieldContainer[float]
    steering: float
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., left: _Optional[float] = ..., right: _Optional[float] = ..., each: _Optional[_Iterable[float]] = ..., steering: _Optional[float] = ...) -> None: ...

class JointTarget(_message.Message):
    __slots__ = ("name", "position")
    NAME_FIELD_NUMBER: _ClassVar[int]
    POSITION_FIELD_NUMBER: _ClassVar[int]
    name: str
    position: float
    def __init__(self, name: _Optional[str] = ..., position: _Optional[float] = ...) -> None: ...

class MoveJointsRequest(_message.Message):
    __slots__ = ("joints", "source")
    JOINTS_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    joints: _containers.RepeatedCompositeFieldContainer[JointTarget]
    source: str
    def __init__(self, joints: _Optional[_Iterable[_Union[JointTarget, _Mapping]]] = ..., source: _Optional[str] = ...) -> None: ...

class SurfaceCommand(_message.Message):
    __slots__ = ("timestamp", "aileron", "elevator", "rudder", "throttle", "flap", "brake", "brake_difference")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    AILERON_FIELD_NUMBER: _ClassVar[int]
    ELEVATOR_FIELD_NUMBER: _ClassVar[int]
    RUDDER_FIELD_NUMBER: _ClassVar[int]
    THROTTLE_FIELD_NUMBER: _ClassVar[int]
    FLAP_FIELD_NUMBER: _ClassVar[int]
    BRAKE_FIELD_NUMBER: _ClassVar[int]
    BRAKE_DIFFERENCE_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    aileron: float
    elevator: float
    rudder: float
    throttle: float
    flap: float
    brake: float
    brake_difference: float
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., aileron: _Optional[float] = ..., elevator: _Optional[float] = ..., rudder: _Optional[float] = ..., throttle: _Optional[float] = ..., flap: _Optional[float] = ..., brake: _Optional[float] = ..., brake_difference: _Optional[float] = ...) -> None: ...

class GimbalCommand(_message.Message):
    __slots__ = ("timestamp", "pan", "tilt", "mode")
    class Mode(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        FOLLOW: _ClassVar[GimbalCommand.Mode]
        LOCK: _ClassVar[GimbalCommand.Mode]
        BODY: _ClassVar[GimbalCommand.Mode]
    FOLLOW: GimbalCommand.Mode
    LOCK: GimbalCommand.Mode
    BODY: GimbalCommand.Mode
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    PAN_FIELD_NUMBER: _ClassVar[int]
    TILT_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    pan: float
    tilt: float
    mode: GimbalCommand.Mode
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., pan: _Optional[float] = ..., tilt: _Optional[float] = ..., mode: _Optional[_Union[GimbalCommand.Mode, str]] = ...) -> None: ...

class StopEngagement(_message.Message):
    __slots__ = ("source", "id", "reason", "since")
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    ID_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    SINCE_FIELD_NUMBER: _ClassVar[int]
    source: str
    id: int
    reason: str
    since: _timestamp_pb2.Timestamp
    def __init__(self, source: _Optional[str] = ..., id: _Optional[int] = ..., reason: _Optional[str] = ..., since: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ...) -> None: ...

class StopCommand(_message.Message):
    __slots__ = ("timestamp", "engaged", "source", "id", "reason", "releases")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    ENGAGED_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    ID_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    RELEASES_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    engaged: bool
    source: str
    id: int
    reason: str
    releases: _containers.RepeatedCompositeFieldContainer[StopEngagement]
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., engaged: bool = ..., source: _Optional[str] = ..., id: _Optional[int] = ..., reason: _Optional[str] = ..., releases: _Optional[_Iterable[_Union[StopEngagement, _Mapping]]] = ...) -> None: ...

class StopState(_message.Message):
    __slots__ = ("timestamp", "engagements", "released")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    ENGAGEMENTS_FIELD_NUMBER: _ClassVar[int]
    RELEASED_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    engagements: _containers.RepeatedCompositeFieldContainer[StopEngagement]
    released: _containers.RepeatedCompositeFieldContainer[StopEngagement]
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., engagements: _Optional[_Iterable[_Union[StopEngagement, _Mapping]]] = ..., released: _Optional[_Iterable[_Union[StopEngagement, _Mapping]]] = ...) -> None: ...

class FlightSetpoint(_message.Message):
    __slots__ = ("timestamp", "attitude", "course", "line", "circle")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    ATTITUDE_FIELD_NUMBER: _ClassVar[int]
    COURSE_FIELD_NUMBER: _ClassVar[int]
    LINE_FIELD_NUMBER: _ClassVar[int]
    CIRCLE_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    attitude: AttitudeSetpoint
    course: CourseSetpoint
    line: LineSetpoint
    circle: CircleSetpoint
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., attitude: _Optional[_Union[AttitudeSetpoint, _Mapping]] = ..., course: _Optional[_Union[CourseSetpoint, _Mapping]] = ..., line: _Optional[_Union[LineSetpoint, _Mapping]] = ..., circle: _Optional[_Union[CircleSetpoint, _Mapping]] = ...) -> None: ...

class AttitudeSetpoint(_message.Message):
    __slots__ = ("bank", "pitch", "throttle")
    BANK_FIELD_NUMBER: _ClassVar[int]
    PITCH_FIELD_NUMBER: _ClassVar[int]
    THROTTLE_FIELD_NUMBER: _ClassVar[int]
    bank: float
    pitch: float
    throttle: float
    def __init__(self, bank: _Optional[float] = ..., pitch: _Optional[float] = ..., throttle: _Optional[float] = ...) -> None: ...

class CourseSetpoint(_message.Message):
    __slots__ = ("course", "altitude", "airspeed")
    COURSE_FIELD_NUMBER: _ClassVar[int]
    ALTITUDE_FIELD_NUMBER: _ClassVar[int]
    AIRSPEED_FIELD_NUMBER: _ClassVar[int]
    course: float
    altitude: float
    airspeed: float
    def __init__(self, course: _Optional[float] = ..., altitude: _Optional[float] = ..., airspeed: _Optional[float] = ...) -> None: ...

class LineSetpoint(_message.Message):
    __slots__ = ("origin", "direction", "airspeed")
    ORIGIN_FIELD_NUMBER: _ClassVar[int]
    DIRECTION_FIELD_NUMBER: _ClassVar[int]
    AIRSPEED_FIELD_NUMBER: _ClassVar[int]
    origin: _Vector3_pb2.Vector3
    direction: _Vector3_pb2.Vector3
    airspeed: float
    def __init__(self, origin: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., direction: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., airspeed: _Optional[float] = ...) -> None: ...

class CircleSetpoint(_message.Message):
    __slots__ = ("centre", "radius", "airspeed")
    CENTRE_FIELD_NUMBER: _ClassVar[int]
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    AIRSPEED_FIELD_NUMBER: _ClassVar[int]
    centre: _Vector3_pb2.Vector3
    radius: float
    airspeed: float
    def __init__(self, centre: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., radius: _Optional[float] = ..., airspeed: _Optional[float] = ...) -> None: ...
