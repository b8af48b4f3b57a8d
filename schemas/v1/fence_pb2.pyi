from foxglove_schemas_protobuf import Vector3_pb2 as _Vector3_pb2
from google.protobuf import timestamp_pb2 as _timestamp_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class FenceZone(_message.Message):
    __slots__ = ("vertices", "centre", "radius", "excludes", "group")
    VERTICES_FIELD_NUMBER: _ClassVar[int]
    CENTRE_FIELD_NUMBER: _ClassVar[int]
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    EXCLUDES_FIELD_NUMBER: _ClassVar[int]
    GROUP_FIELD_NUMBER: _ClassVar[int]
    vertices: _containers.RepeatedCompositeFieldContainer[_Vector3_pb2.Vector3]
    centre: _Vector3_pb2.Vector3
    radius: float
    excludes: bool
    group: int
    def __init__(self, vertices: _Optional[_Iterable[_Union[_Vector3_pb2.Vector3, _Mapping]]] = ..., centre: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., radius: _Optional[float] = ..., excludes: bool = ..., group: _Optional[int] = ...) -> None: ...

class Fence(_message.Message):
    __slots__ = ("timestamp", "zones", "floor", "ceiling", "action", "disabled", "return_point", "origin")
    class Action(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        RETURN: _ClassVar[Fence.Action]
        HOLD: _ClassVar[Fence.Action]
        WARN: _ClassVar[Fence.Action]
        LAND: _ClassVar[Fence.Action]
    RETURN: Fence.Action
    HOLD: Fence.Action
    WARN: Fence.Action
    LAND: Fence.Action
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    ZONES_FIELD_NUMBER: _ClassVar[int]
    FLOOR_FIELD_NUMBER: _ClassVar[int]
    CEILING_FIELD_NUMBER: _ClassVar[int]
    ACTION_FIELD_NUMBER: _ClassVar[int]
    DISABLED_FIELD_NUMBER: _ClassVar[int]
    RETURN_POINT_FIELD_NUMBER: _ClassVar[int]
    ORIGIN_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    zones: _containers.RepeatedCompositeFieldContainer[FenceZone]
    floor: float
    ceiling: float
    action: Fence.Action
    disabled: bool
    return_point: _Vector3_pb2.Vector3
    origin: _containers.RepeatedScalarFieldContainer[bytes]
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., zones: _Optional[_Iterable[_Union[FenceZone, _Mapping]]] = ..., floor: _Optional[float] = ..., ceiling: _Optional[float] = ..., action: _Optional[_Union[Fence.Action, str]] = ..., disabled: bool = ..., return_point: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., origin: _Optional[_Iterable[bytes]] = ...) -> None: ...

class FenceRequest(_message.Message):
    __slots__ = ("fence", "source")
    FENCE_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    fence: Fence
    source: str
    def __init__(self, fence: _Optional[_Union[Fence, _Mapping]] = ..., source: _Optional[str] = ...) -> None: ...
