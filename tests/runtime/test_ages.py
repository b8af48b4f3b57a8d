"""Point 5: age counts in the topic's own periods, ten make it stale; latched and event topics never; actuators after 0.5 s."""

import pytest

from schemas import topics
from schemas.messages import Event, FrameTransform, Imu, Mission, SurfaceCommand, VehicleStatus, WheelCommand
from tests.runtime.modes import RUNS
from tests.runtime.toys import Cast
from uvf.runtime.bus.interface import Sample
from uvf.runtime.contract.declaration import Input, Reads, Writes, each_vehicle, every, optional, topic
from uvf.runtime.contract.inbox import OWNERS_MOST, InputBox
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import stamp

SILENT = 0.30  # s, when the last message of each stream is sent
ONCE = 0.10  # s, when the latched one and the event are sent
UNTIL = 1.6  # s
LATE = 0.25  # s, how late a live step may come on a busy machine
MAX_AGE = {"imu": 0.1, "map_frame": 1.0, "wheels": 0.5, "surfaces": 0.5}  # s: 10 periods of 100 Hz and 10 Hz; actuators of 50 Hz


class Beacon(Service):
    """Sends everything at 100 Hz, then falls silent."""

    name = "beacon"
    hz = 100.0
    simulator = True

    class Outputs(Writes):
        imu: Imu | None = topic(topics.IMU)
        map_frame: FrameTransform | None = topic(topics.TF_MAP)
        wheels: WheelCommand | None = topic(topics.WHEEL_COMMAND)
        surfaces: SurfaceCommand | None = topic(topics.SURFACE_COMMAND)
        plan: Mission | None = topic(topics.MISSION)
        event: Event | None = topic(topics.EVENTS.by("beacon"))

    def step(self, t: float, now) -> Outputs:
        if t > SILENT:
            return self.Outputs()
        at = stamp(t)
        out = self.Outputs(imu=Imu(timestamp=at), map_frame=FrameTransform(timestamp=at))
        out.wheels, out.surfaces = WheelCommand(timestamp=at), SurfaceCommand(timestamp=at)
        if t == ONCE:
            out.plan, out.event = Mission(timestamp=at, id=7), Event(timestamp=at, text="once")
        return out


class Judge(Service):
    """Notes when it is handed what."""

    name = "judge"
    hz = 100.0

    class Inputs(Reads):
        imu: Imu | None = optional(topics.IMU)
        map_frame: FrameTransform | None = optional(topics.TF_MAP)
        wheels: dict[str, WheelCommand] = each_vehicle(topics.WHEEL_COMMAND)
        surfaces: SurfaceCommand | None = optional(topics.SURFACE_COMMAND)
        plan: Mission | None = optional(topics.MISSION)
        event: Event | None = optional(topics.EVENTS.by("beacon"))
        heard: list[Event] = optional(every(topics.EVENTS.by("beacon")))

    def __init__(self):
        self.times = []
        self.seen = {name: [] for name in self.inputs}

    def step(self, t: float, now: Inputs):
        self.times.append(t)
        for name in self.inputs:
            if getattr(now, name):
                self.seen[name].append(t)
        return self.Outputs()


class Guarded(Service):
    """Needs the 100 Hz stream, and says when it was held back."""

    name = "guarded"
    hz = 100.0

    class Inputs(Reads):
        imu: Imu = topic(topics.IMU)
        plan: Mission = topic(topics.MISSION)

    def __init__(self):
        self.times = []
        self.held = []

    def step(self, t: float, now: Inputs):
        self.times.append(t)
        return self.Outputs()

    def stale(self, t, missing):
        self.held.append((t, missing))
        return self.Outputs()


class Ages(Cast):
    simulators = ("beacon",)

    def processes(self):
        return {"beacon": [self.host(Beacon, "alpha")], "judge": [self.host(Judge, "alpha"), self.host(Guarded, "alpha")]}


@pytest.fixture(scope="module", params=RUNS)
def run(request):
    with RUNS[request.param](Ages()) as made:
        made.run(UNTIL)
    return made


def judge(run):
    return run.toys.one("judge.alpha")


@pytest.mark.parametrize("name", MAX_AGE)
def test_a_stream_counts_for_ten_of_its_own_periods_and_an_actuator_for_half_a_second(run, name):
    seen = judge(run).seen[name]
    end = SILENT + MAX_AGE[name]
    assert seen == [t for t in judge(run).times if seen[0] <= t <= end + 1e-9]
    assert end - (0.0 if run.lockstep else LATE) - 1e-9 <= seen[-1] <= end + 1e-9


@pytest.mark.parametrize("name", ["plan", "event"])
def test_what_is_latched_and_what_has_happened_never_goes_stale(run, name):
    times = judge(run).times
    assert judge(run).seen[name] == times[times.index(judge(run).seen[name][0]) :]
    assert ONCE < judge(run).seen[name][0] < ONCE + LATE
    assert UNTIL - (0.0 if run.lockstep else LATE) - 1e-9 <= times[-1] <= UNTIL + 1e-9


def test_an_event_is_handed_over_once_to_those_who_take_every_one(run):
    assert len(judge(run).seen["heard"]) == 1


def test_a_required_stream_that_went_stale_holds_the_step_back_and_names_itself(run):
    guarded = run.toys.one("guarded.alpha")
    assert guarded.times
    assert max(guarded.times) <= SILENT + MAX_AGE["imu"] + 1e-9
    after = [missing for t, missing in guarded.held if t > SILENT + MAX_AGE["imu"] + 1e-9]
    assert after and set(after) == {("imu",)}


def status(n, stamp_ns, boot, epoch=1):
    message = VehicleStatus(waypoint=n)
    return Sample(topics.STATUS.at("burger"), "uvf.v1.VehicleStatus", message.SerializeToString(), stamp_ns, n, boot, epoch)


def heard(box, t_ns):
    box.take(t_ns)
    return box.value(t_ns).waypoint


def test_one_stamp_from_far_ahead_does_not_deafen_who_lives_on_wall_time():
    box = InputBox(Input(topics.STATUS, required=False), ageless=True, epoch=1)
    box.push(status(1, 10, boot=1))
    box.push(status(2, 2**62, boot=9))
    box.take(0)
    box.push(status(3, 20, boot=1))
    assert heard(box, 0) == 3
    box.push(status(4, 15, boot=1))
    assert heard(box, 0) == 3, "what comes late is still overtaken"


def test_who_has_no_epoch_is_of_the_one_that_holds():
    box = InputBox(Input(topics.STATUS, required=False), ageless=False, epoch=1)
    box.push(status(1, 10, boot=1))
    assert heard(box, 20) == 1
    box.push(status(2, 30, boot=1, epoch=0))
    assert heard(box, 40) == 2


def named(owner, stamp_ns):
    return Sample(topics.STATUS.at(owner), "uvf.v1.VehicleStatus", VehicleStatus().SerializeToString(), stamp_ns, 1, 1, 1)


def test_ghosts_that_have_fallen_silent_make_room_for_another_vehicle():
    box = InputBox(Input(topics.STATUS, each_vehicle=True, required=False), ageless=False, epoch=1)
    for n in range(OWNERS_MOST):
        box.push(named(f"ghost{n}", 10))
    box.take(1_000_000_000)
    box.push(named("late", 1_000_000_000))
    assert "of more than 128 vehicles" in box.malformed()[0]
    box.take(70_000_000_000)
    box.push(named("late", 70_000_000_000))
    box.take(70_100_000_000)
    assert list(box.value(70_100_000_000)) == ["late"] and box.malformed() == []
