"""All sensors of a vehicle side by side: none disturbs another, and each keeps its way of delivery."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from services.sim_ground.body import BodyState, Touch
from services.sim_ground.rig import Moment, Rig
from tests.services.sim_ground.ride import site_with
from uvf.maths.geodesy import LocalTangent
from uvf.maths.kinematics import WheelSpeeds
from uvf.models.mission.fixtures import ChargerFile
from uvf.models.shapes.scene import scene
from uvf.models.vehicle.sensors import Bumper, GnssSensor, Mount, RangeFinder, Sonar
from uvf.models.world.geometry import solids
from uvf.runtime.messages.convert import seconds

PLACE = np.array((6.0, 4.4, 0.0))
STILL = BodyState(PLACE, np.array((1.0, 0, 0, 0)), np.zeros(3), np.zeros(3), (0.0, 0.0), WheelSpeeds(0.0, 0.0))
SONAR = Sonar(mount=Mount((0.1, 0.0, 0.1)), hz=10.0, fov=0.4, range_min=0.02, range_max=4.0, noise=0.01)


@pytest.fixture
def stand(tmp_path):
    """What the outputs say while the burger stands, with its sensors changed: output -> [(t, message)]."""

    def run(sensors=None, touches=lambda t: (), seconds_=2.0, seed=1):
        site = site_with(tmp_path, {"burger": (6.0, 4.4, 0.0)}, seed)
        member = site.members["burger"]
        fitted = msgspec.structs.replace(member.file.sensors, **(sensors(member.file.sensors) if sensors else {}))
        member = replace(member, file=msgspec.structs.replace(member.file, sensors=fitted))
        rig, said = Rig(site, member, member.file.ground, scene(solids(site.world))), {}
        for t in (n / 100 for n in range(1, round(seconds_ * 100) + 1)):
            for output, message in rig.read(t, Moment(STILL, touches=list(touches(t)))).items():
                said.setdefault(output, []).append((t, message))
        return said

    return run


def gyro(**changes):
    return lambda sensors: {"imu": msgspec.structs.replace(sensors.imu, **changes)}


def test_the_stream_of_a_sensor_does_not_depend_on_what_else_is_fitted(stand):
    plain = stand()
    more = stand(lambda s: {"gnss": GnssSensor(5.0, horizontal_noise=1.0), "sonars": [SONAR], "encoders": None})
    assert more["imu"] == plain["imu"]
    assert more["scan"] == plain["scan"]
    assert "wheels" in plain and "wheels" not in more


def test_the_same_seed_gives_the_same_streams_and_another_seed_others(stand):
    everything = lambda s: {"gnss": GnssSensor(5.0, horizontal_noise=1.0), "sonars": [SONAR], **gyro(dropout=0.2)(s)}  # noqa: E731
    assert stand(everything) == stand(everything)
    other = stand(everything, seed=2)
    assert all(stand(everything)[output] != other[output] for output in ("imu", "scan", "gnss", "sonar"))


def test_late_readings_keep_their_stamps(stand):
    said = stand(gyro(latency=0.03))["imu"]
    assert {round(t - seconds(message.timestamp), 6) for t, message in said} == {0.03}
    assert len(said) == 197


def test_a_reading_lost_changes_none_of_the_others(stand):
    whole, some = (dict(stand(gyro(dropout=p, burst=3))["imu"]) for p in (0.0, 0.1))
    assert 100 < len(some) < 180
    assert all(whole[t] == message for t, message in some.items())


def test_a_rate_that_does_not_divide_the_steps_is_kept(stand):
    said = stand(lambda s: {"lidar": msgspec.structs.replace(s.lidar, hz=40.0)})["scan"]
    assert len(said) == 80
    assert [round(t, 2) for t, _ in said[:4]] == [0.03, 0.05, 0.08, 0.1]


def test_each_sonar_speaks_in_its_own_frame(stand):
    rear = msgspec.structs.replace(SONAR, mount=Mount((-0.1, 0.0, 0.1), (0.0, 0.0, np.pi)), frame="rear")
    heard = stand(lambda s: {"sonars": [SONAR, rear]})["sonar"]
    assert len(heard) == 20
    assert [m.frame_id for m in heard[0][1]] == ["burger/sonar", "burger/rear"]
    assert heard[0][1][0].range != heard[0][1][1].range


def test_a_rovers_range_finder_looks_up_at_nothing_and_down_at_the_floor(stand):
    down, up = (
        RangeFinder(mount=Mount((0.0, 0.0, 0.2), (0.0, pitch, 0.0)), hz=20.0, range_min=0.01, range_max=4.0, frame=frame)
        for pitch, frame in ((np.pi / 2, "down"), (-np.pi / 2, "up"))
    )
    heard = stand(lambda s: {"rangefinders": [down, up]})["range"]
    assert len(heard) == 40
    assert [m.frame_id for m in heard[0][1]] == ["burger/down", "burger/up"]
    assert [m.range for m in heard[0][1]] == pytest.approx([0.2, 0.0])


def test_a_rover_knows_where_on_the_globe_it_is(stand):
    fix = stand(lambda s: {"gnss": GnssSensor(5.0)})["gnss"][0][1]
    enu = LocalTangent.from_degrees(40.77, 14.79, 300.0).enu(fix.latitude, fix.longitude, fix.altitude)
    assert enu == pytest.approx(PLACE, abs=1e-6)


def test_a_receiver_aside_of_the_middle_goes_round_it(stand):
    tangent = LocalTangent.from_degrees(40.77, 14.79, 300.0)
    plain, aside = (
        stand(lambda s, m=mount: {"gnss": GnssSensor(5.0, mount=m)})["gnss"][0][1] for mount in (Mount(), Mount((-0.3, 0.2, 0.5)))
    )
    places = [tangent.enu(fix.latitude, fix.longitude, fix.altitude) for fix in (plain, aside)]
    assert places[1] - places[0] == pytest.approx((-0.3, 0.2, 0.5), abs=1e-6)


def test_the_bumpers_that_feel_a_touch_are_named(stand):
    sectors = [Bumper("left", 0.0, 1.6), Bumper("right", -1.6, 0.0), Bumper("rear", 1.6, 4.7)]
    at = {0.07: Touch("sofa", 0.5), 0.12: Touch("door", -3.0), 0.13: Touch("door", -0.7)}
    said = stand(lambda s: {"bumpers": sectors}, lambda t: [at[t]] if t in at else [], 0.2)["contact"]
    assert [(m.touching, m.other, list(m.sectors)) for _, m in said] == [
        (False, "", []),
        (True, "sofa", ["left"]),
        (True, "door", ["right", "rear"]),
        (False, "", []),
    ]


@pytest.mark.parametrize(
    ("charger", "speed", "rises"),
    [((6.1, 4.4), 0.0, True), ((6.5, 4.4), 0.0, False), ((6.1, 4.4), 0.2, False), (None, 0.0, False)],
    ids=["on it", "beside it", "driving over it", "none"],
)
def test_a_vehicle_is_charged_while_it_stands_on_a_charger(tmp_path, charger, speed, rises):
    site = site_with(tmp_path, {"burger": (6.0, 4.4, 0.0)}, 1)
    member = site.members["burger"]
    half = msgspec.structs.replace(member.entry, start=msgspec.structs.replace(member.entry.start, charge=0.5))
    chargers = [] if charger is None else [ChargerFile(*charger)]
    site = replace(site, mission=msgspec.structs.replace(site.mission, chargers=chargers))
    rig = Rig(site, replace(member, entry=half), member.file.ground, scene(solids(site.world)))
    body = (
        STILL._replace(velocity=np.array((speed, 0.0, 0.0)))
        if hasattr(STILL, "_replace")
        else replace(STILL, velocity=np.array((speed, 0, 0)))
    )
    for n in range(1, 301):
        rig.read(n / 100, Moment(body))
    assert (rig.charge.remaining > 0.5) is rises


def test_further_lidars_speak_beside_the_first_which_does_not_hear_of_them(stand):
    plain = stand()
    rear = lambda s: msgspec.structs.replace(s.lidar, mount=Mount((-0.1, 0.0, 0.1), (0.0, 0.0, np.pi)), frame="rear")  # noqa: E731
    slow = lambda s: msgspec.structs.replace(s.lidar, frame="slow", sweep_time=0.1)  # noqa: E731
    said = stand(lambda s: {"other_lidars": [rear(s), slow(s)]})
    assert said["scan"] == plain["scan"]
    (t, (seen, swept)), *_ = said["other_scans"]
    assert [seen.frame_id, swept.frame_id] == ["burger/rear", "burger/slow"]
    assert seen.ranges[0] == pytest.approx(said["scan"][0][1].ranges[180], abs=0.2)
    assert t - seconds(swept.timestamp) == pytest.approx(0.1)
