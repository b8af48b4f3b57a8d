"""Mode Offboard: setpoints from outside, by topic."""

import math

import pytest

from schemas import topics
from schemas.messages import AttitudeSetpoint, CircleSetpoint, CourseSetpoint, FlightSetpoint, LineSetpoint, Mode, ModeRequest
from services.autopilot.air.modes.offboard import OffboardMode, fresh
from services.autopilot.air.service import AutopilotAir
from services.autopilot.air.setpoints import FlightContext
from tests.services.autopilot.air.sensing import Bench, autopilot, sensors
from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.messages.convert import stamp

OFFBOARD = [ModeRequest(mode=Mode.MODE_OFFBOARD, source="test")]


def attitude(t=1.0, bank=0.2):
    return FlightSetpoint(timestamp=stamp(t), attitude=AttitudeSetpoint(bank=bank, pitch=0.1, throttle=0.7))


def asked(message, **now):
    return OffboardMode(FlightContext(setpoint=message)).step(cruising(**now), PARAMS, 0.02).asked


def test_an_attitude_is_held_within_the_limits():
    held = asked(attitude(bank=3.0))
    assert (held.bank, held.pitch, held.throttle) == (PARAMS.bank_limit, 0.1, 0.7)


def test_a_course_is_held_with_altitude_and_airspeed():
    held = asked(FlightSetpoint(course=CourseSetpoint(course=1.0, altitude=90.0)))
    assert (held.aim.course, held.height, held.airspeed) == (1.0, 90.0, PARAMS.trim_airspeed)


def test_a_line_is_followed_with_its_slope():
    line = LineSetpoint(airspeed=22.0)
    line.origin.z, line.direction.y, line.direction.z = 50.0, 2.0, 0.2
    held = asked(FlightSetpoint(line=line), north=100.0, east=7.0)
    assert (held.aim.error, held.aim.course, held.height, held.climb) == pytest.approx((7.0, 0.0, 60.0, 2.5))


def test_a_circle_is_followed():
    circle = CircleSetpoint(radius=-100.0)
    circle.centre.z = 80.0
    held = asked(FlightSetpoint(circle=circle), north=110.0)
    assert (held.aim.error, held.height) == pytest.approx((10.0, 80.0))
    assert held.aim.course == pytest.approx(-math.pi / 2)


@pytest.mark.parametrize(("age", "counts"), [(0.0, True), (0.5, True), (0.53, False), (-0.1, False)])
def test_only_what_is_fresh_counts(age, counts):
    assert (fresh(1.0, attitude(1.0 - age)) is not None) is counts


def test_what_is_no_setpoint_does_not_count():
    assert fresh(1.0, FlightSetpoint(timestamp=stamp(1.0))) is None
    assert fresh(1.0, attitude(bank=math.nan)) is None
    assert fresh(1.0, FlightSetpoint(timestamp=stamp(1.0), line=LineSetpoint())) is None
    for x, z in ((1e-300, 1e11), (0.0, 1.0), (1.0, 11.0), (-1e-9, 0.0)):
        steep = LineSetpoint()
        steep.direction.x, steep.direction.z = x, z
        assert fresh(1.0, FlightSetpoint(timestamp=stamp(1.0), line=steep)) is None
    assert fresh(1.0, FlightSetpoint(timestamp=stamp(1.0), circle=CircleSetpoint())) is None


def test_without_a_setpoint_the_mode_is_refused_and_left():
    bench = Bench()
    bench.run(cycles=10)
    assert "no program sends setpoints" in bench.run(mode=OFFBOARD)["mode"][0].reason
    bench.run(setpoint_client=attitude(bench.n * 0.02))
    assert bench.run(setpoint_client=attitude(bench.n * 0.02), mode=OFFBOARD)["mode"][0].accepted
    last = attitude(bench.n * 0.02)
    bench.run(cycles=24, setpoint_client=last)
    assert bench.status.mode == Mode.MODE_OFFBOARD
    bench.run(cycles=4, setpoint_client=last)
    assert (bench.status.mode, bench.status.reason) == (Mode.MODE_HOLD, "no setpoint for 0.5 s")


class Senders:
    """A bench in Offboard, flown by ``client``; ``fly`` lets sources send banks at 50 Hz, each its own."""

    BANKS = {"offboard": 0.3, "client": 0.2, "mavlink": -0.2}

    def __init__(self, first="client"):
        self.bench = Bench()
        self.bench.run(cycles=10)
        self.fly(0.1, first)
        assert self.fly(0.02, first, mode=OFFBOARD)["mode"][0].accepted

    def fly(self, seconds, *sources, **asked):
        for _ in range(round(seconds * 50)):
            now = self.bench.n * 0.02
            out = self.bench.run(**{f"setpoint_{s}": attitude(now, self.BANKS[s]) for s in sources}, **asked)
            asked = {}
        return out

    @property
    def bank(self):
        return self.bench.service._mode_manager.context.setpoint.attitude.bank

    @property
    def texts(self):
        return [text for text in self.bench.texts if "setpoints" in text]


@pytest.mark.parametrize(("first", "second"), [("client", "mavlink"), ("mavlink", "client")])
def test_of_two_equal_senders_the_one_that_holds_is_followed_without_a_break(first, second):
    senders = Senders(first)
    for _ in range(100):
        senders.fly(0.02, first, second)
        assert senders.bank == Senders.BANKS[first]
    status = senders.bench.status
    assert (status.command_source, status.mode) == (first, Mode.MODE_OFFBOARD)
    assert status.reason == f"asked by test; setpoints from {first}, those of {second} wait"
    assert senders.texts == [f"setpoints of {second} wait"]


def test_when_the_holder_falls_silent_the_other_one_takes_over_after_half_a_second():
    senders = Senders("client")
    last = attitude(senders.bench.n * 0.02, 0.2)
    for _ in range(24):
        senders.fly(0.02, "mavlink", setpoint_client=last)
        assert senders.bank == 0.2
    senders.fly(0.08, "mavlink", setpoint_client=last)
    assert senders.bank == -0.2 and senders.bench.status.command_source == "mavlink"
    assert "setpoints from mavlink, no longer from client" in senders.texts
    senders.fly(1.0, "mavlink", "client")
    assert senders.bank == -0.2, "who comes back waits"


def test_a_program_on_board_comes_first_and_gives_back():
    senders = Senders("mavlink")
    senders.fly(0.1, "mavlink", "offboard")
    assert (senders.bank, senders.bench.status.command_source) == (0.3, "offboard")
    senders.fly(0.2, "mavlink")
    assert senders.bank == -0.2 and senders.bench.status.mode == Mode.MODE_OFFBOARD


def test_one_that_comes_and_goes_all_the_time_is_told_of_once():
    senders = Senders("mavlink")
    for _ in range(10):
        senders.fly(0.2, "mavlink", "offboard")
        senders.fly(0.2, "mavlink")
    assert len(senders.texts) == len(set(senders.texts)) <= 3


def test_one_sender_alone_is_told_of_as_before():
    senders = Senders("client")
    senders.fly(1.0, "client")
    assert senders.texts == [] and senders.bench.status.reason == "asked by test"


def test_a_broken_setpoint_of_the_holder_lets_the_next_one_fly():
    senders = Senders("client")
    now = senders.bench.n * 0.02
    senders.bench.run(setpoint_client=FlightSetpoint(timestamp=stamp(now)), setpoint_mavlink=attitude(now, -0.2))
    assert senders.bank == -0.2


class OnBus:
    """The autopilot on a bus, where whoever knows a key may write to it; ``banks`` are those that were followed."""

    def __init__(self):
        self.bus, self.banks, self.status = LocalBus(), [], None
        self.shell = ServiceRunner(ServiceInstance(AutopilotAir, autopilot, "milvus"), self.bus)
        self.bus.subscribe(topics.STATUS.at("milvus"), topics.STATUS.qos, self._see)

    def _see(self, sample):
        self.status = topics.STATUS.message.FromString(sample.payload)

    def _put(self, topic, message, t):
        self.bus.deliver(topic.at("milvus"), message.DESCRIPTOR.full_name, topic.qos, message.SerializeToString(), round(t * 1e9))

    def run(self, seconds, *said):
        """said: (source, bank, how far its clock is ahead [s])."""
        for _ in range(round(seconds * 50)):
            t = self.shell.due_ns * 1e-9
            told = sensors(t - 0.01)
            for imu in told["imu"]:
                self._put(topics.IMU, imu, t - 0.01)
            self._put(topics.AIR_DATA, told["air_data"], t - 0.01)
            self._put(topics.GNSS, told["gnss"], t - 0.01)
            for source, bank, ahead in said:
                self._put(topics.SETPOINT.by(source), attitude(t - 0.01 + ahead, bank), t - 0.01)
            self.shell.advance()
            setpoint = self.shell.service._mode_manager.context.setpoint
            self.banks.append(setpoint.attitude.bank if setpoint is not None else None)

    def ask_offboard(self):
        replies = []
        payload, reply_of = OFFBOARD[0].SerializeToString(), topics.SET_MODE.reply.FromString
        self.bus.call(topics.SET_MODE.at("milvus"), payload, 0, lambda reply, why, at: replies.append(reply_of(reply)))
        return replies


def test_two_senders_on_the_bus_do_not_alternate():
    on_bus = OnBus()
    on_bus.run(0.5, ("mavlink", -0.2, 0.0))
    accepted = on_bus.ask_offboard()
    on_bus.run(0.1, ("mavlink", -0.2, 0.0))
    assert accepted[0].accepted
    on_bus.banks.clear()
    for _ in range(50):
        on_bus.run(0.02, ("mavlink", -0.2, 0.0))
        on_bus.run(0.02, ("client", 0.2, 0.0))
    assert set(on_bus.banks) == {-0.2}
    on_bus.run(0.2, ("mavlink", -0.2, 0.0), ("client", 0.5, 1000.0))
    assert (on_bus.status.command_source, on_bus.status.mode) == ("mavlink", Mode.MODE_OFFBOARD)


def test_a_sender_under_another_key_is_not_heard_and_deafens_nobody():
    on_bus = OnBus()
    on_bus.run(0.5, ("evil", 0.7, 0.0))
    refused = on_bus.ask_offboard()
    on_bus.run(0.1, ("evil", 0.7, 0.0))
    assert refused[0].reason.startswith("no program sends setpoints: they have to come before this mode, as client")
    on_bus.run(0.1, ("evil", 0.7, 1000.0), ("client", 0.2, 0.0))
    assert on_bus.banks[-1] == 0.2
