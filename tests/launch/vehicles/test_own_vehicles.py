"""The vehicles here are free of faults and drive as their wheels' kinematics say."""

import numpy as np
import pytest

from launch.vehicles.inspection import inspect
from launch.vehicles.trial_drive import drive
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle

VEHICLES = ROOT / "vehicles"
NAMES = sorted(p.parent.name for p in VEHICLES.glob("*/vehicle.yaml"))
ROVERS = [name for name in NAMES if load_vehicle(VEHICLES, name).kind == "ground"]
TIGHTEST = {name: load_vehicle(VEHICLES, name).ground.drive.kinematics.turning_radius for name in ROVERS}


def test_the_vehicles_of_the_framework_are_there():
    assert {"burger", "milvus", "minicar", "my2bot", "my3bot", "mybot05"} <= set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_nothing_is_wrong_with_it(name):
    found = inspect(VEHICLES / name)
    assert found.faults == []
    assert [line for line in found.notes if not line.startswith("no lidar sees")] == []


@pytest.mark.parametrize("name", ROVERS)
def test_ten_metres_straight_on(name):
    driven = drive(VEHICLES / name, (0.5, 0.0), 20.0)
    assert driven.pose[0] == pytest.approx(driven.expected[0], rel=0.005)
    assert abs(driven.pose[1]) < 0.1
    assert driven.tilt < 0.01


@pytest.mark.parametrize(("name", "radius"), [(name, radius) for name in ROVERS for radius in (0.5, 1.0, 2.0) if radius > TIGHTEST[name]])
def test_arcs(name, radius):
    driven = drive(VEHICLES / name, (0.4, 0.4 / radius), 0.5 * np.pi * radius / 0.4)
    assert driven.pose[:2] == pytest.approx(driven.expected[:2], abs=0.02 * radius)
    assert driven.pose[2] == pytest.approx(driven.expected[2], rel=0.02)


@pytest.mark.parametrize("name", [name for name in ROVERS if not TIGHTEST[name]])
def test_turns_on_the_spot(name):
    driven = drive(VEHICLES / name, (0.0, 1.0), 2 * np.pi)
    assert np.hypot(*driven.pose[:2]) < 0.01
    assert driven.pose[2] == pytest.approx(driven.expected[2], rel=0.02)
