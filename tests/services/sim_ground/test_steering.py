"""A car in the physics: it drives where it is steered, as tightly as it can, and a saved state keeps its steering."""

from dataclasses import replace
from math import nan

import msgspec
import numpy as np
import pytest

from launch.vehicles.trial_drive import drive
from services.sim_ground.loading import BodyPlacement
from services.sim_ground.steering import SteeringGear
from services.sim_ground.world import BulletWorld
from uvf.maths.kinematics import Twist
from uvf.maths.rotations import to_euler
from uvf.maths.wheels.steered import wheel_steering
from uvf.models.scenario import ROOT
from uvf.models.urdf.model import engine_urdf
from uvf.models.vehicle.file import load_vehicle

FOLDER = ROOT / "vehicles" / "minicar"
BODY = load_vehicle(ROOT / "vehicles", "minicar").ground
CAR = BODY.drive.kinematics
PLACED = BodyPlacement(BODY, FOLDER / BODY.urdf, (0.0, 0.0, 0.0))


@pytest.fixture
def world():
    made = BulletWorld([], {"car": replace(PLACED, urdf=engine_urdf(PLACED.urdf))})
    yield made
    made.close()


@pytest.mark.parametrize("twist", [(1.0, 0.0), (0.5, 0.5), (1.0, -1.0), (-0.5, 0.3), (0.4, 5.0)])
def test_it_drives_the_arcs_it_is_told_to(twist):
    driven = drive(FOLDER, twist, 6.0)
    assert driven.pose[:2] == pytest.approx(driven.expected[:2], abs=0.05)
    assert driven.pose[2] == pytest.approx(driven.expected[2], rel=0.01, abs=0.01)


def test_its_front_wheels_stand_across_the_lines_to_the_centre_of_the_turn(world):
    world.advance({}, 1.0, steering={"car": 0.3})
    expected = [wheel_steering(CAR.curvature(0.3), 0.325, y) for y in (0.1175, -0.1175)]
    assert world.state("car").steered_to == pytest.approx(expected, abs=1e-3)
    world.advance({}, 1.0, steering={"car": 9.0})
    assert world.state("car").steered_to[0] == pytest.approx(wheel_steering(1 / CAR.turning_radius, 0.325, 0.1175), abs=1e-3)


def test_without_a_word_about_it_the_steering_stays(world):
    world.advance({}, 0.5, steering={"car": 0.2})
    before = world.state("car").steered_to
    world.advance({}, 0.5)
    world.advance({}, 0.5, steering={"car": nan})
    assert world.state("car").steered_to == pytest.approx(before, abs=1e-4)


def test_wheels_that_turn_against_each_other_hardly_turn_it(world):
    world.advance({"car": CAR.wheels(Twist(0.0, 1.0))}, 3.0, steering={"car": 0.0})
    assert abs(to_euler(world.state("car").world_from_body)[2]) < 0.5  # 3 rad with a castor instead of tyres in front


def test_a_restored_state_goes_on_with_the_steering_it_had(world):
    def onward():
        for _ in range(50):
            world.advance({"car": CAR.wheels(Twist(1.0, 1.0))}, 0.02, steering={"car": CAR.steering(1.0)})
        return world.state("car")

    world.advance({"car": CAR.wheels(Twist(0.5, 0.0))}, 0.3, steering={"car": -0.2})
    saved = world.save()
    first = onward()
    world.restore(saved)
    again = onward()
    assert np.array_equal(first.position, again.position) and first.steered_to == again.steered_to


def test_a_joint_whose_axis_points_down_is_turned_the_other_way():
    gear = SteeringGear([0, 1], [(0.3, 0.1), (0.3, 0.1)], [1.0, -1.0], CAR, 3.0)
    up, down = gear.turn(0.3, 1.0)
    assert up == -down > 0.3


def test_a_slippery_floor_takes_it_straight_on():
    slippery = msgspec.structs.replace(BODY.friction, mu=0.05, mu2=0.05)
    icy = replace(PLACED, urdf=engine_urdf(PLACED.urdf), body=msgspec.structs.replace(BODY, friction=slippery))
    world = BulletWorld([], {"car": icy})
    world.advance({"car": CAR.wheels(Twist(1.0, 0.0))}, 6.0)
    for _ in range(50):
        world.advance({"car": CAR.wheels(Twist(1.0, 1.3))}, 0.02, steering={"car": 0.4})
    assert abs(to_euler(world.state("car").world_from_body)[2]) < 0.8  # 1.3 on a floor that holds
    world.close()
