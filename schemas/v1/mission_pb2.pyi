from foxglove_schemas_protobuf import Vector3_pb2 as _Vector3_pb2
from google.protobuf import timestamp_pb2 as _timestamp_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class MissionItem(_message.Message):
    __slots__ = ("kind", "position", "acceptance_radius", "hold", "radius", "turns", "speed", "jump_to", "repeat", "origin", "course", "to_altitude", "distance")
    class Kind(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        WAYPOINT: _ClassVar[MissionItem.Kind]
        ORBIT: _ClassVar[MissionItem.Kind]
        RETURN: _ClassVar[MissionItem.Kind]
        JUMP: _ClassVar[MissionItem.Kind]
        SPEED: _ClassVar[MissionItem.Kind]
        TAKEOFF: _ClassVar[MissionItem.Kind]
        LAND: _ClassVar[MissionItem.Kind]
        TRIGGER: _ClassVar[MissionItem.Kind]
        TRIGGER_DISTANCE: _ClassVar[MissionItem.Kind]
        LAND_START: _ClassVar[MissionItem.Kind]
        SET_HOME: _ClassVar[MissionItem.Kind]
    WAYPOINT: MissionItem.Kind
    ORBIT: MissionItem.Kind
    RETURN: MissionItem.Kind
    JUMP: MissionItem.Kind
    SPEED: MissionItem.Kind
    TAKEOFF: MissionItem.Kind
    LAND: MissionItem.Kind
    TRIGGER: MissionItem.Kind
    TRIGGER_DISTANCE: MissionItem.Kind
    LAND_START: MissionItem.Kind
    SET_HOME: MissionItem.Kind
    KIND_FIELD_NUMBER: _ClassVar[int]
    POSITION_FIELD_NUMBER: _ClassVar[int]
    ACCEPTANCE_RADIUS_FIELD_NUMBER: _ClassVar[int]
    HOLD_FIELD_NUMBER: _ClassVar[int]
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    TURNS_FIELD_NUMBER: _ClassVar[int]
    SPEED_FIELD_NUMBER: _ClassVar[int]
    JUMP_TO_FIELD_NUMBER: _ClassVar[int]
    REPEAT_FIELD_NUMBER: _ClassVar[int]
    ORIGIN_FIELD_NUMBER: _ClassVar[int]
    COURSE_FIELD_NUMBER: _ClassVar[int]
    TO_ALTITUDE_FIELD_NUMBER: _ClassVar[int]
    DISTANCE_FIELD_NUMBER: _ClassVar[int]
    kind: MissionItem.Kind
    position: _Vector3_pb2.Vector3
    acceptance_radius: float
    hold: float
    radius: float
    turns: float
    speed: float
    jump_to: int
    repeat: int
    origin: bytes
    course: float
    to_altitude: bool
    distance: float
    def __init__(self, kind: _Optional[_Union[MissionItem.Kind, str]] = ..., position: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., acceptance_radius: _Optional[float] = ..., hold: _Optional[float] = ..., radius: _Optional[float] = ..., turns: _Optional[float] = ..., speed: _Optional[float] = ..., jump_to: _Optional[int] = ..., repeat: _Optional[int] = ..., origin: _Optional[bytes] = ..., course: _Optional[float] = ..., to_altitude: bool = ..., distance: _Optional[float] = ...) -> None: ...

class Mission(_message.Message):
    __slots__ = ("timestamp", "items", "id")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    ITEMS_FIELD_NUMBER: _ClassVar[int]
    ID_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    items: _containers.RepeatedCompositeFieldContainer[MissionItem]
    id: int
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., items: _Optional[_Iterable[_Union[MissionItem, _Mapping]]] = ..., id: _Optional[int] = ...) -> None: ...

class MissionProgress(_message.Message):
    __slots__ = ("timestamp", "state", "current", "total", "reached", "laps", "mission_id")
    class State(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        NO_MISSION: _ClassVar[MissionProgress.State]
        NOT_STARTED: _ClassVar[MissionProgress.State]
        ACTIVE: _ClassVar[MissionProgress.State]
        PAUSED: _ClassVar[MissionProgress.State]
        COMPLETE: _ClassVar[MissionProgress.State]
    NO_MISSION: MissionProgress.State
    NOT_STARTED: MissionProgress.State
    ACTIVE: MissionProgress.State
    PAUSED: MissionProgress.State
    COMPLETE: MissionProgress.State
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    STATE_FIELD_NUMBER: _ClassVar[int]
    CURRENT_FIELD_NUMBER: _ClassVar[int]
    TOTAL_FIELD_NUMBER: _ClassVar[int]
    REACHED_FIELD_NUMBER: _ClassVar[int]
    LAPS_FIELD_NUMBER: _ClassVar[int]
    MISSION_ID_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    state: MissionProgress.State
    current: int
    total: int
    reached: int
    laps: int
    mission_id: int
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., state: _Optional[_Union[MissionProgress.State, str]] = ..., current: _Optional[int] = ..., total: _Optional[int] = ..., reached: _Optional[int] = ..., laps: _Optional[int] = ..., mission_id: _Optional[int] = ...) -> None: ...

class MissionRequest(_message.Message):
    __slots__ = ("mission", "source")
    MISSION_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    mission: Mission
    source: str
    def __init__(self, mission: _Optional[_Union[Mission, _Mapping]] = ..., source: _Optional[str] = ...) -> None: ...

class SetCurrentRequest(_message.Message):
    __slots__ = ("index", "source")
    INDEX_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    index: int
    source: str
    def __init__(self, index: _Optional[int] = ..., source: _Optional[str] = ...) -> None: ...

class GoalRequest(_message.Message):
    __slots__ = ("position", "yaw", "source", "radius", "speed")
    POSITION_FIELD_NUMBER: _ClassVar[int]
    YAW_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    SPEED_FIELD_NUMBER: _ClassVar[int]
    position: _Vector3_pb2.Vector3
    yaw: float
    source: str
    radius: float
    speed: float
    def __init__(self, position: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., yaw: _Optional[float] = ..., source: _Optional[str] = ..., radius: _Optional[float] = ..., speed: _Optional[float] = ...) -> None: ...

class RouteRequest(_message.Message):
    __slots__ = ("places", "kind", "yaw", "source")
    class Kind(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        WAYPOINTS: _ClassVar[RouteRequest.Kind]
        THROUGH: _ClassVar[RouteRequest.Kind]
        PATROL: _ClassVar[RouteRequest.Kind]
    WAYPOINTS: RouteRequest.Kind
    THROUGH: RouteRequest.Kind
    PATROL: RouteRequest.Kind
    PLACES_FIELD_NUMBER: _ClassVar[int]
    KIND_FIELD_NUMBER: _ClassVar[int]
    YAW_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    places: _containers.RepeatedCompositeFieldContainer[_Vector3_pb2.Vector3]
    kind: RouteRequest.Kind
    yaw: float
    source: str
    def __init__(self, places: _Optional[_Iterable[_Union[_Vector3_pb2.Vector3, _Mapping]]] = ..., kind: _Optional[_Union[RouteRequest.Kind, str]] = ..., yaw: _Optional[float] = ..., source: _Optional[str] = ...) -> None: ...

class FollowRequest(_message.Message):
    __slots__ = ("vehicle", "distance", "source")
    VEHICLE_FIELD_NUMBER: _ClassVar[int]
    DISTANCE_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    vehicle: str
    distance: float
    source: str
    def __init__(self, vehicle: _Optional[str] = ..., distance: _Optional[float] = ..., source: _Optional[str] = ...) -> None: ...

class OrbitRequest(_message.Message):
    __slots__ = ("centre", "radius", "speed", "source")
    CENTRE_FIELD_NUMBER: _ClassVar[int]
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    SPEED_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    centre: _Vector3_pb2.Vector3
    radius: float
    speed: float
    source: str
    def __init__(self, centre: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., radius: _Optional[float] = ..., speed: _Optional[float] = ..., source: _Optional[str] = ...) -> None: ...

class GoAroundRequest(_message.Message):
    __slots__ = ("source",)
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    source: str
    def __init__(self, source: _Optional[str] = ...) -> None: ...

class CancelRequest(_message.Message):
    __slots__ = ("source",)
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    source: str
    def __init__(self, source: _Optional[str] = ...) -> None: ...

class NavStatus(_message.Message):
    __slots__ = ("timestamp", "state", "job", "goal", "distance_left", "reason", "explored", "time_left", "recoveries", "route", "route_at", "follow", "radius", "waits_for")
    class State(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        IDLE: _ClassVar[NavStatus.State]
        PLANNING: _ClassVar[NavStatus.State]
        DRIVING: _ClassVar[NavStatus.State]
        REACHED: _ClassVar[NavStatus.State]
        BLOCKED: _ClassVar[NavStatus.State]
        RECOVERING: _ClassVar[NavStatus.State]
        CANCELLED: _ClassVar[NavStatus.State]
    IDLE: NavStatus.State
    PLANNING: NavStatus.State
    DRIVING: NavStatus.State
    REACHED: NavStatus.State
    BLOCKED: NavStatus.State
    RECOVERING: NavStatus.State
    CANCELLED: NavStatus.State
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    STATE_FIELD_NUMBER: _ClassVar[int]
    JOB_FIELD_NUMBER: _ClassVar[int]
    GOAL_FIELD_NUMBER: _ClassVar[int]
    DISTANCE_LEFT_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    EXPLORED_FIELD_NUMBER: _ClassVar[int]
    TIME_LEFT_FIELD_NUMBER: _ClassVar[int]
    RECOVERIES_FIELD_NUMBER: _ClassVar[int]
    ROUTE_FIELD_NUMBER: _ClassVar[int]
    ROUTE_AT_FIELD_NUMBER: _ClassVar[int]
    FOLLOW_FIELD_NUMBER: _ClassVar[int]
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    WAITS_FOR_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    state: NavStatus.State
    job: str
    goal: _Vector3_pb2.Vector3
    distance_left: float
    reason: str
    explored: float
    time_left: float
    recoveries: int
    route: RouteRequest
    route_at: int
    follow: FollowRequest
    radius: float
    waits_for: str
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., state: _Optional[_Union[NavStatus.State, str]] = ..., job: _Optional[str] = ..., goal: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., distance_left: _Optional[float] = ..., reason: _Optional[str] = ..., explored: _Optional[float] = ..., time_left: _Optional[float] = ..., recoveries: _Optional[int] = ..., route: _Optional[_Union[RouteRequest, _Mapping]] = ..., route_at: _Optional[int] = ..., follow: _Optional[_Union[FollowRequest, _Mapping]] = ..., radius: _Optional[float] = ..., waits_for: _Optional[str] = ...) -> None: ...
