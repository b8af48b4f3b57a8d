"""What the sensors of robots of others become."""

import numpy as np
import pytest

from launch.vehicles.importing import import_vehicle
from tests.launch.vehicles.foreign_robots import import_one
from tests.launch.vehicles.test_odd_robots import hung, more, write
from uvf.models.vehicle.file import load_vehicle


def test_contact_sensors_become_bumpers_of_the_sector_that_their_shapes_take(tmp_path):
    """A bar across the front, 0.2 m ahead and 0.3 m wide, and a ring about the whole."""
    bar = '<collision><origin xyz="0.2 0 0.05"/><geometry><box size="0.01 0.3 0.02"/></geometry></collision>'
    ring = '<collision><origin xyz="0 0 0.05"/><geometry><cylinder radius="0.2" length="0.02"/></geometry></collision>'
    links = [
        f'{hung(name, shape, "0 0 0")}<gazebo reference="{name}"><sensor name="s" type="contact"/></gazebo>'
        for name, shape in (("bar", bar), ("ring", ring))
    ]
    import_vehicle(write(tmp_path / "x.urdf", more("".join(links))), tmp_path / "vehicles" / "it")
    front, whole = load_vehicle(tmp_path / "vehicles", "it").sensors.bumpers
    assert (front.name, whole.name) == ("bar", "ring")
    assert (front.angle_min, front.angle_max) == (pytest.approx(-0.65, abs=0.15), pytest.approx(0.65, abs=0.15))
    assert (whole.angle_min, whole.angle_max) == (-3.1416, 3.1416)


def test_sensors_are_taken_over_with_their_figures_and_poses(tmp_path):
    import_one(tmp_path, "gazebo_urdf")
    lidar = load_vehicle(tmp_path / "vehicles", "it").sensors.lidar
    assert (lidar.beams, lidar.hz, lidar.range_min, lidar.range_max, lidar.noise) == (720, 40.0, 0.1, 30.0, 0.02)
    assert lidar.angle_increment == pytest.approx(2 * 1.570796 / 719)
    assert lidar.mount.xyz == pytest.approx((0.03, 0.0, 0.15))  # base_link lies under the axle, 20 mm in front of theirs
    assert lidar.mount.rpy == pytest.approx((0, 0, np.pi))


def test_a_sonar_made_of_rays_does_not_take_the_lidars_place(tmp_path):
    import_one(tmp_path, "kobuki")
    sensors = load_vehicle(tmp_path / "vehicles", "it").sensors
    (sonar,) = sensors.sonars
    assert (sonar.hz, sonar.fov, sonar.range_min, sonar.range_max) == (20.0, pytest.approx(0.6), 0.03, 2.5)
    assert (sensors.lidar.beams, sensors.lidar.frame) == (90, "laser")
    for mount in (sonar.mount, sensors.lidar.mount):
        assert (mount.xyz, mount.rpy) == (pytest.approx((0.1, 0.0, 0.16)), pytest.approx((0.0, 0.0, 0.2)))


def ray(link, samples, fan, reach, rpy="0 0 0"):
    return (
        f'<link name="{link}"/><joint name="{link}_j" type="fixed"><parent link="telaio"/><child link="{link}"/>'
        f'<origin xyz="0.1 0 0.2" rpy="{rpy}"/></joint><gazebo reference="{link}"><sensor type="ray" name="{link}"><ray><scan><horizontal>'
        f"<samples>{samples}</samples><min_angle>{-fan / 2}</min_angle><max_angle>{fan / 2}</max_angle></horizontal></scan>"
        f"<range><min>0.01</min><max>{reach}</max></range></ray></sensor></gazebo>"
    )


def test_what_a_sensor_of_rays_is_follows_from_its_beams_and_where_they_go(tmp_path):
    """As the Create 3 has them: cliff sensors of one beam come first in the file; the lidar is the one that sees most all about."""
    rays = [
        ray("cliff_left", 1, 0.087, 0.15, "0 1.4 0"),
        ray("cliff_right", 1, 0.087, 0.15, "0 1.4 0"),
        ray("infrared", 5, 0.17, 0.2),
        ray("kerb_watch", 720, 2.0, 30.0, "0 0.5 0"),
        ray("rear_scan", 100, 1.5, 8.0),
        ray("top_scan", 360, 6.28, 12.0),
    ]
    notes = import_one(tmp_path, "bare", ("</robot>", "".join(rays) + "</robot>"))
    sensors = load_vehicle(tmp_path / "vehicles", "it").sensors
    assert [(f.range_max, f.mount.rpy[1], f.frame) for f in sensors.rangefinders] == [
        (0.15, pytest.approx(1.4), "cliff_left_range_1"),
        (0.15, pytest.approx(1.4), "cliff_right_range_2"),
    ]
    assert [(s.fov, s.range_max) for s in sensors.sonars] == [(pytest.approx(0.17), 0.2)]
    assert (sensors.lidar.frame, sensors.lidar.beams) == ("top_scan", 360)
    assert [(s.frame, s.beams, s.range_max) for s in sensors.other_lidars] == [("rear_scan", 100, 8.0)]
    assert any("lidars that are not level dropped" in line and "kerb_watch" in line for line in notes)
