"""Point 8: requests are queued to the next step, answered at its end and recorded; long jobs have feedback, a result and a cancel."""

import time

import pytest

from schemas import topics
from schemas.messages import ArmRequest, CancelRequest, GoalRequest, NavStatus, Reply, Vector3
from tests.runtime.modes import RUNS, free_port
from tests.runtime.toys import Cast
from uvf.runtime.bus import zenoh_bus
from uvf.runtime.contract.declaration import Reads, Writes, answers, call, optional, replies, request, topic
from uvf.runtime.contract.service import Answer, Service
from uvf.runtime.contract.service_runner import QUERIES_MOST
from uvf.runtime.messages.convert import stamp
from uvf.runtime.messages.step_times import NS, first_step_after, step_time

KEY = topics.GOAL.at("alpha")
LATE = 0.25  # s, how late a live step may come on a busy machine
HOUR = 3600.0  # s


class Ground(Service):
    """The simulator."""

    name = "ground"
    hz = 100.0
    scope = "world"
    simulator = True

    def step(self, t, now):
        return self.Outputs()


class Porter(Service):
    """A goal is carried x steps far, with feedback at each; one at a time."""

    name = "porter"
    hz = 10.0

    class Inputs(Reads):
        goal: list[GoalRequest] = request(topics.GOAL)
        cancel: list[CancelRequest] = request(topics.CANCEL)

    class Outputs(Writes):
        status: NavStatus | None = topic(topics.NAV_STATUS)
        goal: list[Reply] = replies(topics.GOAL)
        cancel: list[Reply] = replies(topics.CANCEL)

    def __init__(self):
        self.times = []
        self.asked = []
        self.left = 0
        self.state = NavStatus.IDLE

    def step(self, t: float, now: Inputs) -> Outputs:
        self.times.append(t)
        replies = [self._take(t, request) for request in now.goal]
        stopped = [Reply(accepted=self.left > 0) for _ in now.cancel]
        if now.cancel:
            self.left, self.state = 0, NavStatus.CANCELLED
        elif self.left > 0:
            self.left -= 1
            self.state = NavStatus.DRIVING if self.left else NavStatus.REACHED
        status = NavStatus(timestamp=stamp(t), state=self.state, distance_left=self.left)
        return self.Outputs(status=status, goal=replies, cancel=stopped)

    def _take(self, t, request):
        self.asked.append((t, request.source))
        self.left = round(request.position.x)
        return Reply(accepted=True, reason=f"{request.source} at {t:.6f}")


class Guest(Service):
    """Asks at times of its own and watches what comes of it."""

    name = "guest"
    hz = 50.0

    class Inputs(Reads):
        status: NavStatus | None = optional(topics.NAV_STATUS)
        goal: list[Answer[GoalRequest, Reply]] = answers(topics.GOAL)
        cancel: list[Answer[CancelRequest, Reply]] = answers(topics.CANCEL)
        arm: list[Answer[ArmRequest, Reply]] = answers(topics.ARM)

    class Outputs(Writes):
        goal: list[GoalRequest] = call(topics.GOAL)
        cancel: list[CancelRequest] = call(topics.CANCEL)
        arm: list[ArmRequest] = call(topics.ARM)

    PLAN = {
        0.26: ("goal", [GoalRequest(position=Vector3(x=20 + i), source=f"goal {i}") for i in range(3)]),
        0.30: ("arm", [ArmRequest(arm=True)]),
        0.80: ("cancel", [CancelRequest(source="guest")]),
        1.24: ("goal", [GoalRequest(position=Vector3(x=4), source="last goal")]),
    }

    def __init__(self):
        self.due = dict(self.PLAN)
        self.sent = {}
        self.answers = []
        self.states = []

    def step(self, t: float, now: Inputs) -> Outputs:
        self.answers += [(t, answer) for answer in (*now.goal, *now.cancel, *now.arm)]
        if now.status is not None and (now.status.state, now.status.distance_left) != (self.states or [None])[-1]:
            self.states.append((now.status.state, now.status.distance_left))
        due = [at for at in self.due if at <= t + 1e-9]
        asks = [self.due.pop(at) for at in due[:1]]
        self.sent |= {message.source: t for _, messages in asks for message in messages}
        out = self.Outputs()
        out.update(dict(asks))
        return out


class Errands(Cast):
    simulators = ("ground",)

    def processes(self):
        return {"ground": [self.host(Ground)], "porter": [self.host(Porter, "alpha")], "guest": [self.host(Guest, "alpha")]}


@pytest.fixture(scope="module", params=RUNS)
def run(request):
    with RUNS[request.param](Errands()) as made:
        made.run(2.3)
    return made


@pytest.fixture(params=RUNS)
def busy(request):
    with RUNS[request.param](Errands()) as made:
        made.run(2.0)
        yield made


def parts(run):
    return run.toys.one("guest.alpha"), run.toys.one("porter.alpha")


def test_a_request_is_taken_by_the_next_step_and_not_by_the_one_at_its_own_time(run):
    guest, porter = parts(run)
    assert [source for _, source in porter.asked] == ["goal 0", "goal 1", "goal 2", "last goal"]
    for t, source in porter.asked:
        asked = guest.sent[source]
        following = step_time(first_step_after(round(asked * NS), Porter.hz), Porter.hz) / NS
        assert following - 1e-9 <= t <= following + (0.0 if run.lockstep else LATE) + 1e-9


def test_each_asker_gets_the_reply_that_the_step_made_for_it(run):
    guest, porter = parts(run)
    goals = [(t, answer) for t, answer in guest.answers if isinstance(answer.request, GoalRequest)]
    made = {source: t for t, source in porter.asked}
    for t, answer in goals:
        assert answer.vehicle == "alpha"
        assert answer.reply.reason == f"{answer.request.source} at {made[answer.request.source]:.6f}"
        assert t > made[answer.request.source]
    assert {answer.request.source for _, answer in goals} == set(made)


def test_requests_and_replies_are_recorded_at_the_step_that_answered(run):
    _, porter = parts(run)
    asked, replied = (run.outcome().of(f"{KEY}/{half}") for half in ("request", "reply"))
    assert [(s.stamp_ns, GoalRequest.FromString(s.payload).source) for s in asked] == [(round(t * NS), name) for t, name in porter.asked]
    assert [(s.stamp_ns, Reply.FromString(s.payload).reason) for s in replied] == [
        (round(t * NS), f"{name} at {t:.6f}") for t, name in porter.asked
    ]
    assert [s.seq for s in asked] == [1, 2, 3, 4]
    assert len(run.outcome().of(f"{topics.CANCEL.at('alpha')}/request")) == 1


def test_a_request_that_nobody_serves_is_told_so(run):
    guest, _ = parts(run)
    (unanswered,) = [answer for _, answer in guest.answers if isinstance(answer.request, ArmRequest)]
    assert unanswered.reply is None
    assert unanswered.reason == "nobody answers uvf/alpha/srv/arm"


def test_a_long_job_gives_feedback_until_it_is_cancelled_or_has_its_result(run):
    guest, _ = parts(run)
    states = guest.states
    cancelled = states.index((NavStatus.CANCELLED, 0))
    first, second = states[:cancelled], states[cancelled + 1 :]
    driven = [left for state, left in first if state == NavStatus.DRIVING]
    assert len(driven) >= 2 and driven == sorted(driven, reverse=True)
    assert driven[0] >= 18 and driven[-1] > 0
    assert second[-1] == (NavStatus.REACHED, 0)
    assert [left for _, left in second] == sorted((left for _, left in second), reverse=True)
    (answer,) = [a for _, a in guest.answers if isinstance(a.request, CancelRequest)]
    assert answer.reply.accepted


def asked_outside(busy, stamps):
    return [busy.ask(topics.GOAL, "alpha", GoalRequest(source=str(i)), at) for i, at in enumerate(stamps)]


def wait_for(busy, answers, seconds):
    """Lets time run until all have been answered; fails when that takes longer than ``seconds`` of simulation."""
    end = busy.conductor.t_ns / NS + seconds
    while not all(answers):
        assert busy.conductor.t_ns / NS < end, f"{sum(not a for a in answers)} are not answered"
        busy.run_on(0.1)
        busy.turn()


@pytest.mark.parametrize("ahead", [HOUR, 1e9])
def test_a_request_from_a_clock_far_ahead_is_answered_as_soon_as_any(busy, ahead):
    answers = asked_outside(busy, [2.0 + ahead])
    wait_for(busy, answers, 1.0)
    assert answers[0][0][0].accepted


def test_a_request_a_little_ahead_waits_for_its_time(busy):
    answers = asked_outside(busy, [2.75])
    wait_for(busy, answers, 2.0)
    reply, _, at = answers[0][0]
    assert reply.accepted and 2.75 < at <= 2.8 + (0.0 if busy.lockstep else LATE) + 1e-9


def test_a_flood_of_requests_is_answered_or_refused_and_nothing_hangs(busy):
    porter = busy.toys.one("porter.alpha")
    answers = asked_outside(busy, [2.0] * 5000)
    wait_for(busy, answers, 4.0)
    taken = [a for a in answers if a[0][0] is not None]
    assert 1 <= len(taken) < 5000 and all(a[0][0].accepted for a in taken)
    assert {a[0][1] for a in answers if a[0][0] is None} == {f"porter: {QUERIES_MOST} requests wait already"}
    in_one_step = max(sum(1 for t, _ in porter.asked if t == step) for step in {t for t, _ in porter.asked})
    assert in_one_step <= QUERIES_MOST
    late = asked_outside(busy, [busy.conductor.t_ns / NS])
    wait_for(busy, late, 1.0)
    assert late[0][0][0].accepted


def test_a_request_that_is_not_answered_in_time_names_itself(monkeypatch):
    monkeypatch.setattr(zenoh_bus, "CALL_TIMEOUT", 0.2)
    endpoint, queries, heard = f"tcp/127.0.0.1:{free_port()}", [], []
    router = zenoh_bus.open_router(endpoint)
    with zenoh_bus.ZenohBus(endpoint) as server, zenoh_bus.ZenohBus(endpoint) as client:
        server.serve("uvf/alpha/srv/arm", queries.append)
        end = time.monotonic() + 20.0
        while not any("no answer" in reason for reason in heard):  # before the server is known: "nobody answers"
            assert time.monotonic() < end, heard
            client.call("uvf/alpha/srv/arm", b"", 0, lambda reply, reason, _: heard.append(reason))
            client.wait(0.3)
            server.poll()
            client.poll()
    router.close()
    assert heard[-1] == "no answer from uvf/alpha/srv/arm within 0.2 s"
