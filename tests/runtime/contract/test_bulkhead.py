"""What goes wrong in the instance of one vehicle stays there: it is made afresh, or given up and made safe; nobody else notices."""

import math
import signal
import time
from contextlib import closing

import pytest

from schemas import topics
from schemas.messages import ArmRequest, Battery, Event, Imu, NavStatus, ParamRequest, Reply, Vector3, WheelCommand
from tests.runtime.toys import Pilot
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.contract.bulkhead import Bulkhead
from uvf.runtime.contract.declaration import Reads, Writes, every, optional, replies, request, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.messages.convert import stamp
from uvf.runtime.messages.validation import error_in
from uvf.runtime.process.watchdog import StepHangs, Watchdog, time_limit
from uvf.runtime.time.lockstep import Lockstep

VEHICLES = ("alpha", "beta", "gamma")
BAD = 666.0


class Plant(Service):
    """Feeds all vehicles the same."""

    name = "plant"
    hz = 100.0
    scope = "world"
    simulator = True

    class Outputs(Writes):
        imu: dict[str, Imu] | None = topic(topics.IMU)

    def step(self, t: float, now) -> Outputs:
        return self.Outputs(imu={name: Imu(timestamp=stamp(t), specific_force=Vector3(x=t)) for name in VEHICLES})


class Driver(Service):
    """Counts, keeps its count, and fails where it is told to."""

    name = "driver"
    hz = 50.0

    class Inputs(Reads):
        imu: list[Imu] = every(topics.IMU)
        battery: Battery | None = optional(topics.BATTERY)
        arm: list[ArmRequest] = request(topics.ARM)

    class Outputs(Writes):
        wheels: WheelCommand | None = topic(topics.WHEEL_COMMAND)
        kept: NavStatus | None = topic(topics.NAV_STATUS)
        arm: list[Reply] = replies(topics.ARM)

    class Recalls(Reads):
        kept: None = topic(topics.NAV_STATUS)

    given_up = "its wheels stand"
    fails = staticmethod(lambda vehicle, t, battery: False)
    made = []

    def __init__(self, vehicle):
        self.vehicle, self.count, self.times = vehicle, 0, []
        type(self).made.append(self)

    def step(self, t: float, now: Inputs) -> Outputs:
        if type(self).fails(self.vehicle, t, now.battery):
            raise ZeroDivisionError("division by\nzero")
        self.count += 1
        self.times.append(t)
        wheels = WheelCommand(timestamp=stamp(t), left=sum(i.specific_force.x for i in now.imu), right=self.count)
        return self.Outputs(wheels=wheels, kept=NavStatus(distance_left=self.count), arm=[Reply(accepted=True) for _ in now.arm])

    def recall(self, left: Recalls) -> None:
        self.count = round(left.kept.distance_left)

    @staticmethod
    def stand_in(t, reason):
        return {"wheels": WheelCommand(timestamp=stamp(t))}


@pytest.fixture
def run(monkeypatch):
    monkeypatch.setattr(Driver, "made", [])

    def go(fails=lambda vehicle, t, battery: False, until=2.0, at=lambda lockstep: None):
        monkeypatch.setattr(Driver, "fails", staticmethod(fails))
        return Run(until, at)

    return go


class Run:
    def __init__(self, until, at):
        self.bus, self.events, self.warnings, self.replies = LocalBus(), [], [], []
        self.wheels = {name: [] for name in VEHICLES}
        for name in VEHICLES:
            self.bus.subscribe(topics.WHEEL_COMMAND.at(name), topics.WHEEL_COMMAND.qos, lambda s, n=name: self.wheels[n].append(s.payload))
        self.bus.subscribe("uvf/*/state/events/driver", topics.EVENTS.qos, lambda s: self.events.append(Event.FromString(s.payload)))
        hosts = [ServiceInstance(Plant, Plant)] + [ServiceInstance(Driver, lambda n=name: Driver(n), name) for name in VEHICLES]
        self.lockstep = Lockstep(hosts, self.bus, self.warnings.append, contains=True)
        self.lockstep.run(until, lambda t: at(self) or True)

    def ask(self, vehicle):
        self.bus.call(topics.ARM.at(vehicle), ArmRequest(arm=True).SerializeToString(), 0, lambda *reply: self.replies.append(reply))


def test_one_failure_is_an_event_with_its_cause_and_the_instance_goes_on_from_its_kept_state(run):
    ran = run(lambda vehicle, t, battery: vehicle == "beta" and round(t, 3) == 1.0)
    (event,) = ran.events
    assert (event.severity, event.source) == (Event.ERROR, "driver")
    assert event.text == "driver of beta has failed and was started afresh"
    assert event.cause.startswith("ZeroDivisionError: division by zero (test_bulkhead.py:") and event.cause.endswith(" in step)")
    assert any(event.cause in line for line in ran.warnings)
    old, new = (made for made in Driver.made if made.vehicle == "beta")
    assert old.times[-1] == pytest.approx(0.98) and new.times[0] == pytest.approx(1.02)
    assert new.count == 99  # of 100 steps


@pytest.mark.parametrize(
    "when", [lambda t: True, lambda t: t > 1.0, lambda t: round(t, 3) in (0.5, 0.7, 0.9)], ids=("always", "later", "thrice")
)
def test_the_third_failure_in_half_a_minute_gives_it_up_and_the_others_send_the_same_bytes(run, when):
    sound = run()
    ran = run(lambda vehicle, t, battery: vehicle == "beta" and when(t))
    assert [e.severity for e in ran.events] == [Event.ERROR, Event.ERROR, Event.CRITICAL]
    assert ran.events[-1].text == "driver of beta has failed 3 times within 30 s and is given up: its wheels stand"
    last = WheelCommand.FromString(ran.wheels["beta"][-1])
    assert (last.left, last.right, last.timestamp.seconds) == (0.0, 0.0, 2)
    assert (ran.wheels["alpha"], ran.wheels["gamma"]) == (sound.wheels["alpha"], sound.wheels["gamma"])


def test_failures_far_apart_never_give_it_up():
    bulkhead = Bulkhead()
    assert not any(bulkhead.failed(20.0 * n, "x") for n in range(100))


def test_what_made_it_fail_is_not_handed_to_it_again(run):
    """A message that nothing at the border could know to be bad: the one before it counts again."""

    def poison(ran):
        if ran.lockstep._tick == 100:
            ran.bus.deliver(topics.BATTERY.at("alpha"), "uvf.v1.Battery", topics.BATTERY.qos, Battery(voltage=BAD).SerializeToString(), 0)

    ran = run(lambda vehicle, t, battery: battery is not None and battery.voltage == BAD, at=poison)
    assert len(ran.events) == 1


def test_requests_in_hand_and_to_come_are_refused_with_the_reason(run):
    ran = run(lambda vehicle, t, battery: vehicle == "alpha" and t > 0.5, at=lambda ran: ran.ask("alpha"))
    refused = [reason for reply, reason, _ in ran.replies if reply is None]
    assert "driver of alpha has failed: ZeroDivisionError" in refused[0]
    given_up = Reply.FromString(next(reply for reply, *_ in reversed(ran.replies) if reply is not None))
    assert not given_up.accepted and "was given up: ZeroDivisionError" in given_up.reason


@pytest.mark.parametrize("where", ["__init__", "recall", "close"])
def test_neither_its_end_nor_its_beginning_harms_the_others(run, monkeypatch, where):
    sound = run()
    broken = getattr(Driver, where)
    failed = []

    def fails(self, *args, **kwargs):
        if failed and (where == "__init__" or self.vehicle == "beta"):
            raise OSError("no more")
        broken(self, *args, **kwargs)

    monkeypatch.setattr(Driver, where, fails)
    ran = run(lambda vehicle, t, battery: vehicle == "beta" and t > 1.0 and not failed.append(t))
    assert ran.events[-1].severity == Event.CRITICAL
    assert any("no more" in event.cause for event in ran.events)
    assert (ran.wheels["alpha"], ran.wheels["gamma"]) == (sound.wheels["alpha"], sound.wheels["gamma"])


@pytest.fixture
def watchdog(monkeypatch):
    """Impatient: 0.1 s of processor time."""
    monkeypatch.setattr("uvf.runtime.process.watchdog.SHORTEST", 0.1)
    monkeypatch.setattr("uvf.runtime.process.watchdog.PERIODS", 1)
    monkeypatch.setattr("uvf.runtime.process.watchdog.LOOK", 0.02)
    with closing(Watchdog()) as made:
        yield made


def test_a_step_that_never_comes_back_is_ended_and_the_others_go_on(monkeypatch, watchdog):
    def hangs(self, t, now):
        while self.vehicle == "beta":
            pass
        return step(self, t, now)

    step = Driver.step
    monkeypatch.setattr(Driver, "step", hangs)
    monkeypatch.setattr(Driver, "made", [])
    bus, events = LocalBus(), []
    bus.subscribe("uvf/*/state/events/driver", topics.EVENTS.qos, lambda s: events.append(Event.FromString(s.payload)))
    hosts = [ServiceInstance(Plant, Plant)] + [ServiceInstance(Driver, lambda n=name: Driver(n), name) for name in VEHICLES]
    shells = [ServiceRunner(host, bus, contains=True, watchdog=watchdog) for host in hosts]
    while (shell := min(shells, key=lambda s: s.due_ns)).due_ns <= 1_000_000_000:
        shell.advance()
    assert [e.severity for e in events] == [Event.ERROR, Event.ERROR, Event.CRITICAL]
    assert all(e.cause.startswith("StepHangs: its step has not come back after 0.1 s of processor time (test_bulkhead.py:") for e in events)
    assert {shell.owner: shell.counters.steps for shell in shells} == {"sys": 100, "alpha": 50, "beta": 3, "gamma": 50}


def test_slow_is_not_hung(watchdog):
    """What sleeps, or waits for a processor, uses none of its time."""
    with watchdog.limited(0.1):
        time.sleep(0.3)
    with pytest.raises(StepHangs), watchdog.limited(0.1):
        while True:
            pass


def test_how_long_a_step_may_take():
    assert [time_limit(hz) for hz in (0.2, 2.0, 20.0, 50.0, 400.0)] == [6.0, 6.0, 5.0, 2.0, 2.0]


def test_a_new_epoch_tries_again(run):
    ran = run(lambda vehicle, t, battery: vehicle == "beta" and t < 1.0)
    shell = next(s for s in ran.lockstep.shells if s.owner == "beta")
    assert shell._bulkhead.given_up
    shell.restart(2)
    assert not shell._bulkhead.given_up


def test_no_signal_comes_while_no_step_is_watched(watchdog):
    """At the end of a SimpleQueue's timeout one would make CPython 3.11 wait there for ever."""
    with watchdog.limited(1.0):
        assert signal.getitimer(signal.ITIMER_REAL) != (0.0, 0.0)
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)


class Unspeakable(Exception):
    def __str__(self):
        raise ZeroDivisionError


class Panic(BaseException):
    """As of a library in another language."""


FAULTS = (SystemExit(3), Panic("lost"), ValueError("file \udcff"), Unspeakable(), ValueError("\x1b[2J" + "x" * 5000), RecursionError())


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: type(fault).__name__)
def test_whatever_is_raised_harms_nobody_else_and_can_be_told(run, fault):
    def fails(vehicle, t, battery):
        if vehicle == "beta" and round(t, 3) == 1.0:
            raise fault
        return False

    sound, ran = run(), run(fails)
    (event,) = ran.events
    assert error_in(event) == "" and event.cause.startswith(type(fault).__name__)
    assert (ran.wheels["alpha"], ran.wheels["gamma"]) == (sound.wheels["alpha"], sound.wheels["gamma"])


def test_ctrl_c_is_the_operators(run):
    def fails(vehicle, t, battery):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(fails)


def test_who_cannot_take_up_what_was_left_begins_without_it(monkeypatch):
    def fails(self, kept=None):
        raise OSError("no more")

    monkeypatch.setattr(Driver, "recall", fails)
    bus, events = LocalBus(), []
    bus.subscribe("uvf/*/state/events/driver", topics.EVENTS.qos, lambda s: events.append(Event.FromString(s.payload)))
    shell = ServiceRunner(ServiceInstance(Driver, lambda: Driver("beta"), "beta"), bus, contains=True)
    shell.recall(lambda key: NavStatus(distance_left=7.0).SerializeToString())
    assert shell.service.count == 0
    assert "it could not take up what was left: OSError: no more" in events[0].cause


def test_an_end_that_fails_when_time_starts_over_harms_nobody(monkeypatch):
    def fails(self):
        raise OSError("no more")

    shell = ServiceRunner(ServiceInstance(Driver, lambda: Driver("beta"), "beta"), LocalBus(), contains=True)
    first = shell.service
    monkeypatch.setattr(Driver, "close", fails)
    shell.restart(2)
    assert shell.service is not first and shell.counters.failures == 1


@pytest.mark.parametrize("where", ["close", "step"])
def test_what_catches_all_errors_or_hangs_at_its_end_does_not_escape_the_watchdog(monkeypatch, watchdog, where):
    def hangs(self, *args, **inputs):
        while True:
            try:
                while True:
                    pass
            except Exception:  # noqa: BLE001  # as somebody's service may
                continue

    shell = ServiceRunner(ServiceInstance(Driver, lambda: Driver("beta"), "beta"), LocalBus(), contains=True, watchdog=watchdog)
    monkeypatch.setattr(Driver, "stale", lambda self, t, missing: 1 / 0)
    monkeypatch.setattr(Driver, {"close": "close", "step": "stale"}[where], hangs)
    shell.advance()
    assert shell.counters.failures == 1


def test_what_leaves_the_actuators_without_a_number_is_a_failure_of_its_sender(run, monkeypatch):
    step = Driver.step

    def lost(self, t, now):
        out = step(self, t, now)
        if self.vehicle == "beta" and round(t, 3) == 1.0:
            out.wheels.left = math.nan
        return out

    monkeypatch.setattr(Driver, "step", lost)
    ran = run()
    assert "ContractError: uvf/beta/actuator/wheels: left: nan" in ran.events[0].cause
    assert all(math.isfinite(WheelCommand.FromString(payload).left) for payload in ran.wheels["beta"])


def test_what_was_set_while_it_ran_outlives_one_failure_and_not_two(monkeypatch):
    bus, shell = LocalBus(), None
    shell = ServiceRunner(ServiceInstance(Pilot, Pilot, "alpha"), bus, contains=True)
    request = ParamRequest(name="gain", value="7.5").SerializeToString()
    bus.call(topics.PARAM.by("pilot").at("alpha"), request, -1, lambda *reply: None)
    shell.advance()
    assert shell.service.params.gain == 7.5
    stale = Pilot.stale
    gains = []
    for fails in (True, False, True, False):
        monkeypatch.setattr(Pilot, "stale", (lambda self, t, missing: 1 / 0) if fails else stale)
        shell.advance()
        gains.append(shell.service.params.gain)
    assert gains == [7.5, 7.5, 1.0, 1.0]


def test_a_broken_request_for_a_parameter_is_counted():
    bus = LocalBus()
    shell = ServiceRunner(ServiceInstance(Pilot, Pilot, "alpha"), bus)
    bus.call(topics.PARAM.by("pilot").at("alpha"), b"\xff\xff", -1, lambda *reply: None)
    shell.advance()
    assert shell.refusals.count == 1


def test_who_cannot_be_started_afresh_is_given_up_for_that_and_not_for_the_number_of_failures(run, monkeypatch):
    made = Driver.__init__

    def breaks(self, vehicle):
        if sum(driver.vehicle == vehicle for driver in Driver.made) == 2:
            raise OSError("no more")
        made(self, vehicle)

    monkeypatch.setattr(Driver, "__init__", breaks)
    ran = run(lambda vehicle, t, battery: vehicle == "beta" and round(t, 3) in (0.5, 0.7))
    assert [e.severity for e in ran.events] == [Event.ERROR, Event.CRITICAL]
    assert ran.events[-1].text == "driver of beta cannot be started afresh and is given up: its wheels stand"
