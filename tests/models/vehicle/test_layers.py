"""Variants lie over the vehicle they are made of; sensors may sit on links."""

import shutil

import numpy as np
import pytest
import yaml

from launch.attachments import attachments
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput


@pytest.fixture
def vehicles(tmp_path):
    shutil.copytree(ROOT / "vehicles" / "burger", tmp_path / "vehicles" / "burger")
    return tmp_path / "vehicles"


def write(vehicles, name, **data):
    (vehicles / name).mkdir(exist_ok=True)
    (vehicles / name / "vehicle.yaml").write_text(yaml.safe_dump(data))


def test_a_variant_says_only_what_is_different(vehicles):
    write(vehicles, "slow", variant_of="burger", ground={"max_linear": 0.1}, sensors={"lidar": {"noise": 0.5}})
    write(vehicles, "slower", variant_of="slow", ground={"max_angular": 0.2})
    base, variant = load_vehicle(vehicles, "burger"), load_vehicle(vehicles, "slower")
    assert (variant.ground.max_linear, variant.ground.max_angular) == (0.1, 0.2)
    assert variant.ground.drive == base.ground.drive
    assert (variant.sensors.lidar.noise, variant.sensors.lidar.beams) == (0.5, base.sensors.lidar.beams)
    assert variant.sensors.imu == base.sensors.imu
    assert (vehicles / "slower" / variant.ground.urdf).resolve() == vehicles / "burger" / "burger.urdf"


def test_a_variants_own_file_comes_first(vehicles):
    write(vehicles, "other", variant_of="burger")
    shutil.copy(vehicles / "burger" / "burger.urdf", vehicles / "other" / "burger.urdf")
    assert load_vehicle(vehicles, "other").ground.urdf == "burger.urdf"


@pytest.mark.parametrize(
    ("base", "why"),
    [("burgr", "no vehicle 'burgr' beside it; did you mean 'burger'?"), ("other", "is a variant of this one"), (3, "3 is not text")],
)
def test_a_variant_of_nothing_or_of_itself_is_refused(vehicles, base, why):
    write(vehicles, "other", variant_of=base)
    with pytest.raises(BadInput, match=r"other/vehicle.yaml:1") as caught:
        load_vehicle(vehicles, "other")
    assert why in str(caught.value)


def test_a_sensor_on_a_link_has_its_pose(vehicles):
    write(vehicles, "other", variant_of="burger", sensors={"lidar": {"mount": {"link": "wheel_left_link", "xyz": [0.0, 0.0, 0.1]}}})
    assert np.allclose(load_vehicle(vehicles, "other").sensors.lidar.mount.xyz, (0.0, 0.08, 0.133))


def test_a_sensor_on_no_link_is_refused_with_its_line(vehicles):
    write(vehicles, "other", variant_of="burger", sensors={"lidar": {"mount": {"link": "lidr"}}})
    with pytest.raises(BadInput, match=r"other/vehicle.yaml:\d+: sensors: lidar: mount: link: no link 'lidr' in burger.urdf; did you mean"):
        load_vehicle(vehicles, "other")


def test_a_log_holds_the_vehicle_that_a_variant_is_made_of(vehicles):
    write(vehicles, "other", variant_of="burger")
    shutil.copytree(ROOT / "worlds" / "house", vehicles.parent / "worlds" / "house")
    mission = vehicles.parent / "missions" / "m.yaml"
    mission.parent.mkdir()
    entry = {"model": "other", "system_id": 1, "start": {"x": 6.0, "y": 4.4, "yaw": 0.0}}
    mission.write_text(yaml.safe_dump({"about": "x", "world": "house", "vehicles": {"one": entry}}))
    files = attachments(load_scenario(mission, vehicles.parent))
    assert {"vehicles/other/vehicle.yaml", "vehicles/burger/vehicle.yaml", "vehicles/burger/burger.urdf"} <= set(files)
