"""Depth pictures, sonars and bumpers reach planner and tracker: they stop, go round, and draw back."""

import io
from math import tan

import numpy as np
import pytest
from PIL import Image

from schemas.messages import CameraCalibration, CompressedImage, Contact, NavDirective, Range
from tests.services.autopilot.ground.test_service import BODY
from tests.services.planner.planner_bench import Bench, asked, world
from tests.services.planner.test_tracker_service import TrackerBench
from uvf.maths.se3 import IDENTITY
from uvf.models.vehicle.sensors import Bumper, Camera, Mount, RangeFinder, Sensors, Sonar
from uvf.runtime.messages.convert import stamp

WIDTH, HEIGHT, FOV = 80, 60, 1.2
FOCAL = WIDTH / 2 / tan(FOV / 2)
INFO = CameraCalibration(width=WIDTH, height=HEIGHT, K=(FOCAL, 0, (WIDTH - 1) / 2, 0, FOCAL, (HEIGHT - 1) / 2, 0, 0, 1))
CAMERA = Camera(mount=Mount(xyz=(0.1, 0.0, 0.2)), hz=5.0, width=WIDTH, height=HEIGHT, fov=FOV, depth=True)
SONAR = Sonar(mount=Mount(xyz=(0.1, 0.0, 0.1)), hz=10.0, fov=0.5, range_min=0.02, range_max=3.0)
FINDER = RangeFinder(Mount((0.12, 0.0, 0.06), (0.0, 1.2, 0.0)), hz=20.0, range_min=0.005, range_max=0.3)
FITTED = Sensors(camera=CAMERA, sonars=[SONAR], rangefinders=[FINDER], bumpers=[Bumper("front", -0.8, 0.8), Bumper("rear", 2.3, 3.9)])


def picture(t, pallet):
    """A front of 0.14 m, ``pallet`` [m] ahead of the vehicle, on a floor."""
    up = ((HEIGHT - 1) / 2 - np.arange(HEIGHT)) / FOCAL
    floor = np.where(up < 0.0, 0.2 / np.maximum(-up, 1e-6), 0.0)
    depth = np.where((0.2 + up * (pallet - 0.1) < 0.14) & (pallet - 0.1 < floor), pallet - 0.1, floor)
    grey = np.repeat(np.clip(depth * 1000.0, 0.0, 60000.0).astype(np.uint16)[:, None], WIDTH, axis=1)
    out = io.BytesIO()
    Image.fromarray(grey).save(out, format="PNG")
    return CompressedImage(timestamp=stamp(t), frame_id="v/camera_optical", format="png", data=out.getvalue())


def contact(t, *sectors):
    return Contact(timestamp=stamp(t), touching=True, sectors=sectors)


def tracker(**fitted):
    return TrackerBench(IDENTITY, sensors=FITTED, **fitted)


def test_it_stops_before_a_pallet_that_the_lidar_looks_over():
    bench = tracker()
    for _ in range(60):
        bench.step(1, ahead=9.0, moves=True, depth=[picture(bench.t + 0.07, 1.5 - bench.pose[0])], info=INFO)
    assert 0.2 < bench.pose[0] < 1.5 - BODY.radius


def test_it_stops_before_what_only_a_sonar_hears():
    bench = tracker()
    for _ in range(60):
        heard = Range(timestamp=stamp(bench.t + 0.07), frame_id="v/sonar", range=max(1.5 - 0.1 - bench.pose[0], 0.0))
        bench.step(1, ahead=9.0, moves=True, sonar=[heard])
    assert 0.2 < bench.pose[0] < 1.5 - BODY.radius


@pytest.mark.parametrize("reading", [np.nan, np.inf, -1.0, 1e300])
def test_a_broken_sonar_stops_nothing(reading):
    bench = tracker()
    for _ in range(10):
        bench.step(1, ahead=9.0, moves=True, sonar=[Range(timestamp=stamp(bench.t + 0.07), frame_id="v/sonar", range=reading)])
    assert bench.pose[0] > 0.15


def test_a_picture_that_cannot_be_read_is_told_of_once_and_stops_nothing():
    bench = tracker()
    for _ in range(10):
        broken = CompressedImage(timestamp=stamp(bench.t + 0.07), frame_id="v/camera_optical", data=b"no picture")
        bench.step(1, ahead=9.0, moves=True, depth=[broken], info=INFO)
    assert bench.events.count("a depth picture is left out") == 1
    assert bench.pose[0] > 0.15


def test_it_draws_back_from_a_touch_and_goes_another_way():
    bench = tracker().step(20, ahead=9.0, moves=True)
    at = bench.pose.copy()
    bench.step(1, ahead=9.0, contact=[contact(bench.t + 0.05, "front")])
    assert bench.events == ["touched something"]
    bench.step(14, ahead=9.0, moves=True)
    assert min(x for x, _ in bench.places) <= bench.places[-1][0] <= at[0] - 0.1
    place = at[0] + BODY.radius
    bench.step(60, ahead=9.0, moves=True)
    assert bench.places[-1][0] > place + BODY.radius
    assert min(np.hypot(x - place, y) for x, y in bench.places[-60:]) > BODY.radius


def floor_seen(t, edge, x):
    """What the range finder measures that looks at the floor 0.143 m ahead of ``x`` [m], where the floor ends at ``edge`` [m]."""
    return Range(timestamp=stamp(t), frame_id="v/rangefinder", range=0.0644 if x + 0.143 < edge else 0.0)


def test_it_draws_back_from_an_edge_of_the_floor_and_tells_it_once():
    bench = tracker()
    for _ in range(60):
        bench.step(1, ahead=9.0, moves=True, range=[floor_seen(bench.t + 0.07, 1.0, bench.pose[0])])
    assert bench.events[0] == "no floor ahead"
    assert 0.7 < max(x for x, _ in bench.places) < 1.0
    assert bench.events.count("no floor ahead") < 4


@pytest.mark.parametrize("reading", [np.nan, -1.0, np.inf])
def test_what_is_no_range_is_no_floor(reading):
    bench = tracker()
    bench.step(2, ahead=9.0, range=[Range(timestamp=stamp(bench.t + 0.07), frame_id="v/rangefinder", range=reading)])
    assert bench.events == ["no floor ahead"]


def test_pushed_from_behind_as_it_stands_it_moves_off_forwards():
    bench = tracker().step(1, ahead=9.0, directive=NavDirective(number=2, action=NavDirective.STOP))
    bench.step(1, ahead=9.0, directive=NavDirective(number=2, action=NavDirective.STOP), contact=[contact(0.2, "rear")])
    bench.step(10, ahead=9.0, moves=True, directive=NavDirective(number=2, action=NavDirective.STOP))
    assert bench.pose[0] == pytest.approx(0.12, abs=0.05)
    assert bench.commands[-1] == (0.0, 0.0)


def test_the_planner_goes_round_what_was_touched_even_when_it_is_far_away_again():
    bench = Bench(sensors=FITTED)
    bench.step(goal=[asked(3.5, 1.0)])
    straight = bench.said["path"]
    for x in (1.2, 1.4, 1.6, 1.8, 2.0):
        bench.here = (x, 1.0)
        bench.step()
    bench.step(contact=[contact(bench.t + 0.2, "front")])
    bench.here = (1.0, 1.0)
    bench.step(6)
    touched_x = world(2.1, 1.0)[1]
    near = [abs(p.position.x - world(2.1, 1.0)[0]) for p in bench.said["path"].poses if abs(p.position.y - touched_x) < 0.05]
    before = [abs(p.position.x - world(2.1, 1.0)[0]) for p in straight.poses if abs(p.position.y - touched_x) < 0.05]
    assert max(before) < 0.05 < 0.12 < min(near)
