from foxglove_schemas_protobuf import Quaternion_pb2 as _Quaternion_pb2
from foxglove_schemas_protobuf import Vector3_pb2 as _Vector3_pb2
from google.protobuf import timestamp_pb2 as _timestamp_pb2
from schemas.v1 import command_pb2 as _command_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Mode(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    MODE_UNSPECIFIED: _ClassVar[Mode]
    MODE_MANUAL: _ClassVar[Mode]
    MODE_HOLD: _ClassVar[Mode]
    MODE_MISSION: _ClassVar[Mode]
    MODE_RETURN: _ClassVar[Mode]
    MODE_STABILIZED: _ClassVar[Mode]
    MODE_ALTITUDE: _ClassVar[Mode]
    MODE_POSITION: _ClassVar[Mode]
    MODE_TAKEOFF: _ClassVar[Mode]
    MODE_LAND: _ClassVar[Mode]
    MODE_ORBIT: _ClassVar[Mode]
    MODE_OFFBOARD: _ClassVar[Mode]
    MODE_FOLLOW: _ClassVar[Mode]

class Kind(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    KIND_UNSPECIFIED: _ClassVar[Kind]
    KIND_GROUND: _ClassVar[Kind]
    KIND_FIXED_WING: _ClassVar[Kind]

class Breach(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
    __slots__ = ()
    BREACH_NONE: _ClassVar[Breach]
    BREACH_FLOOR: _ClassVar[Breach]
    BREACH_CEILING: _ClassVar[Breach]
    BREACH_EDGE: _ClassVar[Breach]
MODE_UNSPECIFIED: Mode
MODE_MANUAL: Mode
MODE_HOLD: Mode
MODE_MISSION: Mode
MODE_RETURN: Mode
MODE_STABILIZED: Mode
MODE_ALTITUDE: Mode
MODE_POSITION: Mode
MODE_TAKEOFF: Mode
MODE_LAND: Mode
MODE_ORBIT: Mode
MODE_OFFBOARD: Mode
MODE_FOLLOW: Mode
KIND_UNSPECIFIED: Kind
KIND_GROUND: Kind
KIND_FIXED_WING: Kind
BREACH_NONE: Breach
BREACH_FLOOR: Breach
BREACH_CEILING: Breach
BREACH_EDGE: Breach

class NavState(_message.Message):
    __slots__ = ("timestamp", "position", "velocity", "orientation", "angular_velocity", "airspeed", "wind", "position_sigma")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    POSITION_FIELD_NUMBER: _ClassVar[int]
    VELOCITY_FIELD_NUMBER: _ClassVar[int]
    ORIENTATION_FIELD_NUMBER: _ClassVar[int]
    ANGULAR_VELOCITY_FIELD_NUMBER: _ClassVar[int]
    AIRSPEED_FIELD_NUMBER: _ClassVar[int]
    WIND_FIELD_NUMBER: _ClassVar[int]
    POSITION_SIGMA_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    position: _Vector3_pb2.Vector3
    velocity: _Vector3_pb2.Vector3
    orientation: _Quaternion_pb2.Quaternion
    angular_velocity: _Vector3_pb2.Vector3
    airspeed: float
    wind: _Vector3_pb2.Vector3
    position_sigma: float
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., position: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., velocity: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., orientation: _Optional[_Union[_Quaternion_pb2.Quaternion, _Mapping]] = ..., angular_velocity: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., airspeed: _Optional[float] = ..., wind: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., position_sigma: _Optional[float] = ...) -> None: ...

class VehicleStatus(_message.Message):
    __slots__ = ("timestamp", "kind", "mode", "armed", "landed", "stopped", "command_source", "reason", "throttle", "battery_remaining", "battery_voltage", "waypoint", "cross_track", "altitude_error", "distance_to_waypoint", "home", "system_id", "prearm", "failsafes", "circle", "breach", "breaches", "stops")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    KIND_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    ARMED_FIELD_NUMBER: _ClassVar[int]
    LANDED_FIELD_NUMBER: _ClassVar[int]
    STOPPED_FIELD_NUMBER: _ClassVar[int]
    COMMAND_SOURCE_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    THROTTLE_FIELD_NUMBER: _ClassVar[int]
    BATTERY_REMAINING_FIELD_NUMBER: _ClassVar[int]
    BATTERY_VOLTAGE_FIELD_NUMBER: _ClassVar[int]
    WAYPOINT_FIELD_NUMBER: _ClassVar[int]
    CROSS_TRACK_FIELD_NUMBER: _ClassVar[int]
    ALTITUDE_ERROR_FIELD_NUMBER: _ClassVar[int]
    DISTANCE_TO_WAYPOINT_FIELD_NUMBER: _ClassVar[int]
    HOME_FIELD_NUMBER: _ClassVar[int]
    SYSTEM_ID_FIELD_NUMBER: _ClassVar[int]
    PREARM_FIELD_NUMBER: _ClassVar[int]
    FAILSAFES_FIELD_NUMBER: _ClassVar[int]
    CIRCLE_FIELD_NUMBER: _ClassVar[int]
    BREACH_FIELD_NUMBER: _ClassVar[int]
    BREACHES_FIELD_NUMBER: _ClassVar[int]
    STOPS_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    kind: Kind
    mode: Mode
    armed: bool
    landed: bool
    stopped: bool
    command_source: str
    reason: str
    throttle: float
    battery_remaining: float
    battery_voltage: float
    waypoint: int
    cross_track: float
    altitude_error: float
    distance_to_waypoint: float
    home: _Vector3_pb2.Vector3
    system_id: int
    prearm: _containers.RepeatedScalarFieldContainer[str]
    failsafes: _containers.RepeatedScalarFieldContainer[str]
    circle: Circle
    breach: Breach
    breaches: int
    stops: _containers.RepeatedCompositeFieldContainer[_command_pb2.StopEngagement]
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., kind: _Optional[_Union[Kind, str]] = ..., mode: _Optional[_Union[Mode, str]] = ..., armed: bool = ..., landed: bool = ..., stopped: bool = ..., command_source: _Optional[str] = ..., reason: _Optional[str] = ..., throttle: _Optional[float] = ..., battery_remaining: _Optional[float] = ..., battery_voltage: _Optional[float] = ..., waypoint: _Optional[int] = ..., cross_track: _Optional[float] = ..., altitude_error: _Optional[float] = ..., distance_to_waypoint: _Optional[float] = ..., home: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., system_id: _Optional[int] = ..., prearm: _Optional[_Iterable[str]] = ..., failsafes: _Optional[_Iterable[str]] = ..., circle: _Optional[_Union[Circle, _Mapping]] = ..., breach: _Optional[_Union[Breach, str]] = ..., breaches: _Optional[int] = ..., stops: _Optional[_Iterable[_Union[_command_pb2.StopEngagement, _Mapping]]] = ...) -> None: ...

class ExternalVehicle(_message.Message):
    __slots__ = ("timestamp", "model", "about")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    MODEL_FIELD_NUMBER: _ClassVar[int]
    ABOUT_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    model: str
    about: str
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., model: _Optional[str] = ..., about: _Optional[str] = ...) -> None: ...

class Circle(_message.Message):
    __slots__ = ("centre", "radius")
    CENTRE_FIELD_NUMBER: _ClassVar[int]
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    centre: _Vector3_pb2.Vector3
    radius: float
    def __init__(self, centre: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., radius: _Optional[float] = ...) -> None: ...

class ArmRequest(_message.Message):
    __slots__ = ("arm", "force", "source")
    ARM_FIELD_NUMBER: _ClassVar[int]
    FORCE_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    arm: bool
    force: bool
    source: str
    def __init__(self, arm: bool = ..., force: bool = ..., source: _Optional[str] = ...) -> None: ...

class ModeRequest(_message.Message):
    __slots__ = ("mode", "source")
    MODE_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    mode: Mode
    source: str
    def __init__(self, mode: _Optional[_Union[Mode, str]] = ..., source: _Optional[str] = ...) -> None: ...

class Reply(_message.Message):
    __slots__ = ("accepted", "reason")
    ACCEPTED_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    accepted: bool
    reason: str
    def __init__(self, accepted: bool = ..., reason: _Optional[str] = ...) -> None: ...
