"""The contract of a service: what it reads and writes as types, and one pure function of time."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Generic, Literal, TypeVar

from google.protobuf.message import Message

from schemas.topics import Request, Topic
from uvf.models.params import Params
from uvf.runtime.contract.declaration import Called, Frames, Input, Reads, Served, StopInput, Writes, declared_in
from uvf.runtime.messages.outputs import OutputMessages

Q = TypeVar("Q", bound=Message)
R = TypeVar("R", bound=Message)


@dataclass(frozen=True)
class Answer(Generic[Q, R]):
    """Outcome of a request that this service sent: the reply, or None and why."""

    vehicle: str
    request: Q
    reply: R | None
    reason: str = ""


class Later(Generic[R]):
    """A reply that a later step will know: the request stays open until ``give`` is called."""

    reply: R | None = None

    def give(self, reply: R) -> None:
        """Gives the reply; only the first one counts."""
        self.reply = self.reply or reply


class Service:
    """One instance per vehicle (``scope = "vehicle"``) or one for the whole world (``scope = "world"``).

    A subclass declares what it reads as ``class Inputs(Reads)`` and what it writes as ``class Outputs(Writes)``, and has
    ``def step(self, t: float, now: Inputs) -> Outputs``, with ``t`` in seconds. The result depends only on the constructor's
    arguments, the parameters and the history of the inputs.
    """

    name: ClassVar[str]
    hz: ClassVar[float]
    scope: ClassVar[Literal["vehicle", "world"]] = "vehicle"
    clock: ClassVar[Literal["sim", "wall"]] = "sim"
    latency: ClassVar[float] = 0.0
    """Outputs are released this long [s] after the step; lockstep keeps to it, so slow work is slow there too."""
    simulator: ClassVar[bool] = False
    """Simulators report the time they have reached; the clock never runs ahead of them."""

    Inputs: ClassVar[type[Reads]] = Reads
    Outputs: ClassVar[type[Writes]] = Writes
    Recalls: ClassVar[type[Reads]] = Reads
    """Kept topics whose newest messages ``recall`` is handed when the service is started again in a run."""

    params: Params = Params()
    fixed_params: ClassVar[frozenset[str]] = frozenset()
    """Those that are read only when the service is made; setting them while running is refused."""

    step: Any
    """``def step(self, t: float, now: Inputs) -> Outputs``: each service has types of its own."""

    recall: Any
    """``def recall(self, left: Recalls) -> None`` where there are ``Recalls``: takes up the work of an instance that has
    died, from those of its messages that were found; the others are None."""

    def stale(self, t: float, missing: tuple[str, ...]) -> Writes:
        """Outputs of a step at ``t`` [s] while required inputs are absent or old: called instead of ``step``, the place of failsafes."""
        return self.Outputs()

    given_up: ClassVar[str] = "the vehicle does without it"
    """What becomes of the vehicle when this service has failed too often, for people to read."""
    stand_in: ClassVar["staticmethod[[float, str], OutputMessages] | None"] = None
    """``stand_in(t, reason)`` gives the outputs of each step in place of such an instance: what brings the vehicle to its safe state.

    It knows nothing of the instance, whose state may be what is wrong. Of services without one, the others miss the outputs.
    """

    def close(self) -> None:
        """Frees engines and sockets; called once, when the process or the run ends."""

    inputs: ClassVar[Mapping[str, Input | Frames | StopInput]] = {}
    outputs: ClassVar[Mapping[str, Topic[Any]]] = {}
    requests: ClassVar[Mapping[str, Request[Any, Any]]] = {}
    calls: ClassVar[Mapping[str, Request[Any, Any]]] = {}
    recalls: ClassVar[Mapping[str, Topic[Any]]] = {}
    """Read off the declarations, for who runs, checks or draws services."""

    def __init_subclass__(cls) -> None:
        reads, writes = declared_in(cls.Inputs), declared_in(cls.Outputs)
        cls.inputs = {name: how for name, how in reads.items() if isinstance(how, Input | Frames | StopInput)}
        cls.outputs = {name: how.topic for name, how in writes.items() if isinstance(how, Input)}
        cls.requests = {name: how.request for name, how in reads.items() if isinstance(how, Served)}
        cls.calls = {name: how.request for name, how in writes.items() if isinstance(how, Called)}
        cls.recalls = {name: how.topic for name, how in declared_in(cls.Recalls).items() if isinstance(how, Input)}
        replied = {name: how.request for name, how in writes.items() if isinstance(how, Served)}
        answered = {name: how.request for name, how in reads.items() if isinstance(how, Called)}
        if replied != cls.requests:
            raise TypeError(f"{cls.__name__}: each request has replies of its name in Outputs, and the other way round")
        if not answered.items() <= cls.calls.items():
            raise TypeError(f"{cls.__name__}: answers are of a call of the same name in Outputs")

    @classmethod
    def declared_inputs(cls) -> dict[str, Input]:
        """Every topic read, by the name of the input; ``frames()`` and ``stop_all()`` are one for each of their topics."""
        declared: dict[str, Input] = {}
        for name, how in cls.inputs.items():
            declared |= how.parts(name) if isinstance(how, Frames | StopInput) else {name: how}
        return declared
