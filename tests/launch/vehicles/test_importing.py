"""Robots of others become folders without faults that drive; what was dropped or guessed is told."""

import numpy as np
import pytest

from tests.launch.vehicles.driving import drive
from tests.launch.vehicles.foreign_robots import ROBOTS
from uvf.launch.vehicles.importing import NOTES, import_vehicle
from uvf.launch.vehicles.inspection import inspect
from uvf.runtime.params import BadInput
from uvf.runtime.vehicle_file import load_vehicle

TOLD = {
    "solidworks": ["axes turned: forward was (0, 1, 0)", "guessed: whl_l (left) and whl_r (right) drive; wheel radius 0.06 m, track 0.3 m"],
    "gazebo_urdf": [
        "included file not found, left out: somewhere_else/urdf/extras.xacro",
        "transmissions dropped",
        "plugins dropped: libgazebo_ros_laser.so",
        "meshes taken to be in millimetres",
        "castors became balls",
        "wheel radius of 0.05 m is not that of the shapes, which counts: 0.04 m",
        "inertia that no such body has, replaced by that of its box: base_link",
    ],
    "gazebo_sdf": ["caster_wheel (ball)", "plugins dropped: libsomething.so", "radar on chassis", "rates above 100 Hz lowered"],
    "skid_steer": ["skid steer is not modelled", "rear_left_joint, rear_right_joint"],
    "bare": ["masses guessed", "no collision shape in the file", "giunto_sinistra (left)"],
}


@pytest.fixture(scope="module", params=ROBOTS)
def imported(request, tmp_path_factory):
    """Name, folder and notes."""
    root = tmp_path_factory.mktemp(request.param)
    folder = root / "vehicles" / request.param
    return request.param, folder, import_vehicle(ROBOTS[request.param](root / "source"), folder, {})


def test_it_has_no_faults(imported):
    assert inspect(imported[1]).faults == []


def test_what_was_dropped_or_guessed_is_told_and_kept(imported):
    name, folder, notes = imported
    for text in TOLD[name]:
        assert any(text in line for line in notes), (text, notes)
    kept = (folder / NOTES).read_text()
    assert all(line in kept for line in notes)


def test_it_drives_a_metre_straight_on(imported):
    driven = drive(imported[1], (0.25, 0.0), 4.0)
    assert driven.pose[0] == pytest.approx(1.0, rel=0.02)
    assert abs(driven.pose[1]) < 0.02
    assert driven.tilt < 0.02


def test_it_turns_on_the_spot(imported):
    driven = drive(imported[1], (0.0, 0.8), np.pi / 0.8)
    assert np.hypot(*driven.pose[:2]) < 0.01
    assert driven.pose[2] == pytest.approx(np.pi, rel=0.02)


def import_one(tmp_path, name, edit=None, arguments=None):
    source = ROBOTS[name](tmp_path / "source")
    if edit is not None:
        assert edit[0] in source.read_text()
        source.write_text(source.read_text().replace(*edit))
    return import_vehicle(source, tmp_path / "vehicles" / "it", arguments or {})


def test_sensors_are_taken_over_with_their_figures_and_poses(tmp_path):
    import_one(tmp_path, "gazebo_urdf")
    lidar = load_vehicle(tmp_path / "vehicles", "it").sensors.lidar
    assert (lidar.beams, lidar.hz, lidar.range_min, lidar.range_max, lidar.noise) == (720, 40.0, 0.1, 30.0, 0.02)
    assert lidar.angle_increment == pytest.approx(2 * 1.570796 / 719)
    assert lidar.mount.xyz == pytest.approx((0.03, 0.0, 0.15))  # base_link lies under the axle, 20 mm in front of theirs
    assert lidar.mount.rpy == pytest.approx((0, 0, np.pi))


def test_arguments_of_the_xacro_reach_it(tmp_path):
    notes = import_one(tmp_path, "gazebo_urdf", arguments={"prefix": "left_handed_"})
    assert any("left_handed_left_wheel_joint (left)" in line for line in notes)


def test_a_robot_on_one_wheel_or_on_wings_is_refused_with_what_to_do(tmp_path):
    with pytest.raises(BadInput, match="no two wheels of one size on one axis; joints that turn: giunto_sinistra") as caught:
        import_one(tmp_path, "bare", ('name="giunto_destra" type="continuous"', 'name="giunto_destra" type="fixed"'))
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "vehicles").exists()


def test_a_folder_that_exists_is_left_alone(tmp_path):
    import_one(tmp_path, "bare")
    with pytest.raises(BadInput, match="exists"):
        import_vehicle(tmp_path / "source" / "carro.urdf", tmp_path / "vehicles" / "it", {})


@pytest.mark.parametrize(
    "text", ["", "no xml", "<html/>", "<robot/>", '<sdf version="1.6"/>', '<sdf version="1.6"><model name="x"/></sdf>']
)
def test_a_file_that_is_no_robot_is_refused_in_one_line(tmp_path, text):
    (tmp_path / "x.urdf").write_text(text)
    with pytest.raises(BadInput) as caught:
        import_vehicle(tmp_path / "x.urdf", tmp_path / "it", {})
    assert "\n" not in str(caught.value) and "x.urdf" in str(caught.value)
