"""Point 11: a service that is started again takes up its work; a simulator that is raises the epoch, and all start afresh."""

import pytest

from schemas import topics
from schemas.messages import Mission, NavStatus
from tests.runtime.modes import RUNS
from tests.runtime.toys import Cast
from uvf.runtime.contract.declaration import Reads, Writes, topic
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import stamp


class World(Service):
    """The simulator."""

    name = "world"
    hz = 100.0
    scope = "world"
    simulator = True

    def __init__(self):
        self.times = []

    def step(self, t, now):
        self.times.append(t)
        return self.Outputs()


class Scribe(Service):
    """Counts its steps, as work that must not be lost, and makes a plan once."""

    name = "scribe"
    hz = 20.0

    class Outputs(Writes):
        state: NavStatus | None = topic(topics.NAV_STATUS)
        plan: Mission | None = topic(topics.MISSION)

    class Recalls(Reads):
        state: NavStatus | None = topic(topics.NAV_STATUS)
        plan: Mission | None = topic(topics.MISSION)

    def __init__(self):
        self.count = 0
        self.times = []
        self.plan = None
        self.recalled = None

    def step(self, t: float, now) -> Outputs:
        self.times.append(t)
        self.count += 1
        out = self.Outputs(state=NavStatus(timestamp=stamp(t), distance_left=self.count))
        if self.plan is None:
            self.plan = out.plan = Mission(timestamp=stamp(t), id=7)
        return out

    def recall(self, left: Recalls) -> None:
        self.recalled = (left.state, left.plan)
        self.count = round(left.state.distance_left) if left.state is not None else 0
        self.plan = left.plan


class Archive(Cast):
    simulators = ("world",)

    def processes(self):
        return {"world": [self.host(World)], "scribe": [self.host(Scribe, "alpha")]}


@pytest.fixture(params=RUNS)
def run(request):
    with RUNS[request.param](Archive()) as made:
        made.run(1.0)
        yield made


def scribes(run):
    return run.toys.made["scribe.alpha"]


def counts(run, n):
    """The counts that were published, in order of sending, once ``n`` have arrived."""
    key = topics.NAV_STATUS.at("alpha")
    for _ in range(1000):
        if len(run.outcome().of(key)) >= n:
            break
        run.turn()
    return [round(NavStatus.FromString(s.payload).distance_left) for s in run.outcome().of(key)]


def restart(run, name):
    """The process dies and comes back, as a supervisor would see to it."""
    run.end(name)
    run.start(name)


def test_a_service_that_is_started_again_goes_on_with_what_the_one_before_has_left(run):
    restart(run, "scribe")
    run.run_on(1.0)
    old, new = scribes(run)
    assert (round(new.recalled[0].distance_left), new.recalled[1]) == (old.count, old.plan)
    assert new.count == old.count + len(new.times)
    assert new.times[0] >= old.times[-1]  # the step at which it died is done again: nobody knows how far it came
    assert counts(run, new.count) == list(range(1, new.count + 1))
    assert {s.payload for s in run.outcome().of(topics.MISSION.at("alpha"))} == {old.plan.SerializeToString()}


def test_time_goes_on_in_the_same_epoch_when_a_service_is_started_again(run):
    restart(run, "scribe")
    run.run_on(0.5)
    assert run.conductor.epoch == 1
    times = run.toys.one("world").times
    assert len(run.toys.made["world"]) == 1 and times == sorted(times)


def test_a_service_that_starts_with_the_others_recalls_nothing(run):
    assert scribes(run)[0].recalled is None


def test_a_simulator_that_comes_back_raises_the_epoch_and_everybody_starts_afresh(run):
    restart(run, "world")
    while run.conductor.epoch == 1:
        run.turn()
        run.run_on(0.0)
    run.run(0.5)
    assert run.conductor.epoch == 2
    old, new = scribes(run)
    assert new.recalled is None and new.times[0] < 0.5 < old.times[-1]
    assert new.count == len(new.times) and new.plan is not old.plan
    assert run.toys.one("world").times[0] == pytest.approx(0.01)


def test_after_the_epoch_has_risen_a_service_recalls_only_what_is_of_the_new_one(run):
    restart(run, "world")
    while run.conductor.epoch == 1:
        run.turn()
        run.run_on(0.0)
    run.run(0.3)
    before = scribes(run)[-1].count
    restart(run, "scribe")
    run.run_on(0.3)
    assert round(scribes(run)[-1].recalled[0].distance_left) == before < 10


class Idle(Archive):
    """With a process that has no work in this mission, as the cameras' simulator where no vehicle has a camera."""

    def processes(self):
        return {**super().processes(), "idle": []}


@pytest.mark.parametrize("mode", [mode for mode in RUNS if mode.startswith("zenoh")])
def test_time_does_not_wait_for_a_process_without_work(mode):
    with RUNS[mode](Idle()) as made:
        made.run(0.5)
        assert made.conductor.t_ns >= 0.5e9
