"""Windsocks of the simulation: they follow the mean wind and its gusts, and a wind that is asked for."""

import math

import numpy as np
import pytest

from services.sim_air.environment.windsocks import Windsocks
from uvf.maths.rotations import rotate
from uvf.models.world.file import Windsock
from uvf.models.world.wind import Shear, TurbulenceFile, Wind, WindBegin
from uvf.runtime.messages.convert import wxyz

SOCK = Windsock("sock", (10.0, 20.0, 30.0), 6.0)
DT = 0.1


def socks(wind):
    return Windsocks((SOCK,), wind, lambda name: np.random.default_rng(1), lambda x, y: 30.0)


def points(made, t):
    (frame,) = made.step(t, DT).transforms
    assert (frame.parent_frame_id, frame.child_frame_id) == ("world", "sock")
    assert (frame.translation.x, frame.translation.y, frame.translation.z) == (10.0, 20.0, 36.0)
    return rotate(wxyz(frame.rotation), np.array((1.0, 0.0, 0.0)))


def test_it_shows_the_wind_at_the_top_of_its_pole():
    sheared = socks(Wind(steady=(0.0, 8.0, 0.0), shear=Shear("power", exponent=0.5, height=24.0)))
    assert points(sheared, 0.0) == pytest.approx((0.0, math.sin(4 / 7.72 * math.pi / 2), -math.cos(4 / 7.72 * math.pi / 2)), abs=1e-6)


def test_it_follows_a_wind_that_begins_and_one_that_is_asked_for():
    made = socks(Wind(steady=(10.0, 0.0, 0.0), begins=WindBegin(time=5.0, over=0.0, layer=0.0)))
    assert points(made, 0.0)[2] == pytest.approx(-1.0)
    times = np.arange(5.0, 15.0, DT)
    assert [points(made, t) for t in times.tolist()][-1] == pytest.approx((1.0, 0.0, 0.0), abs=0.01)
    made.blow(np.array((0.0, -10.0, 0.0)))
    assert [points(made, t) for t in (times + 10.0).tolist()][-1] == pytest.approx((0.0, -1.0, 0.0), abs=0.01)


def test_it_swings_in_turbulence():
    made = socks(Wind(steady=(6.0, 0.0, 0.0), turbulence=TurbulenceFile("light")))
    swung = np.array([points(made, t) for t in np.arange(0.0, 60.0, DT).tolist()])
    assert 0.02 < np.std(np.arctan2(swung[:, 1], swung[:, 0])) < 0.5


def test_a_world_without_any_says_nothing():
    assert Windsocks((), Wind(), lambda name: np.random.default_rng(1), lambda x, y: 0.0).step(0.0, DT) is None
