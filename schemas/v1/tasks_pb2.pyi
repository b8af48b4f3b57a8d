from google.protobuf import timestamp_pb2 as _timestamp_pb2
from google.protobuf.internal import containers as _containers
from google.protobuf.internal import enum_type_wrapper as _enum_type_wrapper
from google.protobuf import descriptor as _descriptor
from google.protobuf import message as _message
from typing import ClassVar as _ClassVar, Iterable as _Iterable, Mapping as _Mapping, Optional as _Optional, Union as _Union

DESCRIPTOR: _descriptor.FileDescriptor

class TaskStatus(_message.Message):
    __slots__ = ("name", "depth", "state", "reason", "since", "kind")
    class State(int, metaclass=_enum_type_wrapper.EnumTypeWrapper):
        __slots__ = ()
        WAITING: _ClassVar[TaskStatus.State]
        RUNNING: _ClassVar[TaskStatus.State]
        DONE: _ClassVar[TaskStatus.State]
        FAILED: _ClassVar[TaskStatus.State]
        STOPPED: _ClassVar[TaskStatus.State]
    WAITING: TaskStatus.State
    RUNNING: TaskStatus.State
    DONE: TaskStatus.State
    FAILED: TaskStatus.State
    STOPPED: TaskStatus.State
    NAME_FIELD_NUMBER: _ClassVar[int]
    DEPTH_FIELD_NUMBER: _ClassVar[int]
    STATE_FIELD_NUMBER: _ClassVar[int]
    REASON_FIELD_NUMBER: _ClassVar[int]
    SINCE_FIELD_NUMBER: _ClassVar[int]
    KIND_FIELD_NUMBER: _ClassVar[int]
    name: str
    depth: int
    state: TaskStatus.State
    reason: str
    since: float
    kind: str
    def __init__(self, name: _Optional[str] = ..., depth: _Optional[int] = ..., state: _Optional[_Union[TaskStatus.State, str]] = ..., reason: _Optional[str] = ..., since: _Optional[float] = ..., kind: _Optional[str] = ...) -> None: ...

class Tasks(_message.Message):
    __slots__ = ("timestamp", "state", "tasks")
    TIMESTAMP_FIELD_NUMBER: _ClassVar[int]
    STATE_FIELD_NUMBER: _ClassVar[int]
    TASKS_FIELD_NUMBER: _ClassVar[int]
    timestamp: _timestamp_pb2.Timestamp
    state: TaskStatus.State
    tasks: _containers.RepeatedCompositeFieldContainer[TaskStatus]
    def __init__(self, timestamp: _Optional[_Union[_timestamp_pb2.Timestamp, _Mapping]] = ..., state: _Optional[_Union[TaskStatus.State, str]] = ..., tasks: _Optional[_Iterable[_Union[TaskStatus, _Mapping]]] = ...) -> None: ...
