"""The physics behind its Protocol: several worlds side by side, starts, falls, a long wild ride."""

import re
from dataclasses import replace

import msgspec
import numpy as np
import pybullet
import pytest

from services.sim_ground.loading import BodyPlacement
from services.sim_ground.world import BulletWorld
from uvf.maths.kinematics import Twist, WheelSpeeds
from uvf.maths.rotations import from_euler, matrix, multiply, rotate, to_euler
from uvf.models.scenario import ROOT
from uvf.models.shapes.solid import Keyframes, Solid
from uvf.models.urdf.model import engine_urdf
from uvf.models.vehicle.file import Friction, load_vehicle
from uvf.models.world.file import load_world
from uvf.models.world.footing import Footing
from uvf.models.world.geometry import solids

HOUSE = load_world(ROOT / "worlds", "house")
SOLIDS = solids(HOUSE)
BODY = load_vehicle(ROOT / "vehicles", "burger").ground
BURGER = BodyPlacement(BODY, ROOT / "vehicles" / "burger" / BODY.urdf, (6.0, 4.4, 0.7))
DRIVE = BODY.drive.kinematics


@pytest.fixture
def world():
    made = BulletWorld(SOLIDS, {"burger": BURGER})
    yield made
    made.close()


def test_it_starts_where_the_mission_says_and_at_rest(world):
    state = world.state("burger")
    assert state.position == pytest.approx((6.0, 4.4, 0.0), abs=1e-3)
    assert to_euler(state.world_from_body) == pytest.approx((0.0, 0.0, 0.7), abs=1e-3)
    assert np.linalg.norm(state.velocity) < 1e-3


def test_velocity_is_the_change_of_position(world):
    wheels = {"burger": DRIVE.wheels(Twist(0.2, 1.0))}
    world.advance(wheels, 1.0)
    before = world.state("burger")
    world.advance(wheels, 0.01)
    after = world.state("burger")
    assert (after.position - before.position) / 0.01 == pytest.approx(after.velocity, abs=5e-3)
    turned = to_euler(after.world_from_body)[2] - to_euler(before.world_from_body)[2]
    assert turned / 0.01 == pytest.approx(after.angular_velocity[2], abs=0.01)


def test_wheel_angles_go_on_over_many_turns(world):
    world.advance({"burger": WheelSpeeds(-10.0, 10.0)}, 10.0)
    left, right = world.state("burger").wheel_angles
    assert (left, right) == pytest.approx((-100.0, 100.0), rel=0.03)


def test_two_worlds_do_not_share_anything(world):
    other = BulletWorld(SOLIDS, {"burger": replace(BURGER, start=(2.2, 1.3, 0.0))})
    other.advance({"burger": WheelSpeeds(5.0, 5.0)}, 1.0)
    other.close()
    assert world.state("burger").position == pytest.approx((6.0, 4.4, 0.0), abs=1e-3)


def test_one_that_has_fallen_over_touches_the_floor(world):
    loaded = world._vehicles["burger"]
    pybullet.resetBasePositionAndOrientation(
        loaded.index, [6.0, 4.4, 0.12], [0.7071, 0.0, 0.0, 0.7071], physicsClientId=world.engine.client
    )
    world.advance({}, 1.0)
    assert {touch.other for touch in world.touches("burger")} == {"floor"}


def test_a_minute_of_wild_driving_neither_tips_it_nor_takes_it_through_a_wall(world):
    rng = np.random.default_rng(11)
    lowest_up, touches = 1.0, set()
    for _ in range(60):
        command = {"burger": DRIVE.wheels(Twist(rng.uniform(-0.5, 0.5), rng.uniform(-2.0, 2.0)))}
        for _ in range(10):
            world.advance(command, 0.1)
            state = world.state("burger")
            lowest_up = min(lowest_up, matrix(state.world_from_body)[2, 2])
            touches.update(touch.other for touch in world.touches("burger"))
            assert abs(state.position[2]) < 0.02
        assert Footing(HOUSE).at(*state.position[:2]).room > 0.03  # its nose is 0.038 m before the axle
    assert lowest_up > np.cos(0.35)  # it leans at each hard step, as the steps are not shaped
    assert touches


@pytest.mark.parametrize("speed", [np.nan, np.inf, -np.inf])
def test_wheel_speeds_that_are_no_numbers_brake_it_and_do_not_stay(world, speed):
    wheels = {"burger": DRIVE.wheels(Twist(0.2, 0.0))}
    world.advance(wheels, 0.5)
    world.advance({"burger": WheelSpeeds(speed, 1.0)}, 0.5)
    assert np.linalg.norm(world.state("burger").velocity) < 0.01
    world.advance(wheels, 0.5)
    assert np.linalg.norm(world.state("burger").velocity) == pytest.approx(0.2, rel=0.05)


def test_it_gathers_speed_as_its_motors_torque_falls(world):
    """Flat out, m v' = 2 T (1 - v / (r w0)) / r: an exponential towards the no-load speed."""
    motor, seconds_ = BODY.motor, 0.5
    world.advance({"burger": WheelSpeeds(1e6, 1e6)}, seconds_)
    top, force = motor.no_load_speed * BODY.drive.wheel_radius, 2 * motor.stall_torque / BODY.drive.wheel_radius
    mass = 0.824 + 0.114 + 0.005 + 2 * (0.0285 + 0.00001552 / BODY.drive.wheel_radius**2)  # the wheels turn too
    wanted = top * (1 - np.exp(-force * (seconds_ - motor.lag / 2) / (mass * top)))
    assert np.linalg.norm(world.state("burger").velocity) == pytest.approx(wanted, rel=0.05)


def test_a_person_who_walks_into_it_pushes_it_along():
    path = Keyframes(np.array(((0.0, 1.0, 1.5, 0.0), (10.0, 4.0, 1.5, 0.0), (20.0, 1.0, 1.5, 0.0))))
    person = Solid("person", "cylinder", (0.2, 1.7), np.array((1.0, 1.5, 0.85)), path=path)
    hall = BulletWorld([person], {"burger": replace(BURGER, start=(2.0, 1.5, 0.0))})
    for n in range(350):
        hall.advance({}, 0.01, since=n / 100)
    state = hall.state("burger")
    assert state.velocity[0] == pytest.approx(0.3, abs=0.02)
    assert state.position[0] - (1.0 + 0.3 * 3.5) == pytest.approx(0.2 + 0.032 + 0.07, abs=0.01)
    assert {touch.other for touch in hall.touches("burger")} == {"person"}
    hall.close()


def slipped(friction, yaw, urdf=BURGER.urdf):
    """m, that a burger with its wheels held slips within a second down a slope of tan 0.2 that it heads along at ``yaw``."""
    slope = np.arctan(0.2)
    tilt = from_euler(0.0, slope, 0.0)
    ramp = Solid("ramp", "box", (6.0, 6.0, 0.2), np.array((0.0, 0.0, 2.0)), tilt)
    placed = replace(BURGER, body=msgspec.structs.replace(BODY, friction=friction), urdf=urdf, start=(9.0, 9.0, 0.0))
    world = BulletWorld([ramp], {"burger": placed})
    loaded = world._vehicles["burger"]
    base = multiply(tilt, from_euler(0.0, 0.0, yaw))
    place = ramp.position + rotate(tilt, np.array((0.0, 0.0, 0.1))) + rotate(base, loaded.com_in_base[0])
    x, y, z, w = *base[1:], base[0]
    pybullet.resetBasePositionAndOrientation(loaded.index, place.tolist(), [x, y, z, w], physicsClientId=world.engine.client)
    world.advance({}, 0.3)
    before = world.state("burger").position
    world.advance({}, 1.0)
    after = world.state("burger").position
    world.close()
    return float(np.linalg.norm(after - before))


@pytest.mark.parametrize(
    ("mu", "mu2", "along", "across"),
    [(1.0, 1.0, False, False), (0.1, 0.1, True, True), (1.0, 0.1, False, True)],
)
def test_on_a_slope_it_slips_where_the_friction_of_that_direction_is_too_small(mu, mu2, along, across):
    friction = Friction(mu=mu, mu2=mu2)
    assert (slipped(friction, 0.0) > 0.1) == along
    assert (slipped(friction, np.pi / 2) > 0.1) == across


def test_friction_goes_by_the_axle_however_the_wheels_frame_is_turned(tmp_path):
    """As CAD exports wheels: z along the axle."""
    text = engine_urdf(BURGER.urdf).read_text()
    turned = re.sub(r'(<origin xyz="0 -?0\.08 0\.033" rpy=")0 0 0("/>\s*<axis xyz=")0 1 0', r"\1-1.5707963 0 0\g<2>0 0 1", text)
    assert turned.count('<axis xyz="0 0 1"/>') == 2
    urdf = tmp_path / "turned.urdf"
    urdf.write_text(turned)
    friction = Friction(mu=1.0, mu2=0.1)
    assert slipped(friction, 0.0, urdf) < 0.1
    assert slipped(friction, np.pi / 2, urdf) > 0.1


@pytest.mark.parametrize("rounded", ["0.0020005", "0.002"])
def test_a_flat_body_whose_inertia_was_rounded_keeps_it(tmp_path, rounded):
    """Ten thousandths beyond the triangle rule, which passes the check: Bullet would take no inertia at all."""
    flat = re.sub(
        r'ixx="0.002414" ixy="0" ixz="0" iyy="0.002414" iyz="0" izz="0.002019"',
        f'ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="{rounded}"',
        engine_urdf(BURGER.urdf).read_text(),
    )
    assert rounded in flat
    urdf = tmp_path / "flat.urdf"
    urdf.write_text(flat)
    world = BulletWorld([], {"burger": replace(BURGER, urdf=engine_urdf(urdf))})
    moments = pybullet.getDynamicsInfo(world._vehicles["burger"].index, -1, physicsClientId=world.engine.client)[2]
    world.close()
    assert moments == pytest.approx((0.001, 0.001, 0.002), rel=1e-3)


def test_a_wheel_without_grip_spins_and_the_vehicle_turns_about_it_until_the_grip_comes_back(world):
    ahead = {"burger": DRIVE.wheels(Twist(0.2, 0.0))}
    world.set_grip("burger", (0.0, 1.0))
    world.advance(ahead, 0.5)
    state = world.state("burger")
    left, right = state.wheel_angles
    assert left == pytest.approx(right, rel=0.1)
    assert to_euler(state.world_from_body)[2] - 0.7 > 0.5  # to the left, about the wheel that slides
    world.set_grip("burger", (1.0, 1.0))
    world.advance(ahead, 0.5)
    yaw = to_euler(world.state("burger").world_from_body)[2]
    world.advance(ahead, 1.0)
    assert to_euler(world.state("burger").world_from_body)[2] == pytest.approx(yaw, abs=0.02)


def test_a_huge_speed_is_no_more_than_its_motors_can_do(world):
    world.advance({"burger": WheelSpeeds(1e300, -1e300)}, 0.5)
    world.advance({}, 2.0)
    state = world.state("burger")
    assert np.isfinite(state.position).all()
    assert np.linalg.norm(state.velocity) < 0.01


def box_at(x, z, size, pitch=0.0):
    return Solid("thing", "box", size, np.array((x, 0.0, z)), from_euler(0.0, pitch, 0.0))


def felt_on_the_way(thing, speed=0.15, seconds=8.0):
    """What a burger touches that drives along x from 0 for a while, and where it is then [m]."""
    world = BulletWorld([thing], {"burger": replace(BURGER, start=(0.0, 0.0, 0.0))})
    felt = []
    for _ in range(round(seconds / 0.02)):
        world.advance({"burger": DRIVE.wheels(Twist(speed, 0.0))}, 0.02)
        felt += [touch.other for touch in world.touches("burger")]
    place = world.state("burger").position
    world.close()
    return felt, place


RAMP = box_at(1.5, 1.5 * np.sin(0.15) - 0.01, (3.0, 1.0, 0.02), -0.15)


@pytest.mark.parametrize(("thing", "height"), [(RAMP, 0.1), (box_at(1.2, 0.0015, (2.0, 1.0, 0.003)), 0.002)])
def test_what_it_drives_on_is_no_contact(thing, height):
    felt, place = felt_on_the_way(thing)
    assert place[2] > height
    assert felt == []


@pytest.mark.parametrize(
    "thing",
    [
        box_at(0.8, 0.02, (1.0, 1.0, 0.04)),  # a kerb
        box_at(0.8, 0.15, (1.0, 0.08, 0.04)),  # a bar at the height of its deck
        Solid(
            "thing",
            "box",
            (0.3, 0.04, 0.03),
            np.array((0.4, 0.0, 0.015)),
            path=Keyframes(np.array(((0.0, 0.4, 0.0, 0.0), (9.0, -2.0, 0.0, 0.0)))),
        ),
    ],
)
def test_what_stands_in_its_way_is_a_contact(thing):
    felt, _ = felt_on_the_way(thing)
    assert set(felt) == {"thing"}


def test_its_deck_on_a_bump_is_a_contact_although_that_bears_it():
    world = BulletWorld([box_at(0.03, 0.01, (0.06, 0.08, 0.02))], {"burger": replace(BURGER, start=(0.0, 0.0, 0.0), z=0.012)})
    world.advance({}, 1.0)
    assert {touch.other for touch in world.touches("burger")} == {"thing"}
    world.close()
