"""What a service reads and writes, declared once as the types that its ``step`` is handed and returns.

class Inputs(Reads):
    pose: PoseInFrame = topic(topics.POSE)
    imu: list[Imu] = every(topics.IMU)
    goal: list[GoalRequest] = request(topics.GOAL)

class Outputs(Writes):
    path: PosesInFrame | None = topic(topics.PATH)
    goal: list[Reply] = replies(topics.GOAL)
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any, ClassVar, dataclass_transform

from schemas import topics
from schemas.topics import Request, Topic
from uvf.runtime.messages.outputs import Value

DECLARED = "declared"


@dataclass(frozen=True)
class Input:
    """How a service reads a topic: the newest message, or every one since the last step."""

    topic: Topic[Any]
    every: bool = False
    required: bool = True
    each_vehicle: bool = False
    role: str | None = None
    ages: bool = True
    """False: it counts however old it is."""

    def empty(self) -> Any:
        """Value of the input when nothing has been heard."""
        return {} if self.each_vehicle else [] if self.every else None


FRAME_TOPICS = (topics.TF_STATIC, topics.TF_WORLD, topics.TF_MAP, topics.TF_ODOM, topics.TF_JOINTS, topics.TF_BODY, topics.TF_GIMBAL)
"""What the tree of frames is told on; the latched ones are static."""


@dataclass(frozen=True)
class Frames:
    """Declares the tree of frames as one input: a ``FrameBuffer``."""

    team: bool

    def parts(self, name: str) -> dict[str, Input]:
        """The inputs that it consists of, by name."""
        return {
            f"{name}/{topic.key}": Input(topic, every=True, required=False, each_vehicle=self.team, ages=False) for topic in FRAME_TOPICS
        }


@dataclass(frozen=True)
class StopInput:
    """Declares STOP ALL as one input: a ``stop_all.StopStatus``."""

    def parts(self, name: str) -> dict[str, Input]:
        """The inputs that it consists of, by name."""
        heard: dict[str, Topic[Any]] = {"said": topics.STOP.by("*"), "known": topics.STOP_STATE}
        return {f"{name}/{part}": Input(topic, every=True, required=False, ages=False) for part, topic in heard.items()}


@dataclass(frozen=True)
class Served:
    """Declares requests of others: in ``Inputs`` those that are due, in ``Outputs`` the replies."""

    request: Request[Any, Any]


@dataclass(frozen=True)
class Called:
    """Declares requests to others: to be sent in ``Outputs``, the answers in ``Inputs``."""

    request: Request[Any, Any]


Declared = Input | Frames | StopInput | Served | Called


def _field(declared: Declared, empty: Any = None) -> Any:
    if empty is None:
        return field(default=None, metadata={DECLARED: declared})
    return field(default_factory=type(empty), metadata={DECLARED: declared})


def _input(what: Any) -> Input:
    """Of a topic, or of what another of these functions has declared."""
    return Input(what) if isinstance(what, Topic) else what.metadata[DECLARED]


def _read(declared: Input) -> Any:
    return _field(declared, declared.empty())


def topic(of: Topic[Any]) -> Any:
    """Declares a topic that is read or written.

    Read: the newest message; ``step`` is held back while it is absent or old. Written: a message, a list, or a dict by vehicle.
    """
    return _read(Input(of))


def every(of: Topic[Any]) -> Any:
    """Declares a topic of which all messages since the last step are read, oldest first (maybe none), while it is fresh."""
    return _read(Input(of, every=True))


def optional(of: Any) -> Any:
    """Makes an input optional: None (or an empty list) while absent or stale, instead of holding the step back."""
    return _read(replace(_input(of), required=False))


def each_vehicle(of: Any) -> Any:
    """Reads an input of each vehicle: a dict of those whose message is fresh; never holds the step back."""
    return _read(replace(_input(of), each_vehicle=True, required=False))


def of_role(role: str, of: Any) -> Any:
    """Reads an input of the vehicle that the mission binds to ``role`` (``leader: milvus1``)."""
    return _read(replace(_input(of), role=role))


def frames(team: bool = False) -> Any:
    """Declares the transforms told before the step, of this vehicle (``team``: of each), as a FrameBuffer; never holds the step back."""
    return _field(Frames(team))


def stop_all() -> Any:
    """Declares as input who engages STOP ALL, by every word that was said before the step; never holds the step back."""
    return _field(StopInput())


def request(of: Request[Any, Any]) -> Any:
    """Declares requests that are due, to be answered in this step by ``replies`` of the same name, in their order."""
    return _field(Served(of), [])


def replies(of: Request[Any, Any]) -> Any:
    """Declares the replies: one, or ``Later``, to each request of the same name."""
    return _field(Served(of), [])


def call(of: Request[Any, Any]) -> Any:
    """Declares requests to send: one, a list, or a dict by vehicle; their answers come to later steps."""
    return _field(Called(of), [])


def answers(of: Request[Any, Any]) -> Any:
    """Declares the answers to requests that this service has sent under the same name."""
    return _field(Called(of), [])


@dataclass_transform(kw_only_default=True)
class Reads:
    """Base of what a step reads."""

    def __init_subclass__(cls) -> None:
        dataclass(kw_only=True, eq=False)(cls)


@dataclass_transform(kw_only_default=True)
class Writes:
    """Base of what a step writes; outputs that are None or empty are not sent."""

    names: ClassVar[tuple[str, ...]] = ()

    def __init_subclass__(cls) -> None:
        dataclass(kw_only=True, eq=False)(cls)
        cls.names = tuple(declared_in(cls))

    def update(self, values: Mapping[str, Any]) -> None:
        """Sets outputs by their names. Raises AttributeError for one that is not declared."""
        for name, value in values.items():
            getattr(self, name)
            setattr(self, name, value)

    def add(self, name: str, vehicle: str, value: Value) -> None:
        """Sets the output of one vehicle, for a service of the whole world that names its outputs by data: sensors, requests."""
        by_vehicle = getattr(self, name)
        if not by_vehicle:
            by_vehicle = {}
            setattr(self, name, by_vehicle)
        by_vehicle[vehicle] = value

    def said(self) -> Iterator[tuple[str, Value]]:
        """Name and value of each output that is sent."""
        for name in self.names:
            value = getattr(self, name)
            if value is not None and not (isinstance(value, list | tuple | dict) and not value):
                yield name, value


def declared_in(owner: type) -> dict[str, Declared]:
    """Declaration of every field of ``Inputs`` or ``Outputs``, by its name."""
    return {f.name: f.metadata[DECLARED] for f in fields(owner)} if hasattr(owner, "__dataclass_fields__") else {}
