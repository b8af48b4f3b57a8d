"""A vehicle on a known map: tracked, found from nothing, found again after it was carried away."""

from dataclasses import replace

import numpy as np
import pytest

from tests.planar_rays import rectangles
from tests.slam.localization.places import ROOM, SYMMETRIC, ellipse, errors, map_of, readings, seen
from uvf.maths.se2 import IDENTITY, Pose2, compose
from uvf.models.world.map_file import GridMap
from uvf.slam.localization import known_map
from uvf.slam.localization.localizer import Localizer, LocalizerState
from uvf.slam.localization.params import FilterParams
from uvf.slam.localization.particle_filter import IN_GROUP, MOST_GROUPS, ParticleFilter
from uvf.slam.localization.whole_map import MOST_KEPT, Lately
from uvf.slam.matching.cloud import cloud_of

PARAMS = FilterParams()


@pytest.fixture(scope="module")
def room():
    return map_of(ROOM)


def run(localizer, drive):
    return [localizer.add(reading) for reading in drive]


def pose(row):
    return Pose2(*np.asarray(row).tolist())


def rmse(estimates, way):
    metres, radians = errors([e.map_from_base for e in estimates], way)
    return np.sqrt((metres**2).mean()), np.sqrt((radians**2).mean())


def test_a_vehicle_is_tracked_to_centimetres(room):
    way = ellipse(80)
    estimates = run(Localizer(room, PARAMS, 1, pose(way[0] + (0.05, -0.05, 0.03))), readings(ROOM, way))
    metres, radians = rmse(estimates[5:], way[5:])
    assert metres < 0.02 and np.degrees(radians) < 0.5
    assert min(e.quality for e in estimates[5:]) > 0.7


def test_the_covariance_covers_the_error(room):
    way = ellipse(80)
    estimates = run(Localizer(room, PARAMS, 1, pose(way[0])), readings(ROOM, way, seed=4))[10:]
    off = np.array([e.map_from_base for e in estimates]) - way[10:]
    off[:, 2] = (off[:, 2] + np.pi) % (2 * np.pi) - np.pi
    nees = np.mean([d @ np.linalg.solve(e.covariance, d) for d, e in zip(off, estimates, strict=True)]) / 3.0
    assert nees < 2.0 and max(np.sqrt(e.covariance[0, 0]) for e in estimates) < 0.03


def test_wrong_beams_and_worse_odometry_do_no_harm(room):
    way = ellipse(80)
    drive = readings(ROOM, way, worse=1.3, corrupted=0.2)
    metres, radians = rmse(run(Localizer(room, PARAMS, 2, pose(way[0])), drive)[5:], way[5:])
    assert metres < 0.03 and np.degrees(radians) < 1.0


def test_what_has_been_moved_does_not_confuse(room):
    boxes = ROOM[0].copy()
    changed = (np.concatenate((boxes[:-1], rectangles(np.array(((-0.2, -1.4, 0.4, 0.3, 0.7),))))), ROOM[1])
    way = ellipse(80)
    localizer = Localizer(room, PARAMS, 3, pose(way[0]))
    metres, radians = rmse(run(localizer, readings(changed, way))[5:], way[5:])
    assert metres < 0.03 and np.degrees(radians) < 0.7
    assert localizer.state is LocalizerState.TRACKING


def test_it_is_found_from_nothing(room):
    way = ellipse(80, end=3.8 * np.pi)
    localizer = Localizer(room, PARAMS, 1)
    estimates = run(localizer, readings(ROOM, way))
    metres, _ = errors([e.map_from_base for e in estimates], way)
    assert localizer.state is LocalizerState.TRACKING
    assert metres[-20:].max() < 0.05
    assert estimates[0].quality < 0.6 < estimates[-1].quality


def test_few_particles_are_left_when_it_is_sure(room):
    way = ellipse(80, end=3.8 * np.pi)
    localizer, drive = Localizer(room, PARAMS, 1), readings(ROOM, way)
    assert len(localizer.filter.poses) == PARAMS.most_particles
    run(localizer, drive)
    assert len(localizer.filter.poses) < 0.1 * PARAMS.most_particles


def test_two_places_that_look_alike_stay_two_hypotheses_until_motion_decides():
    twins = map_of(SYMMETRIC)
    way = ellipse(60, end=1.5 * np.pi)
    mirrored = [compose(Pose2(0.0, 0.0, np.pi), pose(p)) for p in way]
    localizer = Localizer(twins, PARAMS, 5)
    run(localizer, readings(SYMMETRIC, way))
    assert localizer.state is LocalizerState.SEARCHING
    heavy = [h for h in localizer.hypotheses if h.weight > 0.02]
    wanted = (pose(way[-1]), mirrored[-1])
    assert len(heavy) == 2
    assert all(min(np.hypot(h.pose.x - w.x, h.pose.y - w.y) for h in heavy) < 0.1 for w in wanted)


def test_an_object_that_only_one_end_has_decides_between_them():
    boxes = np.concatenate((SYMMETRIC[0], rectangles(np.array(((2.6, -1.5, 0.3, 0.3, 0.0),)))))
    place = (boxes, SYMMETRIC[1])
    way = ellipse(120, end=4.5 * np.pi)
    localizer = Localizer(map_of(place), PARAMS, 6)
    metres, _ = errors([e.map_from_base for e in run(localizer, readings(place, way))], way)
    assert localizer.state is LocalizerState.TRACKING and metres[-10:].max() < 0.05


def carried_away(first, second):
    """Two drives as one log whose odometry knows nothing of what happened between them."""
    drive, then = readings(ROOM, first), readings(ROOM, second, seed=2)
    last = drive[-1].odom_from_base
    return drive + [type(r)(r.t + 100.0, r.ranges, r.beams, compose(last, r.odom_from_base)) for r in then]


def test_being_carried_away_is_noticed_and_mended(room):
    first, second = ellipse(40, end=np.pi), ellipse(120, begin=-2.5, end=4 * np.pi, size=(1.3, 0.7))
    localizer = Localizer(room, PARAMS, 7, pose(first[0]))
    states, metres = [], []
    for reading, true in zip(carried_away(first, second), np.concatenate((first, second)), strict=True):
        estimate = localizer.add(reading)
        states.append(localizer.state)
        metres.append(errors([estimate.map_from_base], true[None])[0][0])
        if states[-1] is LocalizerState.LOST:
            assert estimate.quality < 0.6
    assert LocalizerState.LOST in states[40:] and LocalizerState.LOST not in states[:40]
    assert states[-1] is LocalizerState.TRACKING and max(metres[-20:]) < 0.05


def test_a_pose_that_is_set_counts(room):
    way = ellipse(40)
    localizer = Localizer(room, PARAMS, 1)
    drive = readings(ROOM, way)
    run(localizer, drive[:2])
    localizer.set_pose(pose(way[2]))
    estimates = run(localizer, drive[2:])
    assert localizer.state is LocalizerState.TRACKING and rmse(estimates, way[2:])[0] < 0.03


def test_a_sweep_without_a_return_changes_nothing(room):
    way = ellipse(20)
    drive = readings(ROOM, way)
    blind = [type(r)(r.t, np.zeros(360), r.beams, r.odom_from_base) for r in drive]
    localizer = Localizer(room, PARAMS, 1, pose(way[0]))
    estimates = run(localizer, blind)
    moved = compose(pose(way[0]), drive[-1].odom_from_base)
    assert np.allclose(estimates[-1].map_from_base[:2], moved[:2], atol=0.1)


def test_a_map_of_cells_serves_too(room):
    grid = GridMap(np.where(room.grid.cells > 50, 100, np.where(room.grid.cells >= 0, 0, -1)).astype(np.int8), 0.05, room.grid.origin)
    way = ellipse(80)
    localizer = Localizer(known_map.of_grid(grid), PARAMS, 1, pose(way[0]))
    metres, radians = rmse(run(localizer, readings(ROOM, way))[5:], way[5:])
    assert metres < 0.03 and np.degrees(radians) < 0.7


def test_who_turns_on_the_spot_for_hours_keeps_no_more_of_what_was_seen(room):
    way = np.column_stack((np.full(200, -0.3), np.full(200, 0.1), 0.25 * np.arange(200)))
    lately = Lately()
    for at, reading in zip(way, readings(ROOM, way, worse=1.0), strict=True):
        lately.add(pose(at), cloud_of(reading).points)
    assert lately.way == 0.0 and len(lately) == MOST_KEPT


def test_a_lidar_that_shows_another_room_each_time_costs_no_more_particles_each_time(room):
    rng, localizer = np.random.default_rng(3), Localizer(room, FilterParams(most_particles=500), 1)
    for k, reading in enumerate(readings(ROOM, ellipse(120))):
        anywhere = rng.uniform((-1.5, -0.8, -3.0), (1.5, 0.8, 3.0))
        localizer.add(replace(reading, ranges=seen((SYMMETRIC, ROOM)[k % 2], anywhere, rng)))
    assert len(localizer.filter.poses) < 500 + 2 * MOST_GROUPS * IN_GROUP


def test_odometry_that_is_no_number_is_a_step_that_nobody_knows(room):
    way = ellipse(40)
    drive = readings(ROOM, way)
    for k, wrong in ((20, np.nan), (25, np.inf)):
        drive[k] = replace(drive[k], odom_from_base=Pose2(wrong, 0.0, wrong))
    estimates = run(Localizer(room, PARAMS, 1, pose(way[0])), drive)
    assert errors([estimates[-1].map_from_base], way[-1:])[0][0] < 0.05


def test_the_same_seed_gives_the_same_poses(room):
    way = ellipse(30)
    runs = [[e.map_from_base for e in run(Localizer(room, PARAMS, 8), readings(ROOM, way))] for _ in range(2)]
    assert runs[0] == runs[1] and runs[0][0] != IDENTITY


def test_headings_on_both_sides_of_a_half_turn_lie_near_each_other(room):
    particles = ParticleFilter(room, (50, 500), np.random.default_rng(1))
    particles.begin_at(Pose2(1.0, 1.0, np.pi), np.diag((0.01, 0.01, 0.04)))
    particles.poses[:, 2] = np.arctan2(np.sin(particles.poses[:, 2]), np.cos(particles.poses[:, 2]))
    assert np.ptp(particles.poses[:, 2]) > 6.0
    assert np.diag(particles.spread()) == pytest.approx((0.01, 0.01, 0.04), rel=0.6)
