"""The service with a world of twenty lines: which command goes where, and what is told once."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from schemas.messages import NavState, Quaternion, Vector3, WheelCommand
from services.sim_ground.body import BodyState, Touch
from services.sim_ground.rig import Rig
from services.sim_ground.service import SimGround
from services.sim_ground.stage import GroundStage
from tests.runtime.stepping import stepped
from tests.services.sim_ground.ride import site_with
from uvf.maths.kinematics import WheelSpeeds
from uvf.models.urdf.model import load_urdf
from uvf.models.world.geometry import solids
from uvf.runtime.messages.convert import seconds, stamp
from uvf.sensors.surroundings import Surroundings, vehicle_tree

IDLE = {
    "commands": {},
    "joint_commands": {},
    "flying": None,
    "truth": {},
    "spawn": [],
    "remove": [],
    "set_pose": [],
    "save": [],
    "restore": [],
}


class StandingWorld:
    """Nothing moves; keeps what it was told."""

    rate = 200.0

    def __init__(self, positions, touches=()):
        self.positions = positions
        self.seen = list(touches)
        self.told = []

    def motor_energy(self, vehicle):
        return 0.0

    def advance(self, wheels, duration, since, steering, joints):
        self.told.append((dict(wheels), duration, since))

    def state(self, vehicle):
        x, y = self.positions[vehicle]
        identity, still = np.array((1.0, 0, 0, 0)), np.zeros(3)
        return BodyState(np.array((x, y, 0.0)), identity, still, still, (0.0, 0.0), WheelSpeeds(0.0, 0.0))

    def touches(self, vehicle):
        return self.seen

    def set_grip(self, vehicle, shares):
        pass

    def guide(self, guests):
        self.guests = guests

    def poses(self):
        return {}

    def close(self):
        self.told.append("closed")


@pytest.fixture
def site(tmp_path):
    return site_with(tmp_path, {"one": (6.0, 4.4, 0.0), "two": (7.0, 4.4, 0.0)})


def service_in(site, world, aircraft=()):
    models = {name: load_urdf(member.folder / member.file.ground.urdf) for name, member in site.members.items()}
    surroundings = Surroundings(solids(site.world), {name: vehicle_tree(model) for name, model in models.items()})
    rigs = {name: Rig(site, member, member.file.ground, surroundings.still) for name, member in site.members.items()}
    stage = GroundStage(world, rigs, surroundings, tuple(rigs), join=None)
    return SimGround(world, surroundings, stage, aircraft)


def test_each_command_goes_to_its_vehicle_for_one_period(site):
    world = StandingWorld({"one": (6.0, 4.4), "two": (7.0, 4.4)})
    stepped(service_in(site, world), 0.01, **{**IDLE, "commands": {"two": WheelCommand(left=1.0, right=2.0)}})
    assert world.told == [({"two": (1.0, 2.0)}, 0.01, 0.0)]


def test_frames_are_told_at_the_first_step_only(site):
    service = service_in(site, StandingWorld({"one": (6.0, 4.4), "two": (7.0, 4.4)}))
    assert set(stepped(service, 0.01, **IDLE)["frames"]) == {"one", "two"}
    assert "frames" not in stepped(service, 0.02, **IDLE)


def test_the_neighbour_is_in_the_scan(site):
    service = service_in(site, StandingWorld({"one": (6.0, 4.4), "two": (7.0, 4.4)}))
    scan = stepped(service, 0.2, **IDLE)["scan"]["one"]
    assert scan.ranges[0] == pytest.approx(1.0 + 0.032 - 0.115, abs=0.04)


def test_what_is_touched_is_named(site):
    service = service_in(site, StandingWorld({"one": (6.0, 4.4), "two": (7.0, 4.4)}, touches=[Touch("sofa", 0.1)]))
    contact = stepped(service, 0.05, **IDLE)["contact"]["two"]
    assert contact.touching
    assert contact.other == "sofa"


def test_a_short_touch_between_two_messages_is_told_once(site):
    world = StandingWorld({"one": (6.0, 4.4), "two": (7.0, 4.4)})
    service = service_in(site, world)
    told = []
    for n in range(1, 16):
        world.seen = [Touch("sofa", 0.1)] if n == 7 else []
        told += [outputs["one"].touching for outputs in [stepped(service, n / 100, **IDLE).get("contact")] if outputs]
    assert told == [False, True, False]


def test_a_simulator_that_joins_late_still_tells_its_frames(site):
    service = service_in(site, StandingWorld({"one": (6.0, 4.4), "two": (7.0, 4.4)}))
    assert set(stepped(service, 50.0, **IDLE)["frames"]) == {"one", "two"}


def test_an_imu_at_200_hz_is_read_after_each_step_of_the_physics(site):
    member = site.members["one"]
    imu = msgspec.structs.replace(member.file.sensors.imu, hz=200.0)
    file = msgspec.structs.replace(member.file, sensors=msgspec.structs.replace(member.file.sensors, imu=imu))
    site.members["one"] = replace(member, file=file)
    world = StandingWorld({"one": (6.0, 4.4), "two": (7.0, 4.4)})
    service = service_in(site, world)
    for n in range(1, 4):
        said = stepped(service, n / 100, **IDLE)["imu"]
        assert [round(seconds(m.timestamp), 6) for m in said["one"]] == [round(n / 100 - 0.005, 6), n / 100]
        assert round(seconds(said["two"].timestamp), 6) == n / 100
    assert [(duration, round(since, 6)) for _, duration, since in world.told[-2:]] == [(0.005, 0.02), (0.005, 0.025)]


def test_an_imu_between_one_and_two_readings_a_step_tells_each_at_the_next_step(site):
    member = site.members["one"]
    imu = msgspec.structs.replace(member.file.sensors.imu, hz=120.0)
    site.members["one"] = replace(
        member, file=msgspec.structs.replace(member.file, sensors=msgspec.structs.replace(member.file.sensors, imu=imu))
    )
    service = service_in(site, StandingWorld({"one": (6.0, 4.4), "two": (7.0, 4.4)}))
    ages = []
    for n in range(1, 51):
        said = stepped(service, n / 100, **IDLE).get("imu", {}).get("one", [])
        ages += [n / 100 - seconds(m.timestamp) for m in (said if isinstance(said, list) else [said])]
    assert len(ages) == 60
    assert max(ages) < 0.0051


def test_closing_gives_the_engine_back(site):
    world = StandingWorld({"one": (6.0, 4.4), "two": (7.0, 4.4)})
    service_in(site, world).close()
    assert world.told == ["closed"]


def test_the_physics_hears_of_aircraft_and_of_nobody_else(site):
    world = StandingWorld({"one": (6.0, 4.4), "two": (7.0, 4.4)})
    told = NavState(timestamp=stamp(0.49), position=Vector3(x=1.0, z=2.0), velocity=Vector3(x=20.0), orientation=Quaternion(w=1.0))
    stepped(service_in(site, world, ("bird",)), 0.5, **{**IDLE, "truth": {"bird": told, "one": told}})
    assert list(world.guests) == ["bird"]
    assert world.guests["bird"].at(0.5).position == pytest.approx((1.2, 0.0, 2.0))
    assert world.guests["bird"].at(9.0).position == pytest.approx((3.0, 0.0, 2.0))
