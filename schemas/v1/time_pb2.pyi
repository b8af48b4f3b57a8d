from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class Clock(_message.Message):
    __slots__ = ("tick", "t_ns", "epoch", "rate", "rate_wanted", "state", "lockstep", "published", "waiting_for", "due_wall")
    class State(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        RUNNING: _ClassVar[Clock.State]
        PAUSED: _ClassVar[Clock.State]
    RUNNING: Clock.State
    PAUSED: Clock.State
    class PublishedEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: int
        def __init__(self, key: _Optional[str] = ..., value: _Optional[int] = ...) -> None: ...
    TICK_FIELD_NUMBER: _ClassVar[int]
    T_NS_FIELD_NUMBER: _ClassVar[int]
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    RATE_FIELD_NUMBER: _ClassVar[int]
    RATE_WANTED_FIELD_NUMBER: _ClassVar[int]
    STATE_FIELD_NUMBER: _ClassVar[int]
    LOCKSTEP_FIELD_NUMBER: _ClassVar[int]
    PUBLISHED_FIELD_NUMBER: _ClassVar[int]
    WAITING_FOR_FIELD_NUMBER: _ClassVar[int]
    DUE_WALL_FIELD_NUMBER: _ClassVar[int]
    tick: int
    t_ns: int
    epoch: int
    rate: float
    rate_wanted: float
    state: Clock.State
    lockstep: bool
    published: _containers.ScalarMap[str, int]
    waiting_for: str
    due_wall: float
    def __init__(self, tick: _Optional[int] = ..., t_ns: _Optional[int] = ..., epoch: _Optional[int] = ..., rate: _Optional[float] = ..., rate_wanted: _Optional[float] = ..., state: _Optional[_Union[Clock.State, str]] = ..., lockstep: bool = ..., published: _Optional[_Mapping[str, int]] = ..., waiting_for: _Optional[str] = ..., due_wall: _Optional[float] = ...) -> None: ...

class Done(_message.Message):
    __slots__ = ("participant", "tick", "t_ns", "epoch", "published")
    class PublishedEntry(_message.Message):
        __slots__ = ("key", "value")
        KEY_FIELD_NUMBER: _ClassVar[int]
        VALUE_FIELD_NUMBER: _ClassVar[int]
        key: str
        value: int
        def __init__(self, key: _Optional[str] = ..., value: _Optional[int] = ...) -> None: ...
    PARTICIPANT_FIELD_NUMBER: _ClassVar[int]
    TICK_FIELD_NUMBER: _ClassVar[int]
    T_NS_FIELD_NUMBER: _ClassVar[int]
    EPOCH_FIELD_NUMBER: _ClassVar[int]
    PUBLISHED_FIELD_NUMBER: _ClassVar[int]
    participant: str
    tick: int
    t_ns: int
    epoch: int
    published: _containers.ScalarMap[str, int]
    def __init__(self, participant: _Optional[str] = ..., tick: _Optional[int] = ..., t_ns: _Optional[int] = ..., epoch: _Optional[int] = ..., published: _Optional[_Mapping[str, int]] = ...) -> None: ...

class ClockRequest(_message.Message):
    __slots__ = ("action", "rate")
    class Action(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        SET_RATE: _ClassVar[ClockRequest.Action]
        PAUSE: _ClassVar[ClockRequest.Action]
        RESUME: _ClassVar[ClockRequest.Action]
        STEP: _ClassVar[ClockRequest.Action]
        RESET: _ClassVar[ClockRequest.Action]
    SET_RATE: ClockRequest.Action
    PAUSE: ClockRequest.Action
    RESUME: ClockRequest.Action
    STEP: ClockRequest.Action
    RESET: ClockRequest.Action
    ACTION_FIELD_NUMBER: _ClassVar[int]
    RATE_FIELD_NUMBER: _ClassVar[int]
    action: ClockRequest.Action
    rate: float
    def __init__(self, action: _Optional[_Union[ClockRequest.Action, str]] = ..., rate: _Optional[float] = ...) -> None: ...
