"""A request whose answer only a later step knows stays open until then, and no longer."""

from collections import deque

import pytest

from schemas import topics
from schemas.limits import TEXT
from schemas.messages import ArmRequest, Reply
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.bus.wire import decode
from uvf.runtime.contract.declaration import Reads, Writes, replies, request
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Later, Service
from uvf.runtime.contract.service_runner import ServiceRunner


class Slow(Service):
    """Answers each request three steps after it has come, one to disarm at once; one with a source twice as long."""

    name = "slow"
    hz = 10.0

    class Inputs(Reads):
        arm: list[ArmRequest] = request(topics.ARM)

    class Outputs(Writes):
        arm: list[Reply] = replies(topics.ARM)

    def __init__(self):
        self.waiting = deque()
        self.n = 0

    def step(self, t: float, now: Inputs) -> Outputs:
        self.n += 1
        while self.waiting and self.waiting[0][0] <= self.n:
            self.waiting.popleft()[1].give(Reply(accepted=True, reason=f"step {self.n}"))
        replies = []
        for asked in now.arm:
            later = Later()
            if asked.source:
                later.give(Reply(reason=asked.source * 2))
            elif asked.arm:
                self.waiting.append((self.n + 3, later))
            else:
                later.give(Reply(accepted=False, reason="at once"))
            replies.append(later)
        return self.Outputs(arm=replies)


@pytest.fixture
def bus():
    return LocalBus()


@pytest.fixture
def shell(bus):
    return ServiceRunner(ServiceInstance(Slow, Slow, "alpha"), bus)


def ask(bus, arm, source=""):
    got = []
    request = ArmRequest(arm=arm, source=source)
    bus.call(topics.ARM.at("alpha"), request.SerializeToString(), 0, lambda reply, why, at: got.append((reply, why)))
    return got


def test_the_answer_comes_with_the_step_that_knows_it(bus, shell):
    got, at_once = ask(bus, True), ask(bus, False)
    shell.advance()
    assert not got and Reply.FromString(at_once[0][0]).reason == "at once"
    shell.advance()
    shell.advance()
    assert not got
    shell.advance()
    shell.advance()
    assert [Reply.FromString(reply).reason for reply, _ in got] == ["step 4"]


def test_the_first_answer_counts():
    later = Later()
    later.give(Reply(reason="first"))
    later.give(Reply(reason="second"))
    assert later.reply.reason == "first"


def test_when_time_starts_over_what_is_open_is_refused(bus, shell):
    got = ask(bus, True)
    shell.advance()
    shell.restart(2)
    assert got[0][0] is None and "time has started over" in got[0][1]


def test_a_reason_longer_than_a_message_may_hold_is_cut_and_arrives(bus, shell):
    got = ask(bus, True, "z" * (TEXT - 10))
    shell.advance()
    reply = decode("reply", got[0][0], Reply)
    assert len(reply.reason) == TEXT and reply.reason.endswith("zz…")
