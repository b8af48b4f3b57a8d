"""The check finds what a run would wait for in vain, for the vehicles of this very mission."""

import shutil

import pytest
import yaml

from launch import catalogue
from launch.checks import check_params, wiring_problems
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput


@pytest.fixture
def root(tmp_path):
    for folder in ("vehicles/burger", "vehicles/milvus", "worlds/house", "missions"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    return tmp_path


def edit(root, vehicle, change):
    path = root / "vehicles" / vehicle / "vehicle.yaml"
    data = yaml.safe_load(path.read_text())
    change(data)
    path.write_text(yaml.safe_dump(data))


def problems(root):
    site = load_scenario(root / "missions" / "demo.yaml", root)
    hosts = catalogue.hosts(site, [k for k in catalogue.needed(site) if k.clock == "sim"])
    check_params(site, hosts)
    return list(wiring_problems(site, hosts))


def test_an_aircraft_without_the_sensor_that_its_autopilot_waits_for(root):
    edit(root, "milvus", lambda data: data["sensors"].pop("imu"))
    (line,) = problems(root)
    assert line.startswith("autopilot_air: input 'imu' (uvf/milvus/sensor/imu) is written by nobody; give milvus a sensor 'imu'")


def test_a_rover_without_lidar(root):
    edit(root, "burger", lambda data: data["sensors"].pop("lidar"))
    with pytest.raises(BadInput, match="no lidar: SLAM needs lidar"):
        problems(root)


def test_a_sensor_that_nobody_simulates(root):
    edit(root, "burger", lambda data: data["sensors"].update(air_data={"hz": 10.0}))
    assert "sensors: air_data: no simulator gives uvf/burger/sensor/air_data" in problems(root)[0]


def test_parameters_of_no_service_and_of_no_such_name(root):
    edit(root, "milvus", lambda data: data["params"].update(autopilot_ait={}))
    with pytest.raises(BadInput, match=r"params: autopilot_ait: milvus has no service 'autopilot_ait'; did you mean 'autopilot_air'"):
        problems(root)
    edit(root, "milvus", lambda data: data.update(params={"autopilot_air": {"rol_p": 1.0}}))
    with pytest.raises(BadInput, match=r"vehicle\.yaml:\d+: params: autopilot_air: rol_p: unknown key 'rol_p'; did you mean 'roll_p'"):
        problems(root)


def test_an_aircraft_that_begins_inside_a_wall(root):
    path = root / "missions" / "demo.yaml"
    data = yaml.safe_load(path.read_text())
    data["vehicles"]["milvus"]["start"] |= {"x": 12.0, "y": 8.0, "z": 1.0}
    path.write_text(yaml.safe_dump(data))
    with pytest.raises(BadInput, match=r"vehicles: milvus: start: 0\.00 m from a wall or another solid at 1 m"):
        problems(root)
