"""Every ground vehicle of the project drives as the kinematics say; hard steps tip one that shaped commands do not."""

import msgspec
import numpy as np
import pytest

from benchmarks.sim.ground.kinematics import drive, drives, figures, ground_vehicles
from services.sim_ground.loading import BodyPlacement
from services.sim_ground.world import BulletWorld
from uvf.control.drive_limits import DriveLimits, VelocityRamp
from uvf.maths.kinematics import Twist
from uvf.maths.rotations import matrix
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import Motor, load_vehicle

VEHICLES = {name: (body, urdf) for name, body, urdf in ground_vehicles()}
KINDS = [(name, one.name) for name, (body, _) in VEHICLES.items() for one in drives(body)]


def test_a_car_drives_arcs_and_others_turn_on_the_spot_too():
    assert {kind for name, kind in KINDS if name == "minicar"} == {"straight 10 m", "arc 1 m", "arc 2 m"}
    assert {kind for name, kind in KINDS if name == "burger"} > {"arc 0.5 m", "spot turn", "left wheel stopped"}


@pytest.mark.parametrize(("name", "kind"), KINDS)
def test_on_the_flat_it_ends_within_two_percent_of_the_closed_form(name, kind):
    body, urdf = VEHICLES[name]
    wanted = next(d for d in drives(body) if d.name == kind)
    found = figures(body, drive(body, urdf, wanted))
    assert found["position %"] < 2.0
    assert found["heading %"] < 2.0
    assert abs(found["creep %"]) < 0.5


def lowest_up(shaped):
    """Cosine of the greatest tilt of a burger with motors ten times as strong that is told 0.8 m/s ahead, then back."""
    body = load_vehicle(ROOT / "vehicles", "burger").ground
    strong = msgspec.structs.replace(body, motor=Motor(stall_torque=0.5, no_load_speed=30.0, lag=0.02))
    placed = BodyPlacement(strong, ROOT / "vehicles" / "burger" / body.urdf, (0.0, 0.0, 0.0))
    world, wheels = BulletWorld([], {"burger": placed}), body.drive.kinematics
    ramp = VelocityRamp(DriveLimits(body.max_linear, body.max_angular, body.max_linear_acceleration, body.max_angular_acceleration))
    up = 1.0
    for n in range(400):
        wanted = Twist(0.8 if n < 200 else -0.8, 0.0)
        world.advance({"burger": wheels.wheels(ramp.lead(wanted, 0.01) if shaped else wanted)}, 0.01)
        up = min(up, matrix(world.state("burger").world_from_body)[2, 2])
    world.close()
    return up


def test_a_hard_step_of_the_speed_tips_it_up_and_limits_of_acceleration_prevent_that():
    assert lowest_up(shaped=False) < np.cos(0.35)  # rears up by more than 20 deg
    assert lowest_up(shaped=True) > np.cos(0.02)
