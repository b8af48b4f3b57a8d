from foxglove_schemas_protobuf import Vector3_pb2 as _Vector3_pb2
from google.protobuf import timestamp_pb2 as _timestamp_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Imu(_message.Message):
    __slots__ = ("timestamp", "frame_id", "angular_velocity", "specific_force", "magnetic_field")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    FRAME_ID_FIELD_NUMBER: _ClassVar[int]
    ANGULAR_VELOCITY_FIELD_NUMBER: _ClassVar[int]
    SPECIFIC_FORCE_FIELD_NUMBER: _ClassVar[int]
    MAGNETIC_FIELD_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    frame_id: str
    angular_velocity: _Vector3_pb2.Vector3
    specific_force: _Vector3_pb2.Vector3
    magnetic_field: _Vector3_pb2.Vector3
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., frame_id: _Optional[str] = ..., angular_velocity: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., specific_force: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., magnetic_field: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ...) -> None: ...

class WheelTicks(_message.Message):
    __slots__ = ("timestamp", "left", "right", "radians_per_tick", "each")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    LEFT_FIELD_NUMBER: _ClassVar[int]
    RIGHT_FIELD_NUMBER: _ClassVar[int]
    RADIANS_PER_TICK_FIELD_NUMBER: _ClassVar[int]
    EACH_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    left: int
    right: int
    radians_per_tick: float
    each: _containers.RepeatedScalarFieldContainer[int]
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., left: _Optional[int] = ..., right: _Optional[int] = ..., radians_per_tick: _Optional[float] = ..., each: _Optional[_Iterable[int]] = ...) -> None: ...

class Gnss(_message.Message):
    __slots__ = ("timestamp", "fix", "latitude", "longitude", "altitude", "velocity_enu", "horizontal_accuracy", "vertical_accuracy", "speed_accuracy", "satellites")
    class Fix(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        NONE: _ClassVar[Gnss.Fix]
        FIX_3D: _ClassVar[Gnss.Fix]
    NONE: Gnss.Fix
    FIX_3D: Gnss.Fix
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    FIX_FIELD_NUMBER: _ClassVar[int]
    LATITUDE_FIELD_NUMBER: _ClassVar[int]
    LONGITUDE_FIELD_NUMBER: _ClassVar[int]
    ALTITUDE_FIELD_NUMBER: _ClassVar[int]
    VELOCITY_ENU_FIELD_NUMBER: _ClassVar[int]
    HORIZONTAL_ACCURACY_FIELD_NUMBER: _ClassVar[int]
    VERTICAL_ACCURACY_FIELD_NUMBER: _ClassVar[int]
    SPEED_ACCURACY_FIELD_NUMBER: _ClassVar[int]
    SATELLITES_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    fix: Gnss.Fix
    latitude: float
    longitude: float
    altitude: float
    velocity_enu: _Vector3_pb2.Vector3
    horizontal_accuracy: float
    vertical_accuracy: float
    speed_accuracy: float
    satellites: int
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., fix: _Optional[_Union[Gnss.Fix, str]] = ..., latitude: _Optional[float] = ..., longitude: _Optional[float] = ..., altitude: _Optional[float] = ..., velocity_enu: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., horizontal_accuracy: _Optional[float] = ..., vertical_accuracy: _Optional[float] = ..., speed_accuracy: _Optional[float] = ..., satellites: _Optional[int] = ...) -> None: ...

class AirData(_message.Message):
    __slots__ = ("timestamp", "static_pressure", "differential_pressure", "temperature")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    STATIC_PRESSURE_FIELD_NUMBER: _ClassVar[int]
    DIFFERENTIAL_PRESSURE_FIELD_NUMBER: _ClassVar[int]
    TEMPERATURE_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    static_pressure: float
    differential_pressure: float
    temperature: float
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., static_pressure: _Optional[float] = ..., differential_pressure: _Optional[float] = ..., temperature: _Optional[float] = ...) -> None: ...

class Contact(_message.Message):
    __slots__ = ("timestamp", "touching", "other", "sectors")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    TOUCHING_FIELD_NUMBER: _ClassVar[int]
    OTHER_FIELD_NUMBER: _ClassVar[int]
    SECTORS_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    touching: bool
    other: str
    sectors: _containers.RepeatedScalarFieldContainer[str]
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., touching: bool = ..., other: _Optional[str] = ..., sectors: _Optional[_Iterable[str]] = ...) -> None: ...

class Range(_message.Message):
    __slots__ = ("timestamp", "frame_id", "range", "field_of_view", "range_min", "range_max")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    FRAME_ID_FIELD_NUMBER: _ClassVar[int]
    RANGE_FIELD_NUMBER: _ClassVar[int]
    FIELD_OF_VIEW_FIELD_NUMBER: _ClassVar[int]
    RANGE_MIN_FIELD_NUMBER: _ClassVar[int]
    RANGE_MAX_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    frame_id: str
    range: float
    field_of_view: float
    range_min: float
    range_max: float
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., frame_id: _Optional[str] = ..., range: _Optional[float] = ..., field_of_view: _Optional[float] = ..., range_min: _Optional[float] = ..., range_max: _Optional[float] = ...) -> None: ...

class Battery(_message.Message):
    __slots__ = ("timestamp", "voltage", "current", "remaining")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    VOLTAGE_FIELD_NUMBER: _ClassVar[int]
    CURRENT_FIELD_NUMBER: _ClassVar[int]
    REMAINING_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    voltage: float
    current: float
    remaining: float
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., voltage: _Optional[float] = ..., current: _Optional[float] = ..., remaining: _Optional[float] = ...) -> None: ...
