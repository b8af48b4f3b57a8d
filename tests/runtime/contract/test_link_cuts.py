"""A link that is cut: nothing goes between the vehicle and what does not run aboard it, everything goes aboard, and it comes back."""

import pytest

from schemas import topics
from schemas.messages import ArmRequest, DriveCommand, Imu, Reply, VehicleStatus
from uvf.models.mission.faults import Fault
from uvf.runtime.contract.declaration import Reads, Writes, answers, call, each_vehicle, optional, replies, request, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Answer, Service
from uvf.runtime.messages.convert import seconds, stamp
from uvf.runtime.time.lockstep import Lockstep

CUT = (Fault("alpha", "link", "lost", at=2.0, until=4.0),)


class World(Service):
    """A simulator."""

    name = "world"
    hz = 10.0
    scope = "world"
    simulator = True

    class Inputs(Reads):
        drive: dict[str, DriveCommand] = each_vehicle(topics.DRIVE.by("planner"))

    class Outputs(Writes):
        imu: dict[str, Imu] | None = topic(topics.IMU)

    def step(self, t: float, now: Inputs) -> Outputs:
        return self.Outputs(imu={name: Imu(timestamp=stamp(t)) for name in ("alpha", "beta")})


class Aboard(Service):
    """Of a vehicle: hears its own IMU, the other vehicle and who commands it, and tells how old what it heard last is."""

    name = "aboard"
    hz = 10.0

    class Inputs(Reads):
        imu: Imu | None = optional(topics.IMU)
        team: dict[str, VehicleStatus] = each_vehicle(topics.STATUS)
        told: DriveCommand | None = optional(topics.DRIVE.by("executive"))
        arm: list[ArmRequest] = request(topics.ARM)

    class Outputs(Writes):
        status: VehicleStatus | None = topic(topics.STATUS)
        arm: list[Reply] = replies(topics.ARM)

    def __init__(self, name):
        self._name, self.heard = name, []

    def step(self, t: float, now: Inputs) -> Outputs:
        others = [seconds(m.timestamp) for name, m in now.team.items() if name != self._name]
        told = None if now.told is None else seconds(now.told.timestamp)
        self.heard.append((t, now.imu is not None and t - seconds(now.imu.timestamp) < 0.15, max(others, default=None), told))
        return self.Outputs(status=VehicleStatus(timestamp=stamp(t)), arm=[Reply(accepted=True) for _ in now.arm])


class Remote(Service):
    """Somewhere else: commands both vehicles, and asks them to arm."""

    name = "remote"
    hz = 10.0
    scope = "world"

    class Inputs(Reads):
        status: dict[str, VehicleStatus] = each_vehicle(topics.STATUS)
        arm: list[Answer[ArmRequest, Reply]] = answers(topics.ARM)

    class Outputs(Writes):
        drive: dict[str, DriveCommand] | None = topic(topics.DRIVE.by("executive"))
        arm: dict[str, ArmRequest] | None = call(topics.ARM)

    def __init__(self):
        self.heard, self.answers = [], []

    def step(self, t: float, now: Inputs) -> Outputs:
        self.heard.append((t, {name: seconds(m.timestamp) for name, m in now.status.items()}))
        self.answers += [(t, a.vehicle, a.reply is not None, a.reason) for a in now.arm]
        both = ("alpha", "beta")
        drive = {name: DriveCommand(timestamp=stamp(t)) for name in both}
        return self.Outputs(drive=drive, arm={name: ArmRequest(arm=True) for name in both})


@pytest.fixture(scope="module")
def run():
    made = {name: Aboard(name) for name in ("alpha", "beta")}
    remote = Remote()
    hosts = [ServiceInstance(World, World, faults=CUT), ServiceInstance(Remote, lambda: remote, faults=CUT)]
    hosts += [ServiceInstance(Aboard, lambda one=one: one, name, faults=CUT) for name, one in made.items()]
    lockstep = Lockstep(hosts)
    lockstep.run(6.0)
    lockstep.close()
    return made, remote


def fresh(t, heard):
    return heard is not None and t - heard < 0.25


def during(rows, low, high):
    return [row for row in rows if low <= row[0] <= high]


def test_aboard_everything_goes_on(run):
    made, _ = run
    assert all(imu for one in made.values() for t, imu, *_ in one.heard if t > 0.2)


@pytest.mark.parametrize("name", ["alpha", "beta"])
def test_vehicles_do_not_hear_each_other_while_it_is_cut(run, name):
    heard = run[0][name].heard
    assert all(fresh(t, other) for t, _, other, _ in (*during(heard, 0.5, 1.9), *during(heard, 4.5, 6.0)))
    assert not any(fresh(t, other) for t, _, other, _ in during(heard, 2.5, 3.9))


def test_commands_from_outside_reach_only_who_has_a_link(run):
    made, _ = run
    for name, reach in (("alpha", False), ("beta", True)):
        assert all(fresh(t, told) is reach for t, _, _, told in during(made[name].heard, 2.5, 3.9))
        assert all(fresh(t, told) for t, _, _, told in during(made[name].heard, 4.5, 6.0))


def test_who_is_outside_hears_only_who_has_a_link(run):
    _, remote = run
    for t, heard in during(remote.heard, 2.5, 3.9):
        assert fresh(t, heard.get("beta")) and not fresh(t, heard.get("alpha"))


def test_requests_are_not_answered_and_it_is_said_why(run):
    _, remote = run
    lost = {(vehicle, why) for t, vehicle, answered, why in remote.answers if not answered}
    assert lost == {("alpha", "no answer: the link to alpha is cut")}
    assert all(answered for t, vehicle, answered, _ in remote.answers if vehicle == "beta" or t < 2.0 or t > 4.3)
