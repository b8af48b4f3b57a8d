"""Two small services on one bus: what a step may read, and that stale inputs hold it back."""

from schemas import topics
from schemas.messages import ArmRequest, DriveCommand, Reply, WheelCommand
from uvf.runtime.contract.declaration import Reads, Writes, answers, call, replies, request, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Answer, Service
from uvf.runtime.messages.convert import stamp
from uvf.runtime.time.lockstep import Lockstep


class Source(Service):
    name = "source"
    hz = 10.0

    class Inputs(Reads):
        arm: list[Answer[ArmRequest, Reply]] = answers(topics.ARM)

    class Outputs(Writes):
        drive: DriveCommand | None = topic(topics.DRIVE.by("test"))
        arm: list[ArmRequest] = call(topics.ARM)

    def __init__(self):
        self.answers = []

    def step(self, t: float, now: Inputs) -> Outputs:
        self.answers += [(round(t, 3), a.reply.reason) for a in now.arm]
        return self.Outputs(drive=DriveCommand(timestamp=stamp(t), linear=t), arm=[ArmRequest(arm=True)] if t < 0.15 else [])


class Sink(Service):
    name = "sink"
    hz = 20.0

    class Inputs(Reads):
        drive: DriveCommand = topic(topics.DRIVE.by("test"))
        arm: list[ArmRequest] = request(topics.ARM)

    class Outputs(Writes):
        wheels: WheelCommand | None = topic(topics.WHEEL_COMMAND)
        arm: list[Reply] = replies(topics.ARM)

    def __init__(self):
        self.seen = []
        self.held = []

    def step(self, t: float, now: Inputs) -> Outputs:
        self.seen.append((round(t, 3), now.drive.linear))
        return self.Outputs(wheels=WheelCommand(left=now.drive.linear), arm=[Reply(accepted=True, reason="here") for _ in now.arm])

    def stale(self, t, missing):
        self.held.append((round(t, 3), missing))
        return self.Outputs()


def run(until):
    source, sink = Source(), Sink()
    lockstep = Lockstep([ServiceInstance(Source, lambda: source, "v"), ServiceInstance(Sink, lambda: sink, "v")])
    lockstep.run(until)
    return source, sink


def test_an_output_is_read_only_by_later_steps():
    _, sink = run(0.35)
    assert sink.seen == [(0.15, 0.1), (0.2, 0.1), (0.25, 0.2), (0.3, 0.2), (0.35, 0.3)]


def test_the_step_is_held_back_until_inputs_are_there():
    _, sink = run(0.35)
    assert sink.held == [(0.05, ("drive",)), (0.1, ("drive",))]


def test_a_request_is_answered_at_the_end_of_the_next_step():
    source, _ = run(0.35)
    assert source.answers == [(0.2, "here")]
