"""Harder variants of a log are what they say, and their relations stay true."""

import numpy as np
import pytest

from benchmarks.slam.evaluation.odometry_noise import EstimatedNoise, disturbed
from benchmarks.slam.evaluation.variants import VARIANTS, every_third, from_the_middle, halves, mirrored, noisier, worse
from tests.slam.evaluation.made_log import BEAMS, PERIOD, made_log, made_relations, way
from uvf.maths.se2_arrays import composed, inverted, steps
from uvf.slam.evaluation.relations import relation_errors
from uvf.slam.evaluation.run import run_over
from uvf.slam.logs.laser_log import LaserLog
from uvf.slam.methods import make_method, method_params


def chained(moved):
    """(n + 1, 3) poses from zero on."""
    poses = [np.zeros(3)]
    for step in moved:
        poses.append(composed(poses[-1], step))
    return np.array(poses)


def hits(log, i):
    """(n, 2) where the beams of a reading end, odometry frame."""
    r = log.readings[i]
    ends = np.array(r.beams.origin) + r.beams.directions * r.ranges[:, None]
    return composed(np.array(r.odom_from_base), np.column_stack((ends, np.zeros(len(ends)))))[:, :2]


@pytest.mark.parametrize("name", [n for n in VARIANTS if "x2" not in n])
def test_relations_stay_true(name):
    log, relations = VARIANTS[name](made_log(), made_relations(apart=3), way(300))
    errors = relation_errors(relations, log.stamps, log.odom_from_base)
    assert len(errors.rotation) == len(relations) > 50
    assert errors.cartographer_translation == pytest.approx(0.0, abs=1e-9)
    assert errors.rotation == pytest.approx(0.0, abs=1e-9)


def test_the_mirrored_world_is_the_image_of_the_real_one():
    log = made_log()
    image = mirrored(log, made_relations(), way(300))[0]
    for i in (0, 50, 299):
        assert hits(image, i) == pytest.approx(hits(log, i) * (1.0, -1.0))
    assert np.all(np.diff(image.readings[0].beams.bearings) < 0.0)
    assert image.odometry.odom_from_base[:, 1] == pytest.approx(-log.odometry.odom_from_base[:, 1])
    assert len({id(r.beams) for r in image}) == 1


def test_parts_begin_at_zero_and_keep_their_stamps():
    log = made_log()
    late, thin = (f(log, made_relations(), way(300))[0] for f in (from_the_middle, every_third))
    assert (len(late), len(thin)) == (150, 100)
    assert late.readings[0].odom_from_base == pytest.approx((0.0, 0.0, 0.0))
    assert steps(late.odom_from_base) == pytest.approx(steps(way(300)[150:]))
    assert thin.stamps == pytest.approx(log.stamps[::3])
    track = late.odometry
    assert track.t[0] >= late.readings[0].t - 1.0
    at_start = track.odom_from_base[np.argmin(np.abs(track.t - late.readings[0].t + 0.05))]
    assert at_start == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_two_robots_share_nothing_but_the_relations_across_the_cut():
    log = made_log()
    first, second, across = halves(log, made_relations(apart=10), 0.25)
    assert (len(first), len(second), len(across)) == (75, 225, 10)
    assert not set(first.stamps) & set(second.stamps)
    assert np.isin(across.stamps[:, 0], first.stamps).all()
    assert np.isin(across.stamps[:, 1], second.stamps).all()


def test_added_noise_has_the_spread_it_is_asked_for():
    n, noise = 20_000, EstimatedNoise(along=0.02, turning=0.1, heading_drift=0.03)
    poses = np.zeros((n, 3))
    poses[:, 0] = 0.1 * np.arange(n)
    log = made_log(n, odometry=poses)
    off = steps(disturbed(log, noise, 1).odom_from_base) - steps(poses)
    assert off[:, 0].std() == pytest.approx(0.02 * np.sqrt(0.1), rel=0.03)
    assert off[:, 2].std() == pytest.approx(0.03 * np.sqrt(0.1), rel=0.03)
    turning = np.zeros((n, 3))
    turning[:, 2] = 0.2 * np.arange(n)
    spun = steps(disturbed(made_log(n, odometry=turning), noise, 1).odom_from_base) - steps(turning)
    assert np.abs(spun[:, :2]).max() == pytest.approx(0.0, abs=1e-9)
    assert spun[:, 2].std() == pytest.approx(0.1 * np.sqrt(0.2), rel=0.03)


def test_the_noise_of_a_log_is_told_by_better_poses_and_steady_errors_are_none():
    asked = EstimatedNoise(along=0.03, turning=0.08, heading_drift=0.02)
    noisy = disturbed(made_log(9000), asked, 2).odom_from_base
    steady = steps(noisy) * (1.03, 1.03, 1.02)
    for odometry in (noisy, chained(steady)):
        found = EstimatedNoise.of(odometry, way(9000))
        assert found.along == pytest.approx(asked.along, rel=0.15)
        # Driving 2 m turns this vehicle by about 1 rad: which of the two is the cause can hardly be told, but their sum.
        asked_there, found_there = (n.heading_drift**2 * 0.1 + n.turning**2 * 0.05 for n in (asked, found))
        assert found_there == pytest.approx(asked_there, rel=0.25)
    assert EstimatedNoise.of(noisy[:50], way(50)) == EstimatedNoise()


def test_wheels_that_slipped_now_and_then_are_no_noise():
    noisy = steps(disturbed(made_log(9000), EstimatedNoise(along=0.03, turning=0.08, heading_drift=0.02), 2).odom_from_base)
    slipped = noisy.copy()
    slipped[500::2000, 0] += 1.5
    slipped[900::2000, 2] += 1.0
    usual, found = (EstimatedNoise.of(chained(moved), way(9000)) for moved in (noisy, slipped))
    assert (found.along, found.turning) == pytest.approx((usual.along, usual.turning), rel=0.2)


def test_doubled_noise_doubles_the_errors_of_the_odometry_and_is_the_same_every_time():
    relations, best = made_relations(9000, apart=2), way(9000)
    log = disturbed(made_log(9000), EstimatedNoise(along=0.03, turning=0.08, heading_drift=0.02), 3)
    once, again = noisier(log, relations, best)[0], noisier(log, relations, best)[0]
    assert np.array_equal(once.odom_from_base, again.odom_from_base)
    before, after = (relation_errors(relations, x.stamps, x.odom_from_base) for x in (log, once))
    assert after.freiburg_translation.mean() == pytest.approx(2.0 * before.freiburg_translation.mean(), rel=0.15)
    assert after.rotation.mean() == pytest.approx(2.0 * before.rotation.mean(), rel=0.15)


def test_doubled_errors_are_doubled_in_every_step():
    truth = way(300)
    odometry = chained(steps(truth) * (1.02, 1.0, 1.05) + (0.0, 0.001, 0.002))
    log = worse(made_log(odometry=odometry), made_relations(), truth)[0]
    off, twice = (steps(poses) - steps(truth) for poses in (odometry, log.odom_from_base))
    assert twice == pytest.approx(2.0 * off, abs=2e-4)


def test_the_raw_track_walks_with_the_readings():
    log = made_log()
    noisy = disturbed(log, EstimatedNoise(), 4)
    middle = noisy.odometry.t[:-1] > noisy.readings[0].t
    i = np.flatnonzero(middle)[100]
    near = np.argmin(np.abs(np.array([r.t for r in noisy]) - noisy.odometry.t[i]))
    walked = composed(inverted(np.array(noisy.readings[near].odom_from_base)), noisy.odometry.odom_from_base[i])
    was = composed(inverted(np.array(log.readings[near].odom_from_base)), log.odometry.odom_from_base[i])
    assert walked == pytest.approx(was, abs=0.02)
    assert disturbed(LaserLog("bare", log.readings, log.stamps), EstimatedNoise(), 4).odometry is None


def test_a_run_of_the_odometry_says_what_the_odometry_says():
    log, seen = made_log(), []
    run = run_over(log, make_method("odometry", method_params("odometry", {}, "test")), seen.append)
    assert run.online == pytest.approx(way(300), abs=1e-9)
    assert run.final == pytest.approx(run.online)
    assert seen[-1] == len(log)
    assert run.covariances[-1][0, 0] > run.covariances[10][0, 0] > 0.0
    assert 20 < len(run.keyframes) < len(log)
    assert run.times_real_time == pytest.approx(PERIOD * 299 / run.wall)
    assert run.keyframes[0].reading.beams is BEAMS
