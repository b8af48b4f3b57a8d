"""Sensors by name in a vehicle's file: what they stand for, and what is said of a wrong one."""

import math
import shutil

import pytest
import yaml

from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput
from uvf.sensors.fitted import sweeping_of


@pytest.fixture
def sensors_of(tmp_path):
    """Loads the burger with other sensors."""
    shutil.copytree(ROOT / "vehicles/burger", tmp_path / "burger")
    path = tmp_path / "burger/vehicle.yaml"

    def load(**sensors):
        path.write_text(yaml.safe_dump({**yaml.safe_load(path.read_text()), "sensors": sensors}))
        return load_vehicle(tmp_path, "burger").sensors

    return load


@pytest.mark.parametrize(
    ("preset", "beams", "field", "reach"), [("lds01", 360, 359, 3.5), ("utm30lx", 1081, 270, 30.0), ("ust10", 1081, 270, 10.0)]
)
def test_a_scanner_by_name(sensors_of, preset, beams, field, reach):
    lidar = sensors_of(lidar={"preset": preset, "mount": {}}).lidar
    assert (lidar.beams, lidar.range_max) == (beams, reach)
    assert math.degrees((lidar.beams - 1) * lidar.angle_increment) == pytest.approx(field)


def test_what_is_written_beside_a_preset_counts(sensors_of):
    lidar = sensors_of(lidar={"preset": "utm30lx", "mount": {}, "hz": 10.0, "dropout": 0.1, "latency": 0.025}).lidar
    assert (lidar.hz, lidar.dropout, lidar.latency, lidar.range_max) == (10.0, 0.1, 0.025, 30.0)


def test_receivers_by_name(sensors_of):
    good, book = (sensors_of(gnss={"preset": name}).gnss for name in ("good", "book"))
    assert good.accuracy == (0.3, 0.5)
    assert (good.horizontal_drift, good.vertical_drift) == (0.0, 0.0)
    assert (book.horizontal_noise, book.drift_time) == (0.0, 1100.0)
    eta = math.sqrt(1 - math.exp(-2 / 1100))  # the increment's share in a second, eq. 7.17
    assert (book.horizontal_drift * eta, book.vertical_drift * eta) == pytest.approx((0.21, 0.40), rel=1e-3)


def test_the_books_receiver_samples_once_a_second(sensors_of):
    assert sensors_of(gnss={"preset": "book"}).gnss.hz == 1.0


def test_the_books_gyros_accelerometers_and_pressures(sensors_of):
    book = sensors_of(imu={"preset": "book", "mount": {}}, air_data={"preset": "book", "hz": 20.0})
    assert (math.degrees(book.imu.gyro_noise), book.imu.accel_noise / 9.80665) == pytest.approx((0.13, 0.0025))
    air = book.air_data
    assert (air.static_noise, air.static_bias, air.differential_noise, air.differential_bias, air.hz) == (10.0, 125.0, 2.0, 20.0, 20.0)


def refusal(sensors_of, **sensors):
    with pytest.raises(BadInput) as caught:
        sensors_of(**sensors)
    return str(caught.value)


def test_an_unknown_preset_is_named_with_its_line(sensors_of):
    text = refusal(sensors_of, lidar={"preset": "utm30", "mount": {}})
    assert "vehicle.yaml:" in text
    assert "sensors: lidar: preset: no preset 'utm30'; did you mean 'utm30lx'?" in text


def test_a_preset_does_not_hide_an_unknown_key(sensors_of):
    assert "unknown key 'beems'; did you mean 'beams'?" in refusal(sensors_of, lidar={"preset": "lds01", "mount": {}, "beems": 90})


@pytest.mark.parametrize("data", [[], "lidar", None, 7])
def test_a_section_that_is_none_is_refused_as_ever(sensors_of, data):
    assert "sensors" in refusal(sensors_of, gnss=data if data is not None else [])


SLOW = {"preset": "lds01", "mount": {}, "sweep_time": 0.2}


def test_a_lidar_may_take_its_time(sensors_of):
    lidar = sensors_of(lidar={**SLOW, "clockwise": True}).lidar
    assert (lidar.sweep_time, lidar.clockwise, sweeping_of(lidar)) == (0.2, True, (0.2, True))
    assert sweeping_of(sensors_of(lidar={"preset": "lds01", "mount": {}}).lidar) == (0.0, False)


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"hz": 10.0}, "sensors: lidar: sweep_time: 0.2 s is longer than from scan to scan, 0.1 s; lower it"),
        ({"sweep_time": -0.1}, "sweep_time"),
        ({"sweep_time": 2.0, "hz": 0.1}, "sweep_time"),
        ({"sweep_time": "slow"}, "sweep_time"),
        ({"clockwise": 3}, "clockwise"),
    ],
)
def test_a_sweep_that_cannot_be_is_refused_in_one_line(sensors_of, changed, told):
    text = refusal(sensors_of, lidar={**SLOW, **changed})
    assert told in text
    assert "\n" not in text


def test_an_aircrafts_lidar_takes_all_beams_at_once(tmp_path):
    for name in ("milvus", "milvus_survey"):
        shutil.copytree(ROOT / "vehicles" / name, tmp_path / name)
    path = tmp_path / "milvus_survey/vehicle.yaml"
    data = yaml.safe_load(path.read_text())
    data["sensors"]["lidar"]["sweep_time"] = 0.02
    path.write_text(yaml.safe_dump(data))
    with pytest.raises(BadInput) as caught:
        load_vehicle(tmp_path, "milvus_survey")
    assert "sensors: lidar: sweep_time: an aircraft's lidar takes all beams at once; leave it out" in str(caught.value)
    assert "\n" not in str(caught.value)


SONAR = {"mount": {}, "hz": 10.0, "fov": 0.5, "range_min": 0.02, "range_max": 4.0}


def test_two_sonars_need_two_frames(sensors_of):
    assert "sonars[1]: a second sonar with frame 'sonar'" in refusal(sensors_of, sonars=[SONAR, SONAR])
    assert len(sensors_of(sonars=[SONAR, {**SONAR, "frame": "rear_sonar"}]).sonars) == 2


def test_limits_the_wrong_way_round_are_refused(sensors_of):
    assert "range_min: 5 m is not below range_max, 4 m" in refusal(sensors_of, sonars=[{**SONAR, "range_min": 5.0}])
    bumper = {"name": "front", "angle_min": 0.5, "angle_max": -0.5}
    assert "bumpers[0]: angle_min: 0.5 rad is not below angle_max" in refusal(sensors_of, bumpers=[bumper])


LDS = {"preset": "lds01", "mount": {"xyz": [0, 0, 0.2]}}


def test_further_lidars_take_presets_and_frames_of_their_own(sensors_of):
    found = sensors_of(lidar=LDS, other_lidars=[{**LDS, "frame": "rear", "hz": 10.0}])
    assert [(lidar.frame, lidar.beams, lidar.hz) for lidar in found.lidars] == [("lidar", 360, 5.0), ("rear", 360, 10.0)]
    assert "other_lidars[0]: a second lidar with frame 'lidar'; give each a frame" in refusal(sensors_of, lidar=LDS, other_lidars=[LDS])
    assert "other_lidars: there is no first one; give one of them as 'lidar'" in refusal(sensors_of, other_lidars=[LDS])
    assert "other_lidars[0]: preset: no preset 'lds1'; did you mean 'lds01'?" in refusal(
        sensors_of, lidar=LDS, other_lidars=[{**LDS, "preset": "lds1"}]
    )
