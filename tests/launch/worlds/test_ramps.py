"""Ramps of the worlds are climbed in the physics, up to the height of what they lead to and down again."""

import numpy as np
import pytest

from services.sim_ground.loading import BodyPlacement
from services.sim_ground.world import BulletWorld
from uvf.maths.kinematics import Twist
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.world.file import load_world
from uvf.models.world.geometry import solids

FOLDER = ROOT / "vehicles" / "burger"
BODY = load_vehicle(ROOT / "vehicles", "burger").ground
RAMPS = {
    "the west ramp of the terrace": ("plaza", (24.6, 24.0, 0.0), 5.0, 0.4),
    "the south ramp of the terrace": ("plaza", (33.0, 15.6, np.pi / 2), 6.0, 0.4),
    "the hump": ("plaza", (6.5, 6.0, 0.0), 3.2, 0.25),
    "the ramp in the yard": ("world", (24.5, 19.0, 0.0), 4.0, 0.3),
}


def driven(name, start, seconds):
    """Where the burger is after driving straight on at 0.2 m/s."""
    world = BulletWorld(solids(load_world(ROOT / "worlds", name)), {"burger": BodyPlacement(BODY, FOLDER / BODY.urdf, start)})
    world.advance({"burger": BODY.drive.kinematics.wheels(Twist(0.2, 0.0))}, seconds)
    position = world.state("burger").position
    world.close()
    return position


@pytest.mark.parametrize("ramp", RAMPS)
def test_the_burger_climbs(ramp):
    name, start, way, height = RAMPS[ramp]
    position = driven(name, start, way / 0.2)
    assert position[2] == pytest.approx(height, abs=0.01)
    assert np.hypot(*(position[:2] - start[:2])) > 0.85 * way


def test_the_hump_is_left_at_the_other_side():
    position = driven("plaza", RAMPS["the hump"][1], 35.0)
    assert position[2] == pytest.approx(0.0, abs=0.01)
    assert position[0] > 12.5
