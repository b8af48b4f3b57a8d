from foxglove_schemas_protobuf import Grid_pb2 as _Grid_pb2
from foxglove_schemas_protobuf import Pose_pb2 as _Pose_pb2
from google.protobuf import timestamp_pb2 as _timestamp_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class SaveMapRequest(_message.Message):
    __slots__ = ("name", "mode", "source", "layer")
    NAME_FIELD_NUMBER: _ClassVar[int]
    MODE_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    LAYER_FIELD_NUMBER: _ClassVar[int]
    name: str
    mode: str
    source: str
    layer: str
    def __init__(self, name: _Optional[str] = ..., mode: _Optional[str] = ..., source: _Optional[str] = ..., layer: _Optional[str] = ...) -> None: ...

class MapRequest(_message.Message):
    __slots__ = ("layer", "source", "area")
    LAYER_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    AREA_FIELD_NUMBER: _ClassVar[int]
    layer: str
    source: str
    area: _containers.RepeatedScalarFieldContainer[float]
    def __init__(self, layer: _Optional[str] = ..., source: _Optional[str] = ..., area: _Optional[_Iterable[float]] = ...) -> None: ...

class MapReply(_message.Message):
    __slots__ = ("accepted", "reason", "grid")
    ACCEPTED_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    GRID_FIELD_NUMBER: _ClassVar[int]
    accepted: bool
    reason: str
    grid: _Grid_pb2.Grid
    def __init__(self, accepted: bool = ..., reason: _Optional[str] = ..., grid: _Optional[_Union[_Grid_pb2.Grid, _Mapping]] = ...) -> None: ...

class MapFix(_message.Message):
    __slots__ = ("timestamp", "x", "y", "yaw", "covariance", "quality")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    X_FIELD_NUMBER: _ClassVar[int]
    Y_FIELD_NUMBER: _ClassVar[int]
    YAW_FIELD_NUMBER: _ClassVar[int]
    COVARIANCE_FIELD_NUMBER: _ClassVar[int]
    QUALITY_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    x: float
    y: float
    yaw: float
    covariance: _containers.RepeatedScalarFieldContainer[float]
    quality: float
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., x: _Optional[float] = ..., y: _Optional[float] = ..., yaw: _Optional[float] = ..., covariance: _Optional[_Iterable[float]] = ..., quality: _Optional[float] = ...) -> None: ...

class PlaceRequest(_message.Message):
    __slots__ = ("pose", "position_sigma", "yaw_sigma", "source")
    POSE_FIELD_NUMBER: _ClassVar[int]
    POSITION_SIGMA_FIELD_NUMBER: _ClassVar[int]
    YAW_SIGMA_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    pose: _Pose_pb2.Pose
    position_sigma: float
    yaw_sigma: float
    source: str
    def __init__(self, pose: _Optional[_Union[_Pose_pb2.Pose, _Mapping]] = ..., position_sigma: _Optional[float] = ..., yaw_sigma: _Optional[float] = ..., source: _Optional[str] = ...) -> None: ...

class RelocalizeRequest(_message.Message):
    __slots__ = ("source",)
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    source: str
    def __init__(self, source: _Optional[str] = ...) -> None: ...

class MapSession(_message.Message):
    __slots__ = ("timestamp", "data")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    DATA_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    data: bytes
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., data: _Optional[bytes] = ...) -> None: ...

class MappingRequest(_message.Message):
    __slots__ = ("action", "method", "source")
    class Action(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        HOLD: _ClassVar[MappingRequest.Action]
        GO_ON: _ClassVar[MappingRequest.Action]
        BEGIN: _ClassVar[MappingRequest.Action]
    HOLD: MappingRequest.Action
    GO_ON: MappingRequest.Action
    BEGIN: MappingRequest.Action
    ACTION_FIELD_NUMBER: _ClassVar[int]
    METHOD_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    action: MappingRequest.Action
    method: str
    source: str
    def __init__(self, action: _Optional[_Union[MappingRequest.Action, str]] = ..., method: _Optional[str] = ..., source: _Optional[str] = ...) -> None: ...
