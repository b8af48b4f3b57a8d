"""Robots of others on omni wheels: found by axes that meet in one point, whichever way these point and whatever hangs in the wheels."""

import numpy as np
import pytest

from launch.vehicles.importing import import_vehicle
from launch.vehicles.inspection import inspect
from launch.vehicles.trial_drive import drive
from tests.launch.vehicles.test_odd_robots import INERTIA, write
from uvf.models.vehicle.file import load_vehicle

BODY = (
    f'<link name="chassis"><inertial><mass value="4"/>{INERTIA.format(0.03)}</inertial>'
    '<collision><geometry><cylinder radius="0.15" length="0.08"/></geometry></collision></link>'
)


def rolling(name, parent, place, yaw, size, sign=1):
    """A link with something round that turns about an axis along ``yaw`` [rad]."""
    shape = f'<geometry><cylinder radius="{size}" length="0.03"/></geometry>'
    looks = f'<origin rpy="1.5708 0 {yaw + np.pi / 2}"/>{shape}'
    x, y, z = place
    axis = f"{sign * np.cos(yaw):.6f} {sign * np.sin(yaw):.6f} 0"
    return (
        f'<link name="{name}"><inertial><mass value="0.2"/>{INERTIA.format(1e-4)}</inertial>'
        f"<visual>{looks}</visual><collision>{looks}</collision></link>"
        f'<joint name="{name}_joint" type="continuous"><parent link="{parent}"/><child link="{name}"/>'
        f'<origin xyz="{x:.6f} {y:.6f} {z}"/><axis xyz="{axis}"/></joint>'
    )


def robot(bearings, signs, rollers=False, off=(0.0, 0.0)):
    parts = []
    for i, (bearing, sign) in enumerate(zip(bearings, signs, strict=True)):
        place = off[0] + 0.17 * np.cos(bearing), off[1] + 0.17 * np.sin(bearing), -0.03
        parts.append(rolling(f"w{i}", "chassis", place, bearing, 0.05, sign))
        if rollers:
            parts += [rolling(f"w{i}_roller{k}", f"w{i}", (0.0, 0.0, 0.04 * k - 0.04), bearing + np.pi / 2, 0.008) for k in (0, 2)]
    return f'<robot name="omni">{BODY}{"".join(parts)}</robot>'


KIWI = np.radians((60.0, 180.0, 300.0))
CROSS = np.radians((45.0, 135.0, 225.0, 315.0))
ROBOTS = {
    "kiwi": robot(KIWI, (1, 1, 1)),
    "kiwi with axes inwards and rollers": robot(KIWI, (-1, 1, -1), rollers=True),
    "four in a cross": robot(CROSS, (1, 1, 1, 1)),
    "kiwi about another point": robot(KIWI, (1, -1, 1), off=(0.05, -0.02)),
}


@pytest.fixture(scope="module", params=ROBOTS)
def taken(request, tmp_path_factory):
    root = tmp_path_factory.mktemp("omni")
    return root / "it", import_vehicle(write(root / "x.urdf", ROBOTS[request.param]), root / "it")


def test_it_is_an_omni_drive_without_faults(taken):
    folder, notes = taken
    assert load_vehicle(folder.parent, "it").ground.drive.kind == "omni"
    assert any("omni wheels: rollers across each" in line for line in notes)
    assert [fault for fault in inspect(folder).faults if "lidar" not in fault] == []


@pytest.mark.parametrize("twist", [(0.3, 0.0, 0.0), (0.0, 0.0, 0.3), (0.0, 0.8, 0.0), (0.2, 0.4, -0.1)])
def test_it_drives_every_way(taken, twist):
    driven = drive(taken[0], twist, 4.0)
    assert driven.pose == pytest.approx(driven.expected, abs=0.02)


def test_wheels_of_one_axle_and_a_third_are_no_omni_drive(tmp_path):
    parts = [rolling(f"w{i}", "chassis", (x, y, -0.03), np.pi / 2, 0.05) for i, (x, y) in enumerate(((0, 0.15), (0, -0.15), (-0.2, 0)))]
    import_vehicle(write(tmp_path / "x.urdf", f'<robot name="tricycle">{BODY}{"".join(parts)}</robot>'), tmp_path / "it")
    assert load_vehicle(tmp_path, "it").ground.drive.kind == "differential"
