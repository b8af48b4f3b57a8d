"""What moves is found where it is, as fast as it is; what stands is not found, however the vehicle turns."""

import numpy as np
import pytest

from tests.planning.moving.scans import DT, Lidar, follow, nearest
from uvf.planning.moving.tracks import MovingObjects, SeenFrom

ROOM = [(0.0, 8.0), (np.pi / 2, 6.0), (np.pi, 7.0), (-np.pi / 2, 6.0)]
"""Walls of a room round the origin: angle of the outward normal, distance."""


def seen_from(beams):
    return SeenFrom((0.0, 0.0), np.zeros(beams, dtype=np.bool_))


def straight(x, y, vx, vy, radius=0.5):
    return lambda t: np.array(((x + vx * t, y + vy * t, radius),))


@pytest.mark.parametrize("radius", [0.15, 0.3, 0.5])
@pytest.mark.parametrize("speed", [0.5, 1.5, 3.0])
def test_a_disc_that_passes_is_followed_with_its_place_speed_and_radius(radius, speed):
    discs = straight(4.0, -1.5, 0.0, speed, radius)
    for t, tracker, _, _, _ in follow(discs, min(1.5, 3.0 / speed), walls=ROOM):
        if t < max(0.5, 0.5 / speed):
            continue
        found, away = nearest(tracker.moving(), discs(t)[0])
        assert away < 0.12
        assert np.hypot(found[2], found[3] - speed) < 0.15 + 0.1 * speed
        assert abs(found[4] - radius) < 0.1


def test_a_disc_is_known_to_move_within_a_second_and_nothing_else_is():
    discs = straight(5.0, -2.0, -0.5, 1.0)
    for t, tracker, _, _, _ in follow(discs, 2.0, walls=ROOM):
        found = tracker.moving()
        assert len(found) <= 1
        assert t < 1.0 or len(found) == 1


@pytest.mark.parametrize("speed", [0.8, 2.0])
def test_what_is_round_is_known_to_move_at_once(speed):
    """It has then gone a little more than the 0.1 m that anything must have gone."""
    discs = straight(3.0, -1.0, 0.3, speed)
    for t, tracker, _, _, _ in follow(discs, 0.5, walls=ROOM):
        assert len(tracker.moving()) == 1 or t <= 0.1 + 0.12 / speed


def stays_found(discs, seconds):
    """The first disc, which moves at 1.5 m/s along y, from 0.5 s on."""
    for t, tracker, _, _, _ in follow(discs, seconds, walls=ROOM):
        if t > 0.5:
            found, away = nearest(tracker.moving(), discs(t)[0])
            assert away < 0.1, f"lost at {t} s"
            assert found[3] == pytest.approx(1.5, abs=0.3)


def test_a_round_thing_that_passes_along_a_wall_is_followed():
    """It touches the wall at x = 8 m from 0.75 s on."""

    def discs(t):
        return np.array(((7.5 - max(0.4 - 0.5 * t, 0.02), -2.0 + 1.5 * t, 0.5),))

    stays_found(discs, 2.5)


def test_round_things_that_run_into_each_other_are_followed_through():
    """Discs of animated worlds do; their middles come as near as 0.55 m."""

    def discs(t):
        return np.array(((4.0, -1.5 + 1.5 * t, 0.5), (4.55, 1.5 - 1.5 * t, 0.4)))

    stays_found(discs, 2.0)


def test_the_mask_is_of_the_beams_that_see_it():
    discs = straight(3.0, -1.0, 0.0, 1.0)
    for t, _, mask, ranges, points in follow(discs, 1.5, walls=ROOM):
        on_it = (ranges > 0.0) & (np.hypot(points[:, 0] - discs(t)[0, 0], points[:, 1] - discs(t)[0, 1]) < 0.55)
        assert not (mask & ~on_it).any()
        if t > 0.6:
            assert mask[on_it].all()


def braking(t):
    """Comes at 2 m/s, brakes by 2 m/s^2 to a stand at 2 s and goes back as it came."""
    return np.array(((5.0 - 2.0 * t + t * t, -1.0, 0.5),))


def test_what_turns_back_moves_all_the_time():
    for t, tracker, _, _, _ in follow(braking, 3.0, walls=ROOM):
        assert t < 0.3 or len(tracker.moving()) == 1, f"lost at {t} s"


def test_a_round_thing_that_comes_out_of_a_wall_is_known_before_it_has_left_it():
    """Its middle is in the wall, at x = 8 m, until 0.5 s, and it is off the wall from 1.2 s on."""
    discs = straight(8.4, 0.5, -0.8, 0.3)
    known = [t for t, tracker, _, _, _ in follow(discs, 2.0, walls=ROOM) if len(tracker.moving())]
    assert known[0] < 0.85
    assert np.diff(known).max() < 0.06 and known[-1] > 1.9


def test_its_velocity_follows_a_turn():
    """Half a second after a corner the new velocity is the one that counts."""

    def discs(t):
        corner = min(t, 1.0)
        return np.array(((4.0, -1.2 + 1.5 * corner, 0.4),)) + np.array((-1.5 * max(t - 1.0, 0.0), 0.0, 0.0))

    for t, tracker, _, _, _ in follow(discs, 2.0, walls=ROOM):
        if t > 1.5:
            found, _ = nearest(tracker.moving(), discs(t)[0])
            assert np.hypot(found[2] + 1.5, found[3]) < 0.3


def test_two_that_cross_keep_their_velocities():
    def discs(t):
        return np.array(((4.0, -2.0 + 1.2 * t, 0.3), (5.5, 2.0 - 1.2 * t, 0.3)))

    for t, tracker, _, _, _ in follow(discs, 3.2, walls=ROOM):
        if 1.0 < t < 1.2 or t > 2.8:
            for place, speed in zip(discs(t), (1.2, -1.2), strict=True):
                found, away = nearest(tracker.moving(), place)
                assert away < 0.2 and found[3] == pytest.approx(speed, abs=0.3)


def test_one_that_goes_behind_another_thing_is_kept_in_mind_and_found_again():
    """A pillar hides it for about half a second."""

    def discs(t):
        return np.array(((6.0, -2.0 + 1.5 * t, 0.3), (2.0, 0.0, 0.25)))

    hidden = 0
    for t, tracker, _, ranges, points in follow(discs, 2.6, walls=ROOM):
        seen = ((ranges > 0.0) & (np.hypot(points[:, 0] - discs(t)[0, 0], points[:, 1] - discs(t)[0, 1]) < 0.35)).any()
        hidden += not seen
        if t > 0.6:
            _, away = nearest(tracker.moving(), discs(t)[0])
            assert away < 0.4, f"lost at {t} s"
            assert len(tracker.moving()) == 1
    assert hidden >= 5


def test_one_that_comes_out_from_behind_a_pillar_is_found():
    def discs(t):
        return np.array(((4.0, -1.0 + 1.5 * t, 0.3), (2.0, -0.5, 0.4)))

    *_, last = follow(discs, 2.0, walls=ROOM)
    t, tracker = last[0], last[1]
    found, away = nearest(tracker.moving(), discs(t)[0])
    assert away < 0.15 and found[3] == pytest.approx(1.5, abs=0.3)


def test_one_that_is_gone_is_forgotten():
    def discs(t):
        return np.array(((3.0, -1.0 + t, 0.4),)) if t < 1.0 else np.zeros((0, 3))

    for t, tracker, _, _, _ in follow(discs, 2.0, walls=ROOM):
        if 0.7 < t < 1.0:
            assert len(tracker.moving()) == 1
        if t > 1.4:
            assert len(tracker.moving()) == 0


def test_one_that_stops_stands():
    def discs(t):
        return np.array(((3.0, -1.0 + min(t, 1.0), 0.4),))

    for t, tracker, _, _, _ in follow(discs, 2.5, walls=ROOM):
        if t > 1.8:
            assert len(tracker.moving()) == 0


STANDING = np.array(((2.0, 0.5, 0.1), (3.0, -1.0, 0.5), (1.5, -1.2, 0.2), (4.5, 2.0, 0.3), (2.6, 1.9, 0.075), (-2.0, 1.0, 0.4)))


@pytest.mark.parametrize("turn_rate", [0.0, 0.7, -2.0])
@pytest.mark.parametrize("speed", [0.0, 1.0])
def test_nothing_moves_in_a_static_world_while_the_vehicle_drives_and_turns(turn_rate, speed):
    def pose_at(t):
        if turn_rate == 0.0:
            return speed * min(t, 1.4), 0.0, 0.0
        return speed / turn_rate * np.sin(turn_rate * t), speed / turn_rate * (1.0 - np.cos(turn_rate * t)) - 0.2, turn_rate * t

    wrong = 0
    for _, tracker, mask, _, _ in follow(lambda t: STANDING, 3.0, walls=ROOM, pose_at=pose_at):
        wrong += len(tracker.moving()) > 0 or mask.any()
    assert wrong == 0


@pytest.mark.parametrize(
    "lidar",
    [
        Lidar(view=np.deg2rad(20.0), beams=80),
        Lidar(beams=2000, noise=0.01),
        Lidar(view=np.deg2rad(359.0), beams=360, noise=0.01),
        Lidar(noise=0.02),
    ],
    ids=["20 deg", "2000 beams", "full circle, 1 cm", "2 cm"],
)
def test_lidars_of_other_kinds(lidar):
    discs = straight(5.0, -0.3, -1.0, 0.1)
    *_, last = follow(discs, 2.0, walls=ROOM, lidar=lidar)
    found, away = nearest(last[1].moving(), discs(last[0])[0])
    assert away < 0.2 and np.hypot(found[2] + 1.0, found[3] - 0.1) < 0.35


def test_scans_without_any_return_and_without_beams():
    *_, last = follow(lambda t: np.zeros((0, 3)), 0.5)
    assert not len(last[1].moving()) and not last[2].any()
    empty = MovingObjects()
    assert empty.observe(0.0, np.zeros((0, 2)), np.zeros(0), seen_from(0)).shape == (0,)
    assert empty.moving().shape == (0, 5)


def test_a_scan_that_is_no_newer_changes_nothing():
    discs = straight(3.0, -1.0, 0.0, 1.0)
    *_, (t, tracker, _, ranges, points) = follow(discs, 1.0, walls=ROOM)
    before = tracker.moving()
    assert not tracker.observe(t, points, ranges, seen_from(len(ranges))).any()
    assert np.array_equal(tracker.moving(), before)
    assert tracker.observe(t + DT, points, ranges, seen_from(len(ranges))).any()
