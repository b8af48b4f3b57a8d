"""Satellites place the vehicle and hold it; they are refused when off, missed with a growing covariance, and never touch the odometry."""

import numpy as np
import pytest

from benchmarks.estimation.odometry.drive import TRACK, World, drive
from schemas.messages import Gnss, Vector3
from services.slam.odometry.readings import satellite_fix
from uvf.estimation.odometry.filter import DriveFilter
from uvf.estimation.odometry.states import GNSS_X, Noise
from uvf.estimation.odometry.world import SatellitePose
from uvf.maths.geodesy import LocalTangent
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2, compose, transform
from uvf.models.vehicle.sensors import GnssSensor, Mount
from uvf.runtime.messages.convert import stamp

TANGENT = LocalTangent.from_degrees(49.0, 8.4, 120.0)
START = Pose2(100.0, -40.0, 0.5)
ARM = (-0.3, 0.2)
GOOD = GnssSensor(hz=5.0, horizontal_noise=0.3, speed_noise=0.05, mount=Mount((*ARM, 0.5)))
SECONDS = 40.0


def fix_at(t, world_from_base, twist, rng, *, off=(0.0, 0.0), sensor=GOOD):
    """What a receiver would say there; off: m, error."""
    antenna = compose(world_from_base, Pose2(*ARM, 0.0))
    east, north = np.array(antenna[:2]) + off + rng.standard_normal(2) * sensor.horizontal_noise
    latitude, longitude, altitude = TANGENT.geodetic(np.array((east, north, 0.5)))
    forward, aside = twist.linear - twist.angular * ARM[1], twist.angular * ARM[0]
    vx, vy = transform((0.0, 0.0, world_from_base.yaw), np.array(((forward, aside),)))[0] + 0.05 * rng.standard_normal(2)
    return Gnss(
        timestamp=stamp(t),
        fix=Gnss.FIX_3D,
        latitude=latitude,
        longitude=longitude,
        altitude=altitude,
        velocity_enu=Vector3(x=vx, y=vy),
        horizontal_accuracy=float(np.hypot(sensor.horizontal_noise, sensor.horizontal_drift)),
        speed_accuracy=0.05,
    )


def driven(
    seed=1,
    *,
    kind="ekf",
    believed=START,
    known=0.1,
    sigma=0.3,
    world=None,
    when=lambda t: True,
    off=lambda t: (0.0, 0.0),
    sensor=GOOD,
    delay=5,
):
    """A drive from ``START``; per step (t, true pose, filter's pose, what is shown, sigma), and the odometry."""
    rng = np.random.default_rng(seed)
    odometry = DriveFilter(kind, Noise(), TRACK)
    pose = SatellitePose(DriveFilter(kind, Noise(), TRACK, sensor), sensor, TANGENT, (believed, known, sigma))
    rows, waiting = [], []
    for k, moment in enumerate(drive(world or World(seconds=SECONDS), seed), 1):
        true = compose(START, moment.pose)
        odometry.step(moment.step)
        pose.drive.step(moment.step)
        pose.note(moment.t, odometry.pose)
        if k % 10 == 0 and when(moment.t):
            waiting.append((k + delay, fix_at(moment.t, true, moment.twist, rng, off=off(moment.t), sensor=sensor)))
        pose.take([satellite_fix(fix) for due, fix in waiting if due == k], odometry.pose)
        rows.append((moment.t, true, pose.drive.pose, pose.shown(odometry.pose, odometry.pose, 0.004), pose.sigma, pose.is_known(moment.t)))
    return rows, odometry, pose


def error(row):
    return float(np.hypot(row[2].x - row[1].x, row[2].y - row[1].y))


@pytest.mark.parametrize("kind", ["ekf", "ukf"])
def test_a_first_fix_elsewhere_places_it_wherever_it_was_believed_to_be(kind):
    rows, _, _ = driven(kind=kind, believed=Pose2(0.0, 0.0, 0.5), world=World(seconds=3.0))
    assert error(rows[5]) > 50.0
    assert error(rows[20]) < 1.5
    assert np.hypot(rows[20][3].x - rows[20][1].x, rows[20][3].y - rows[20][1].y) < 1.5


@pytest.mark.parametrize("kind", ["ekf", "ukf"])
def test_the_heading_is_found_by_driving_and_the_place_held(kind):
    rows, _, _ = driven(2, kind=kind, world=World(seconds=20.0), believed=START._replace(yaw=START.yaw + 0.4), sigma=0.4)
    assert abs(wrap(rows[-1][2].yaw - rows[-1][1].yaw)) < 0.1
    assert error(rows[-1]) < 0.3


def test_the_lever_arm_counts():
    """Standing and turning the antenna goes round the axle; taken for the axle's place it would be 0.36 m off."""
    errors = [error(row) for row in driven(3)[0][-500:]]
    assert np.mean(errors) < 0.2


def test_the_errors_are_as_large_as_the_covariance_says():
    found = []
    for seed in range(12):
        rows, _, pose = driven(seed, world=World(seconds=8.0, radius=0.01))
        e = np.array((rows[-1][2].x - rows[-1][1].x, rows[-1][2].y - rows[-1][1].y))
        found.append(e @ np.linalg.solve(pose.drive.covariance[:2, :2], e) / 2)
    assert 0.4 < np.mean(found) < 1.9


def test_fixes_that_are_off_are_refused():
    rows, _, pose = driven(4, off=lambda t: (0.0, 0.0) if t < 20.0 or t > 24.0 else (8.0, -5.0))
    assert max(error(row) for row in rows[900:1300]) < 0.6
    assert pose.ratio < 1.0


def test_a_place_that_has_really_changed_is_believed_in_the_end():
    rows, _, _ = driven(5, off=lambda t: (0.0, 0.0) if t < 10.0 else (8.0, -5.0))
    assert error(rows[900]) < 2.0
    assert error(rows[-1]) == pytest.approx(np.hypot(8.0, 5.0), abs=1.0)


def test_without_fixes_the_uncertainty_grows_and_covers_the_error():
    rows, _, _ = driven(6, when=lambda t: t < 10.0, world=World(seconds=SECONDS, radius=0.01))
    assert rows[-1][4] > 1.3 * rows[600][4]
    assert error(rows[-1]) < 4 * rows[-1][4]
    assert rows[450][5] and not rows[-1][5]


def test_a_receiver_that_wanders_is_not_averaged_away():
    sensor = GnssSensor(hz=5.0, horizontal_noise=0.1, horizontal_drift=3.0, drift_time=1000.0, speed_noise=0.05, mount=Mount((*ARM, 0.5)))
    rows, _, pose = driven(7, known=100.0, sensor=sensor, off=lambda t: (2.0, 2.0))
    assert rows[-1][4] > 1.5
    assert error(rows[-1]) < 3 * rows[-1][4]
    seen = np.eye(2, len(pose.drive.state)) + np.eye(2, len(pose.drive.state), GNSS_X)
    assert (np.sqrt(np.diag(seen @ pose.drive.covariance @ seen.T)) < 0.12).all()  # m: where it sees itself is known well


def test_a_start_that_is_known_shows_how_far_off_the_receiver_is():
    """So the pose in the world still fits the map, which began at the start."""
    sensor = GnssSensor(hz=5.0, horizontal_noise=0.1, horizontal_drift=3.0, drift_time=1000.0, speed_noise=0.05, mount=Mount((*ARM, 0.5)))
    rows, _, _ = driven(7, sensor=sensor, off=lambda t: (2.0, 2.0))
    assert error(rows[-1]) < 0.4
    assert error(rows[-1]) < 3 * rows[-1][4]


def test_what_is_shown_creeps_and_the_odometry_is_as_without_satellites():
    rows, odometry, _ = driven(8)
    shown = np.array([row[3][:2] for row in rows[100:]])
    assert np.hypot(*np.diff(shown, axis=0).T).max() < 1.5 * 0.5 * 0.02
    _, alone, _ = driven(8, when=lambda t: False)
    assert odometry.pose == alone.pose


def test_a_fix_that_is_none_is_not_used():
    _, odometry, pose = driven(9, when=lambda t: False)
    for broken in (
        Gnss(timestamp=stamp(39.0)),
        Gnss(timestamp=stamp(39.1), fix=Gnss.FIX_3D),
        Gnss(timestamp=stamp(1e6), fix=Gnss.FIX_3D, horizontal_accuracy=1.0),
        Gnss(timestamp=stamp(39.2), fix=Gnss.FIX_3D, latitude=float("nan"), horizontal_accuracy=1.0),
    ):
        pose.take([satellite_fix(broken)], odometry.pose)
    assert not pose.is_known(40.0)
    assert pose.ratio == 0.0
