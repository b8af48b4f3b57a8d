from foxglove_schemas_protobuf import Vector3_pb2 as _Vector3_pb2
from google.protobuf import timestamp_pb2 as _timestamp_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class RallyPoints(_message.Message):
    __slots__ = ("timestamp", "points", "origin")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    POINTS_FIELD_NUMBER: _ClassVar[int]
    ORIGIN_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    points: _containers.RepeatedCompositeFieldContainer[_Vector3_pb2.Vector3]
    origin: _containers.RepeatedScalarFieldContainer[bytes]
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., points: _Optional[_Iterable[_Union[_Vector3_pb2.Vector3, _Mapping]]] = ..., origin: _Optional[_Iterable[bytes]] = ...) -> None: ...

class RallyRequest(_message.Message):
    __slots__ = ("rally", "source")
    RALLY_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    rally: RallyPoints
    source: str
    def __init__(self, rally: _Optional[_Union[RallyPoints, _Mapping]] = ..., source: _Optional[str] = ...) -> None: ...
