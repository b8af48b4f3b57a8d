"""The contract of a service: what it reads and writes as data, and one pure function of time."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Generic, Literal, TypeVar

from google.protobuf.message import Message

from schemas import topics
from schemas.topics import Request, Topic
from uvf.models.params import Params
from uvf.runtime.messages.outputs import Outputs

Q = TypeVar("Q", bound=Message)
R = TypeVar("R", bound=Message)


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


FRAME_TOPICS = (topics.TF_STATIC, topics.TF_WORLD, topics.TF_MAP, topics.TF_ODOM, topics.TF_JOINTS, topics.TF_BODY, topics.TF_GIMBAL)
"""What the tree of frames is told on; the latched ones are static."""


@dataclass(frozen=True)
class Frames:
    """The tree of frames as one input: ``step`` is handed a ``FrameBuffer``."""

    team: bool

    def parts(self, name: str) -> dict[str, Input]:
        """The inputs that it consists of."""
        return {
            f"{name}/{topic.key}": Input(topic, every=True, required=False, each_vehicle=self.team, ages=False) for topic in FRAME_TOPICS
        }


def frames(team: bool = False) -> Frames:
    """The transforms told before the step, of this vehicle (or of every one), to be looked up; never holds the step back."""
    return Frames(team)


@dataclass(frozen=True)
class StopInput:
    """STOP ALL as one input: ``step`` is handed a ``stop_all.StopStatus``."""

    def parts(self, name: str) -> dict[str, Input]:
        """The inputs that it consists of."""
        heard: dict[str, Topic[Any]] = {"said": topics.STOP.by("*"), "known": topics.STOP_STATE}
        return {f"{name}/{part}": Input(topic, every=True, required=False, ages=False) for part, topic in heard.items()}


def stop_all() -> StopInput:
    """Who engages STOP ALL, by every word that was said before the step; never holds the step back."""
    return StopInput()


def _as_input(topic: "Topic[Any] | Input") -> Input:
    return topic if isinstance(topic, Input) else Input(topic)


def every(topic: Topic[Any]) -> Input:
    """All messages since the last step, oldest first (maybe none), while the topic is fresh."""
    return Input(topic, every=True)


def optional(topic: "Topic[Any] | Input") -> Input:
    """None (or an empty list) while absent or stale, instead of holding the step back."""
    return replace(_as_input(topic), required=False)


def each_vehicle(topic: "Topic[Any] | Input") -> Input:
    """A dict by vehicle, holding those whose message is fresh; never holds the step back."""
    return replace(_as_input(topic), each_vehicle=True, required=False)


def of_role(role: str, topic: "Topic[Any] | Input") -> Input:
    """The topic of the vehicle that the mission binds to ``role`` (``leader: milvus1``)."""
    return replace(_as_input(topic), role=role)


@dataclass(frozen=True)
class Answer(Generic[Q, R]):
    """What became of a request that this service sent: the reply, or None and why."""

    vehicle: str
    request: Q
    reply: R | None
    reason: str = ""


class Later(Generic[R]):
    """Stands in a step's replies for one that a later step will know: the request stays open until ``give`` is called."""

    reply: R | None = None

    def give(self, reply: R) -> None:
        """The first one counts."""
        self.reply = self.reply or reply


class Service:
    """One instance per vehicle (``scope = "vehicle"``) or one for the whole world (``scope = "world"``).

    ``step`` takes ``t`` [s] and one keyword argument per declared input, request and call, and returns messages by
    the declared names of outputs, requests (replies or ``Later``, in the order asked) and calls (requests to send). Its result
    depends only on the constructor's arguments, the parameters and the history of its inputs.
    """

    name: ClassVar[str]
    hz: ClassVar[float]
    scope: ClassVar[Literal["vehicle", "world"]] = "vehicle"
    clock: ClassVar[Literal["sim", "wall"]] = "sim"
    latency: ClassVar[float] = 0.0
    """Outputs are released this long [s] after the step; lockstep keeps to it, so slow work is slow there too."""
    simulator: ClassVar[bool] = False
    """Simulators report the time they have reached; the clock never runs ahead of them."""

    inputs: ClassVar[Mapping[str, Topic[Any] | Input | Frames | StopInput]] = {}
    outputs: ClassVar[Mapping[str, Topic[Any]]] = {}
    requests: ClassVar[Mapping[str, Request[Any, Any]]] = {}
    calls: ClassVar[Mapping[str, Request[Any, Any]]] = {}

    recalls: ClassVar[Mapping[str, Topic[Any]]] = {}
    """Kept topics whose newest messages ``recall`` is handed when the service is started again in a run."""

    params: Params = Params()
    fixed_params: ClassVar[frozenset[str]] = frozenset()
    """Those that are read only when the service is made; setting them while running is refused."""

    step: Any
    """``def step(self, t: float, **inputs) -> Outputs``: each service has its own signature, checked by a test."""

    recall: Any
    """``def recall(self, **messages) -> None`` where there are ``recalls``: takes up the work of an instance that has
    died, from those of its messages that were found (the others are None by default)."""

    def stale(self, t: float, missing: tuple[str, ...]) -> Outputs:
        """Called instead of ``step`` while required inputs are absent or old: the place of failsafes."""
        return {}

    given_up: ClassVar[str] = "the vehicle does without it"
    """What becomes of the vehicle when this service has failed too often, for people to read."""
    stand_in: ClassVar["staticmethod[[float, str], Outputs] | None"] = None
    """``stand_in(t, reason)`` gives the outputs of each step in place of such an instance: what brings the vehicle to its safe state.

    It knows nothing of the instance, whose state may be what is wrong. Of services without one, the others miss the outputs.
    """

    def close(self) -> None:
        """Gives back engines and sockets; called once, when the process or the run ends."""

    @classmethod
    def declared_inputs(cls) -> dict[str, Input]:
        """Every topic read, by the name of the input; ``frames()`` and ``stop_all()`` are one for each of their topics."""
        declared: dict[str, Input] = {}
        for name, asked in cls.inputs.items():
            declared |= asked.parts(name) if isinstance(asked, Frames | StopInput) else {name: _as_input(asked)}
        return declared
