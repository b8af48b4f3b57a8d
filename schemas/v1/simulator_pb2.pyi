from foxglove_schemas_protobuf import Color_pb2 as _Color_pb2
from foxglove_schemas_protobuf import Pose_pb2 as _Pose_pb2
from foxglove_schemas_protobuf import Vector3_pb2 as _Vector3_pb2
from google.protobuf import timestamp_pb2 as _timestamp_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class SimObject(_message.Message):
    __slots__ = ("name", "shape", "size", "pose", "mass", "color", "model")
    NAME_FIELD_NUMBER: _ClassVar[int]
    SHAPE_FIELD_NUMBER: _ClassVar[int]
    SIZE_FIELD_NUMBER: _ClassVar[int]
    POSE_FIELD_NUMBER: _ClassVar[int]
    MASS_FIELD_NUMBER: _ClassVar[int]
    COLOR_FIELD_NUMBER: _ClassVar[int]
    MODEL_FIELD_NUMBER: _ClassVar[int]
    name: str
    shape: str
    size: _containers.RepeatedScalarFieldContainer[float]
    pose: _Pose_pb2.Pose
    mass: float
    color: _Color_pb2.Color
    model: str
    def __init__(self, name: _Optional[str] = ..., shape: _Optional[str] = ..., size: _Optional[_Iterable[float]] = ..., pose: _Optional[_Union[_Pose_pb2.Pose, _Mapping]] = ..., mass: _Optional[float] = ..., color: _Optional[_Union[_Color_pb2.Color, _Mapping]] = ..., model: _Optional[str] = ...) -> None: ...

class SimObjects(_message.Message):
    __slots__ = ("timestamp", "objects")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    OBJECTS_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    objects: _containers.RepeatedCompositeFieldContainer[SimObject]
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., objects: _Optional[_Iterable[_Union[SimObject, _Mapping]]] = ...) -> None: ...

class SpawnRequest(_message.Message):
    __slots__ = ("object", "source", "speed")
    OBJECT_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    SPEED_FIELD_NUMBER: _ClassVar[int]
    object: SimObject
    source: str
    speed: float
    def __init__(self, object: _Optional[_Union[SimObject, _Mapping]] = ..., source: _Optional[str] = ..., speed: _Optional[float] = ...) -> None: ...

class RemoveRequest(_message.Message):
    __slots__ = ("name", "source")
    NAME_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    name: str
    source: str
    def __init__(self, name: _Optional[str] = ..., source: _Optional[str] = ...) -> None: ...

class SetPoseRequest(_message.Message):
    __slots__ = ("name", "pose", "source", "speed", "climb", "turn_rate")
    NAME_FIELD_NUMBER: _ClassVar[int]
    POSE_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    SPEED_FIELD_NUMBER: _ClassVar[int]
    CLIMB_FIELD_NUMBER: _ClassVar[int]
    TURN_RATE_FIELD_NUMBER: _ClassVar[int]
    name: str
    pose: _Pose_pb2.Pose
    source: str
    speed: float
    climb: float
    turn_rate: float
    def __init__(self, name: _Optional[str] = ..., pose: _Optional[_Union[_Pose_pb2.Pose, _Mapping]] = ..., source: _Optional[str] = ..., speed: _Optional[float] = ..., climb: _Optional[float] = ..., turn_rate: _Optional[float] = ...) -> None: ...

class StateRequest(_message.Message):
    __slots__ = ("name", "source", "only_ask")
    NAME_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    ONLY_ASK_FIELD_NUMBER: _ClassVar[int]
    name: str
    source: str
    only_ask: bool
    def __init__(self, name: _Optional[str] = ..., source: _Optional[str] = ..., only_ask: bool = ...) -> None: ...

class WindRequest(_message.Message):
    __slots__ = ("velocity", "source")
    VELOCITY_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    velocity: _Vector3_pb2.Vector3
    source: str
    def __init__(self, velocity: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., source: _Optional[str] = ...) -> None: ...
