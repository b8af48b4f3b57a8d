"""A service that declares ``frames()``: what its buffer holds at a step, on the bus and in each epoch."""

import pytest

from schemas import topics
from schemas.messages import DriveCommand, FrameTransform, FrameTransforms, Imu, Vector3
from tests.runtime.modes import RUNS, run_in
from tests.runtime.toys import Cast
from uvf.runtime.bus.interface import LocalBus, Sample
from uvf.runtime.contract.declaration import Reads, Writes, every, frames, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.messages.convert import seconds, stamp
from uvf.runtime.messages.frames import FrameBuffer, FrameError
from uvf.runtime.time.lockstep import Lockstep

NS = 1_000_000_000


class Seeker(Service):
    """Notes where the base of its own vehicle is, now and at the time of each step."""

    name = "seeker"
    hz = 10.0

    class Inputs(Reads):
        frames: FrameBuffer = frames()

    asked = ("alpha/odom", "alpha/base_footprint")

    def __init__(self):
        self.newest, self.refused, self.known = {}, {}, set()

    def step(self, t: float, now: Inputs):
        self.known = now.frames.frames
        try:
            self.newest[t] = round(float(now.frames.lookup(*self.asked).translation[0]), 6)
            now.frames.lookup(*self.asked, t)
        except FrameError as error:
            self.refused[t] = str(error)
        return self.Outputs()


class Teamed(Seeker):
    name = "teamed"
    scope = "world"

    class Inputs(Reads):
        frames: FrameBuffer = frames(team=True)


class Waiting(Seeker):
    """Is held back until there is an IMU."""

    name = "waiting"

    class Inputs(Reads):
        frames: FrameBuffer = frames()
        imu: list[Imu] = every(topics.IMU)

    def step(self, t: float, now: Inputs):
        return super().step(t, now)


class Mover(Service):
    """Its base is 1 m ahead after each second."""

    name = "mover"
    hz = 50.0
    simulator = True

    class Outputs(Writes):
        moving: FrameTransform | None = topic(topics.TF_ODOM)
        placed: FrameTransforms | None = topic(topics.TF_STATIC)

    def step(self, t: float, now) -> Outputs:
        lidar = FrameTransforms(transforms=[edge("alpha/base_footprint", "alpha/lidar", 0.5, t)])
        return self.Outputs(moving=edge("alpha/odom", "alpha/base_footprint", t, t), placed=lidar if t < 0.03 else None)


class Scene(Cast):
    """One that moves and one that looks, each in a process."""

    simulators = ("mover",)

    def processes(self):
        return {"mover": [self.host(Mover, "alpha")], "seeker": [self.host(Seeker, "alpha")]}


def edge(parent, child, x, t=0.0):
    return FrameTransform(timestamp=stamp(t), parent_frame_id=parent, child_frame_id=child, translation=Vector3(x=x))


def odom(owner, x, t):
    return edge(f"{owner}/odom", f"{owner}/base_footprint", x, t)


def shell_of(service, vehicle="alpha"):
    shell = ServiceRunner(ServiceInstance(service, service, vehicle), LocalBus())
    shell.join(1)
    return shell


def put(shell, topic, message, t, owner="alpha", epoch=1):
    key = topic.at(owner)
    sample = Sample(key, message.DESCRIPTOR.full_name, message.SerializeToString(), round(t * NS), 1, 7, epoch)
    for name, declared, reads in shell.reads():
        if declared.topic is topic and reads in (owner, "*"):
            shell._boxes[name].push(sample)


def step_at(shell, t):
    shell.n = round(t * shell.type.hz)
    shell.advance()
    return shell.service


def test_a_step_sees_what_is_stamped_before_it_and_nothing_else():
    seeker = Seeker()
    lockstep = Lockstep([ServiceInstance(Seeker, lambda: seeker, "alpha"), ServiceInstance(Mover, Mover, "alpha")])
    lockstep.run(1.0)
    assert seeker.newest == pytest.approx({t / 10: t / 10 - 0.02 for t in range(1, 11)})
    assert seeker.refused[0.3].endswith("is not known at 0.300 s: that is 0.020 s after the newest (0.280 s)")
    assert "alpha/lidar" in seeker.known


def test_the_order_of_services_and_of_arrival_changes_nothing():
    def run(turn):
        seeker = Seeker()
        hosts = [ServiceInstance(Seeker, lambda: seeker, "alpha"), ServiceInstance(Mover, Mover, "alpha")]
        Lockstep(hosts[::turn]).run(1.0)
        return seeker.newest, seeker.refused

    assert run(1) == run(-1)
    shells = [shell_of(Seeker), shell_of(Seeker)]
    said = [odom("alpha", x, t) for x, t in ((1.0, 0.1), (2.0, 0.2), (9.0, 0.2), (3.0, 0.3))]
    for message in said:
        put(shells[0], topics.TF_ODOM, message, seconds(message.timestamp) + 1e-9)
    for message in (said[3], said[1], said[2], said[0]):
        put(shells[1], topics.TF_ODOM, message, seconds(message.timestamp) + 1e-9)
    assert [step_at(shell, 1.0).newest for shell in shells] == [{1.0: 3.0}] * 2


@pytest.fixture(scope="module")
def in_one_process():
    return run_in(RUNS["one process, lockstep"](Scene()), 2.0).toys.one("seeker.alpha")


@pytest.mark.parametrize("mode", RUNS)
def test_every_mode_hands_over_the_same_tree(mode, in_one_process):
    seeker = run_in(RUNS[mode](Scene()), 2.0).toys.one("seeker.alpha")
    assert "alpha/lidar" in seeker.known
    if "lockstep" in mode:
        assert (seeker.newest, seeker.refused) == (in_one_process.newest, in_one_process.refused)
    assert len(seeker.newest) > 10 and all(newest < t for t, newest in seeker.newest.items())


def test_frames_do_not_age():
    shell = shell_of(Seeker)
    put(shell, topics.TF_ODOM, odom("alpha", 4.0, 0.1), 0.1)
    assert step_at(shell, 500.0).newest == {500.0: 4.0}


def test_what_is_told_while_a_service_waits_is_known_when_it_goes_on():
    shell = shell_of(Waiting)
    for i in range(1, 400):
        put(shell, topics.TF_ODOM, odom("alpha", i / 10, i / 10), i / 10)
        if i % 10 == 0:
            assert step_at(shell, i / 10 + 0.1).newest == {}
    put(shell, topics.IMU, Imu(timestamp=stamp(39.95)), 39.95)
    service = step_at(shell, 40.0)
    assert service.newest == {40.0: 39.9}
    assert shell._frames["frames"].lookup(*Seeker.asked, 30.0).translation[0] == pytest.approx(30.0)


def test_a_new_epoch_begins_with_no_frames():
    shell = shell_of(Seeker)
    put(shell, topics.TF_ODOM, odom("alpha", 4.0, 100.0), 100.0)
    assert step_at(shell, 101.0).newest
    shell.restart(2)
    put(shell, topics.TF_ODOM, odom("alpha", 5.0, 100.1), 100.1, epoch=1)
    assert step_at(shell, 0.1).known == set()
    put(shell, topics.TF_ODOM, odom("alpha", 6.0, 0.15), 0.15, epoch=2)
    assert step_at(shell, 0.2).newest == {0.2: 6.0}


def test_a_vehicles_service_has_its_own_frames_and_a_teams_those_of_all():
    for service, vehicle, known in ((Seeker, "alpha", {"alpha"}), (Teamed, None, {"alpha", "beta"})):
        shell = shell_of(service, vehicle)
        for owner in ("alpha", "beta"):
            put(shell, topics.TF_ODOM, odom(owner, 1.0, 0.1), 0.1, owner)
        assert {frame.partition("/")[0] for frame in step_at(shell, 1.0).known} == known


def test_a_broken_transform_is_refused_and_hides_no_other():
    shell = shell_of(Seeker)
    put(shell, topics.TF_ODOM, odom("alpha", 1.0, 0.1), 0.1)
    put(shell, topics.TF_ODOM, DriveCommand(linear=float("nan")), 0.2)
    assert step_at(shell, 1.0).newest == {1.0: 1.0}
    assert shell.refusals.count == 1
