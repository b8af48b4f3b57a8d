"""Markers by what is seen of them from above, from the side, from a standing vehicle, and in one line."""

import math

import numpy as np
import pytest

from uvf.vision import MarkerMap, MarkerModel, Sighting

MODEL = MarkerModel(height=1.0, ground=0.0, ground_sigma=0.5, pose_sigma=0.2, angle_sigma=0.01, reach=60.0, least_apart=1.5)


def seen(origin, marker, rng=None, sized=True):
    """A sighting of a marker (x, y) of 1 m from ``origin``, with the errors of the model."""
    origin, middle = np.array(origin, dtype=float), np.array((*marker, 0.5))
    away = middle - origin
    if rng is not None:
        away = away + np.linalg.norm(away) * MODEL.angle_sigma * rng.standard_normal(3)
    distance = float(np.linalg.norm(away))
    noise = np.zeros(3) if rng is None else MODEL.pose_sigma * rng.standard_normal(3) * (1.0, 1.0, 0.2)
    height = math.atan(math.hypot(away[0], away[1]) / distance / distance)
    return Sighting(origin + noise, away / distance, height if sized else None)


def where(found):
    return [tuple(np.round(marker.position[:2], 2)) for marker in found.markers]


def test_from_above_one_look_tells_where_and_more_looks_tell_it_better():
    found = MarkerMap(MODEL)
    found.see(seen((2.0, 1.0, 20.0), (5.0, 3.0)))
    (marker,) = found.markers
    first = marker.sigma
    assert where(found) == [(5.0, 3.0)]
    for x in (4.0, 6.0, 8.0):
        found.see(seen((x, 1.0, 20.0), (5.0, 3.0)))
    assert (len(found.markers), marker.views) == (1, 4)
    assert marker.sigma < first


def test_on_a_mound_looks_from_several_sides_tell_its_height():
    high = MarkerMap(MODEL)
    middle = np.array((5.0, 3.0, 2.5))  # 2 m above the ground that is assumed
    for x in np.linspace(-15.0, 25.0, 12):
        origin = np.array((x, 1.0, 20.0))
        high.see(Sighting(origin, (middle - origin) / np.linalg.norm(middle - origin), None))
    (marker,) = high.markers
    assert np.abs(marker.position - middle).max() < 0.35


def test_from_the_side_the_apparent_height_tells_how_far_it_is():
    found = MarkerMap(MODEL)
    found.see(seen((0.0, 0.0, 0.2), (6.0, 2.0)))
    (marker,) = found.markers
    assert np.linalg.norm(marker.position[:2] - (6.0, 2.0)) < 0.1
    assert 0.5 < marker.sigma < 1.5  # along the ray


def test_one_from_the_side_that_is_cut_off_tells_nothing_yet():
    found = MarkerMap(MODEL)
    assert found.see(seen((0.0, 0.0, 0.2), (6.0, 2.0), sized=False)) is None
    assert found.markers == []


def test_driving_past_rays_intersect():
    found = MarkerMap(MODEL)
    for x in np.linspace(0.0, 6.0, 9):
        found.see(seen((x, 0.0, 0.2), (6.0, 4.0)))
    (marker,) = found.markers
    assert marker.sigma < 0.25
    assert np.linalg.norm(marker.position[:2] - (6.0, 4.0)) < 0.1


def test_who_stands_still_gets_no_surer():
    found = MarkerMap(MODEL)
    for _ in range(100):
        found.see(seen((0.0, 0.0, 0.2), (6.0, 2.0)))
    (marker,) = found.markers
    assert marker.views == 1 and marker.sigma > 0.5


def test_errors_are_as_large_as_they_are_said_to_be():
    rng = np.random.default_rng(3)
    ratios = []
    for _ in range(200):
        found = MarkerMap(MODEL)
        for x in np.linspace(-8.0, 8.0, 6):
            found.see(seen((x, 2.0, 20.0), (0.0, 0.0), rng))
        marker = max(found.markers, key=lambda each: each.views)
        off = marker.position - (0.0, 0.0, 0.5)
        ratios.append(float(off[:2] @ np.linalg.inv(marker.covariance[:2, :2]) @ off[:2]))
    assert 1.0 < np.mean(ratios) < 3.5  # 2 for errors that are told rightly


def test_two_that_stand_apart_are_two_and_two_that_stand_together_one():
    found = MarkerMap(MODEL)
    for x in (-4.0, 0.0, 4.0):
        for marker in ((0.0, 3.0), (3.0, 3.0), (3.4, 3.3)):
            found.see(seen((x, 0.0, 20.0), marker))
    assert len(found.markers) == 2


def test_two_in_one_line_are_told_apart_from_another_side():
    found = MarkerMap(MODEL)
    for x in np.linspace(-4.0, 4.0, 7):
        for marker in ((0.0, 4.0), (0.0, 9.0)):
            found.see(seen((x, 0.0, 0.2), marker))
    assert sorted(where(found), key=lambda place: place[1])[-1][1] == pytest.approx(9.0, abs=1.0)
    assert len([m for m in found.markers if m.views >= 3]) == 2


def test_what_is_too_far_or_in_the_sky_is_no_marker():
    found = MarkerMap(MODEL)
    assert found.see(seen((0.0, 0.0, 100.0), (70.0, 0.0))) is None
    assert found.see(Sighting(np.array((0.0, 0.0, 20.0)), np.array((0.0, 0.6, 0.8)), 0.1)) is None


def test_it_goes_on_with_what_it_knew():
    found = MarkerMap(MODEL)
    found.resume([(7, np.array((5.0, 3.0, 0.5)), 0.3, 4)])
    found.see(seen((2.0, 1.0, 20.0), (5.0, 3.0)))
    found.see(seen((2.0, 1.0, 20.0), (15.0, 3.0)))
    assert [marker.id for marker in found.markers] == [7, 8]
    assert found.markers[0].views == 5


def test_two_begun_apart_by_poor_ranges_become_one_that_keeps_the_id_of_the_one_seen_more():
    found = MarkerMap(MODEL)
    found.resume([(3, np.array((5.0, 3.0, 0.5)), 0.2, 1), (4, np.array((7.6, 3.0, 0.5)), 0.9, 6)])
    for x in np.linspace(3.0, 7.0, 9):
        found.see(seen((x, 1.0, 20.0), (6.9, 3.0)))
        found.see(seen((x, 1.0, 20.0), (5.6, 3.0)))
    assert [marker.id for marker in found.markers] == [4]
    assert found.markers[0].views > 7


def test_one_rover_that_drives_round_many_posts_tells_of_few_that_are_not_there():
    """Posts at least 4 m apart, no occlusion, errors of the model."""
    told = wrong = 0
    for seed in range(10):
        rng = np.random.default_rng(seed)
        posts: list[np.ndarray] = []
        while len(posts) < 6:
            place = rng.uniform(-12.0, 12.0, 2)
            if all(np.linalg.norm(place - other) > 4.0 for other in posts):
                posts.append(place)
        found = MarkerMap(MODEL)
        for turn in np.linspace(0.0, 2 * math.pi, 120):
            here = 7.0 * np.array((math.cos(turn), math.sin(turn)))
            for post in posts:
                if 1.0 < np.linalg.norm(post - here) < 15.0:
                    found.see(seen((*here, 0.2), post, rng))
        sure = [marker for marker in found.markers if marker.views >= 3 and marker.sigma <= 0.5]
        told += len(sure)
        wrong += sum(min(np.linalg.norm(marker.position[:2] - post) for post in posts) > 1.0 for marker in sure)
    assert told > 40 and wrong <= 0.1 * told, (told, wrong)


def test_what_was_seen_once_is_forgotten_in_time():
    found = MarkerMap(MODEL)
    for k in range(200):
        found.see(seen((3.0 * k, 0.0, 20.0), (3.0 * k, 5.0)))
    assert len(found.markers) == 50 and found.markers[-1].id == 200
