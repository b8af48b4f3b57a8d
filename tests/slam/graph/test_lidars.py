"""Graph SLAM with every lidar, and with readings that are not as they should be."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.slam.evaluation.building import cast
from tests.slam.graph.buildings import HALF_ROUND, SHORT, bend, changed, mapped
from tests.slam.matching.walls import ROOM
from uvf.maths.se2 import Pose2, compose, inverse
from uvf.slam.graph.method import GraphSlam
from uvf.slam.reading import Beams, Reading


def fan(first, last, n, origin=(0.0, 0.0)):
    return Beams(origin, np.radians(np.linspace(first, last, n)), 0.1, 30.0)


LIDARS = {
    "half round": HALF_ROUND,
    "clockwise": fan(90.0, -90.0, 181),
    "ahead and turned": fan(50.0, 230.0, 181, (0.2, -0.1)),
    "all round": fan(-180.0, 179.0, 360),
    "all round, clockwise, from ahead": fan(0.0, -359.0, 360),
    "short": SHORT,
    "dense": fan(-135.0, 135.0, 1081),
}


@pytest.mark.parametrize("beams", LIDARS.values(), ids=LIDARS)
def test_any_lidar_betters_the_odometry(beams):
    driven = bend(beams)
    by_odometry = np.hypot(*(driven.log.odom_from_base - driven.map_from_base)[:, :2].T).max()
    found = mapped(driven)
    assert found.far_off < 0.15
    assert found.far_off < by_odometry
    assert found.turned_off < np.radians(1.0)


@pytest.mark.parametrize("n", [0, 1, 2, 3])
def test_a_lidar_of_a_few_beams_leaves_it_to_the_odometry(n):
    driven = bend(fan(-90.0, 90.0, n), readings=60)
    found = mapped(driven)
    assert np.abs(found.run.final - driven.log.odom_from_base)[:, :2].max() < 0.3


def every_reading_has_a_place(driven):
    found = mapped(driven)
    assert found.run.final.shape == found.run.online.shape == (len(driven.log), 3)
    assert np.isfinite(found.run.final).all()
    assert np.isfinite(found.run.covariances).all()
    return found


def test_beams_may_change_in_number_from_sweep_to_sweep():
    driven, shapes = bend(), [fan(-90.0, 90.0, n) for n in (181, 180, 61, 3, 0, 361)]
    true = np.array([np.array(p) for p in driven.map_from_base])

    def reshaped(i, reading):
        beams = shapes[i % len(shapes)]
        return Reading(reading.t, cast(true[i], beams.directions, ROOM, 30.0), beams, reading.odom_from_base)

    every_reading_has_a_place(changed(driven, reshaped))


@pytest.mark.parametrize("silent", [np.nan, np.inf, 0.0, -3.0, 99.0])
def test_without_returns_the_odometry_carries_on(silent):
    driven = bend(readings=80)
    deaf = changed(driven, lambda i, reading: replace(reading, ranges=np.full(181, silent)))
    np.testing.assert_allclose(every_reading_has_a_place(deaf).run.final, driven.log.odom_from_base, atol=1e-9)


def test_a_third_of_the_ranges_may_be_nonsense():
    rng = np.random.default_rng(5)
    nonsense = np.array((np.nan, np.inf, -np.inf, -1.0, 0.0, 1e300))

    def soiled(_, reading):
        ranges = reading.ranges.copy()
        ranges[rng.integers(0, 181, 60)] = rng.choice(nonsense, 60)
        return replace(reading, ranges=ranges)

    assert every_reading_has_a_place(changed(bend(), soiled)).far_off < 0.2


@pytest.mark.parametrize("t", [lambda r: 0.0, lambda r: -r.t, lambda r: np.nan], ids=["stands", "falls", "is no number"])
def test_time_may_be_wrong(t):
    driven = bend(readings=80)
    found = every_reading_has_a_place(changed(driven, lambda i, reading: replace(reading, t=t(reading))))
    assert found.far_off < 0.1


def test_a_vehicle_that_stands_for_hours_costs_no_keyframes():
    reading = bend(readings=2).log.readings[0]
    slam = GraphSlam()
    for _ in range(3000):
        last = slam.add(reading)
    assert last.map_from_base == (0.0, 0.0, 0.0)
    assert slam.trajectory().shape == (3000, 3)
    assert len(slam.nodes) == 1


def lost(reading):
    return replace(reading, odom_from_base=Pose2(np.nan, 0.0, 0.0))


@pytest.mark.parametrize("missing", [lambda i: i < 5, lambda i: i % 7 == 3, lambda i: 40 <= i < 70], ids=["first", "some", "for a while"])
def test_where_the_odometry_is_no_number_the_sweeps_carry_on(missing):
    found = every_reading_has_a_place(changed(bend(), lambda i, reading: lost(reading) if missing(i) else reading))
    assert found.far_off < 0.25


@pytest.mark.parametrize("leap", [Pose2(100.0, 0.0, 0.0), Pose2(2.0, -1.0, 0.0), Pose2(0.5, 0.0, 2.5), Pose2(0.0, 0.0, -1.3)], ids=str)
def test_a_leap_of_the_odometry_is_none_of_the_vehicle(leap):
    driven = bend()
    at = driven.log.readings[60].odom_from_base
    after = compose(compose(at, leap), inverse(at))

    def leapt(i, reading):
        return replace(reading, odom_from_base=compose(after, reading.odom_from_base)) if i > 60 else reading

    found = every_reading_has_a_place(changed(driven, leapt))
    assert found.far_off < 0.15
    assert found.turned_off < np.radians(1.0)


@pytest.mark.parametrize(
    "wild", [lambda i: Pose2(1e308 * (-1) ** i, 1e308, 0.0), lambda i: Pose2(50.0 * i, 0.0, 1e17 * i)], ids=["inf", "far"]
)
def test_odometry_of_wild_numbers_ends_nothing(wild):
    every_reading_has_a_place(changed(bend(readings=60), lambda i, reading: replace(reading, odom_from_base=wild(i))))


def test_wheels_whose_count_stands_still_do_not_stop_the_vehicle():
    driven = bend()
    stuck = driven.log.readings[30].odom_from_base
    found = mapped(changed(driven, lambda i, reading: replace(reading, odom_from_base=stuck) if 30 <= i < 80 else reading))
    assert found.far_off < 0.3


def test_people_around_a_standing_vehicle_do_not_push_it():
    driven, rng = bend(), np.random.default_rng(2)
    first = driven.log.readings[0]

    def crowd(_, reading):
        ranges = first.ranges.copy()
        for k in rng.integers(0, 160, 3):
            ranges[k : k + 12] = np.minimum(ranges[k : k + 12], rng.uniform(0.8, 1.5))
        return replace(first, ranges=ranges)

    assert np.hypot(*mapped(changed(driven, crowd)).run.final[:, :2].T).max() < 0.05


def test_where_little_is_seen_what_walks_does_not_carry_the_map_along():
    """A short lidar in the open, past a person who walks, and a post: the vehicle drives on by its odometry."""
    beams = Beams((0.0, 0.0), np.radians(np.arange(360.0)), 0.1, 3.5)
    slam, at = GraphSlam(), Pose2(0.0, 0.0, 0.0)
    for k in range(100):
        t = 0.2 * k
        at = Pose2(0.08 * k, 0.0, 0.0)
        ranges = np.zeros(360)
        for x, y, radius in ((1.0 + 0.1 * k, 1.2, 0.25), (3.0, -1.5, 0.1)):
            bearing, away = np.arctan2(y - at.y, x - at.x), np.hypot(x - at.x, y - at.y)
            off = np.abs(np.angle(np.exp(1j * (beams.bearings - bearing))))
            seen = (off < np.arcsin(radius / away)) & (away < 3.5)
            ranges[seen] = away * np.cos(off[seen]) - np.sqrt(radius**2 - (away * np.sin(off[seen])) ** 2)
        estimate = slam.add(Reading(t, ranges, beams, at))
    assert np.hypot(estimate.map_from_base.x - at.x, estimate.map_from_base.y - at.y) < 0.05


def about_in_a_corner(rear):
    """Largest error [rad] of the heading where a vehicle whose lidar sees one corner of a room turns about, ten times a second told where
    it turns by 3 % too little; rear: whether a second lidar sees the rest of the room.
    """
    rng, slam, worst, told, turned = np.random.default_rng(2), GraphSlam(), 0.0, 0.0, 0.0
    front, back = fan(-80.0, 80.0, 161, (0.3, 0.3)), fan(100.0, 260.0, 161, (-0.3, -0.3))
    for k in range(120):
        true, odom = Pose2(-2.4, -1.4, -2.3 + turned), Pose2(0.0, 0.0, told)
        seen_by = [np.array(compose(true, Pose2(*beams.origin, 0.0))) for beams in (front, back)]
        ranges = [cast(p, b.directions, ROOM, 30.0) + 0.01 * rng.standard_normal(161) for p, b in zip(seen_by, (front, back), strict=True)]
        others = (Reading(0.1 * k, ranges[1], back, odom),) if rear else ()
        estimate = slam.add(Reading(0.1 * k, ranges[0], front, odom, others=others))
        worst = max(worst, abs(estimate.map_from_base.yaw - turned))
        rate = 0.1 * np.sin(0.1 * k)
        turned, told = turned + rate, told + 0.97 * rate
    return worst


def test_all_lidars_tell_where_the_vehicle_is():
    assert about_in_a_corner(rear=True) < np.radians(0.6)
    assert about_in_a_corner(rear=False) > np.radians(1.0)
