from foxglove_schemas_protobuf import Vector3_pb2 as _Vector3_pb2
from google.protobuf import timestamp_pb2 as _timestamp_pb2
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Targets(_message.Message):
    __slots__ = ("timestamp", "place", "radius", "altitude", "airspeed", "bank", "pitch")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    PLACE_FIELD_NUMBER: _ClassVar[int]
    RADIUS_FIELD_NUMBER: _ClassVar[int]
    ALTITUDE_FIELD_NUMBER: _ClassVar[int]
    AIRSPEED_FIELD_NUMBER: _ClassVar[int]
    BANK_FIELD_NUMBER: _ClassVar[int]
    PITCH_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    place: _Vector3_pb2.Vector3
    radius: float
    altitude: float
    airspeed: float
    bank: float
    pitch: float
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., place: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ..., radius: _Optional[float] = ..., altitude: _Optional[float] = ..., airspeed: _Optional[float] = ..., bank: _Optional[float] = ..., pitch: _Optional[float] = ...) -> None: ...

class EstimateQuality(_message.Message):
    __slots__ = ("timestamp", "position_known", "height_known", "airspeed_known", "position_sigma", "height_sigma", "tilt_sigma", "yaw_sigma", "wind_sigma", "position_ratio", "velocity_ratio", "height_ratio", "airspeed_ratio", "slip_ratio", "field_ratio")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    POSITION_KNOWN_FIELD_NUMBER: _ClassVar[int]
    HEIGHT_KNOWN_FIELD_NUMBER: _ClassVar[int]
    AIRSPEED_KNOWN_FIELD_NUMBER: _ClassVar[int]
    POSITION_SIGMA_FIELD_NUMBER: _ClassVar[int]
    HEIGHT_SIGMA_FIELD_NUMBER: _ClassVar[int]
    TILT_SIGMA_FIELD_NUMBER: _ClassVar[int]
    YAW_SIGMA_FIELD_NUMBER: _ClassVar[int]
    WIND_SIGMA_FIELD_NUMBER: _ClassVar[int]
    POSITION_RATIO_FIELD_NUMBER: _ClassVar[int]
    VELOCITY_RATIO_FIELD_NUMBER: _ClassVar[int]
    HEIGHT_RATIO_FIELD_NUMBER: _ClassVar[int]
    AIRSPEED_RATIO_FIELD_NUMBER: _ClassVar[int]
    SLIP_RATIO_FIELD_NUMBER: _ClassVar[int]
    FIELD_RATIO_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    position_known: bool
    height_known: bool
    airspeed_known: bool
    position_sigma: float
    height_sigma: float
    tilt_sigma: float
    yaw_sigma: float
    wind_sigma: float
    position_ratio: float
    velocity_ratio: float
    height_ratio: float
    airspeed_ratio: float
    slip_ratio: float
    field_ratio: float
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., position_known: bool = ..., height_known: bool = ..., airspeed_known: bool = ..., position_sigma: _Optional[float] = ..., height_sigma: _Optional[float] = ..., tilt_sigma: _Optional[float] = ..., yaw_sigma: _Optional[float] = ..., wind_sigma: _Optional[float] = ..., position_ratio: _Optional[float] = ..., velocity_ratio: _Optional[float] = ..., height_ratio: _Optional[float] = ..., airspeed_ratio: _Optional[float] = ..., slip_ratio: _Optional[float] = ..., field_ratio: _Optional[float] = ...) -> None: ...
