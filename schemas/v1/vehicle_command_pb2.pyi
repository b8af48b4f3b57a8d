from foxglove_schemas_protobuf import Vector3_pb2 as _Vector3_pb2
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class VehicleCommandRequest(_message.Message):
    __slots__ = ("takeoff", "speed", "altitude", "home", "picture", "reboot", "source")
    TAKEOFF_FIELD_NUMBER: _ClassVar[int]
    SPEED_FIELD_NUMBER: _ClassVar[int]
    ALTITUDE_FIELD_NUMBER: _ClassVar[int]
    HOME_FIELD_NUMBER: _ClassVar[int]
    PICTURE_FIELD_NUMBER: _ClassVar[int]
    REBOOT_FIELD_NUMBER: _ClassVar[int]
    SOURCE_FIELD_NUMBER: _ClassVar[int]
    takeoff: TakeoffCommand
    speed: SpeedCommand
    altitude: AltitudeCommand
    home: HomeCommand
    picture: PictureCommand
    reboot: RebootCommand
    source: str
    def __init__(self, takeoff: _Optional[_Union[TakeoffCommand, _Mapping]] = ..., speed: _Optional[_Union[SpeedCommand, _Mapping]] = ..., altitude: _Optional[_Union[AltitudeCommand, _Mapping]] = ..., home: _Optional[_Union[HomeCommand, _Mapping]] = ..., picture: _Optional[_Union[PictureCommand, _Mapping]] = ..., reboot: _Optional[_Union[RebootCommand, _Mapping]] = ..., source: _Optional[str] = ...) -> None: ...

class TakeoffCommand(_message.Message):
    __slots__ = ("altitude",)
    ALTITUDE_FIELD_NUMBER: _ClassVar[int]
    altitude: float
    def __init__(self, altitude: _Optional[float] = ...) -> None: ...

class SpeedCommand(_message.Message):
    __slots__ = ("speed", "over_ground")
    SPEED_FIELD_NUMBER: _ClassVar[int]
    OVER_GROUND_FIELD_NUMBER: _ClassVar[int]
    speed: float
    over_ground: bool
    def __init__(self, speed: _Optional[float] = ..., over_ground: bool = ...) -> None: ...

class AltitudeCommand(_message.Message):
    __slots__ = ("altitude",)
    ALTITUDE_FIELD_NUMBER: _ClassVar[int]
    altitude: float
    def __init__(self, altitude: _Optional[float] = ...) -> None: ...

class HomeCommand(_message.Message):
    __slots__ = ("position",)
    POSITION_FIELD_NUMBER: _ClassVar[int]
    position: _Vector3_pb2.Vector3
    def __init__(self, position: _Optional[_Union[_Vector3_pb2.Vector3, _Mapping]] = ...) -> None: ...

class PictureCommand(_message.Message):
    __slots__ = ("distance",)
    DISTANCE_FIELD_NUMBER: _ClassVar[int]
    distance: float
    def __init__(self, distance: _Optional[float] = ...) -> None: ...

class RebootCommand(_message.Message):
    __slots__ = ()
    def __init__(self) -> None: ...
