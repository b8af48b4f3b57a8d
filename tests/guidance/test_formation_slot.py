"""A station behind a leader is taken up and kept, in wind, on circles, aside of the trail; without a leader the follower holds."""

import math

import numpy as np
import pytest

from schemas.messages import NavState, Vector3
from services.autopilot.air.mode_manager import ModeManager
from services.autopilot.air.mode_table import FlightMode
from services.autopilot.air.modes.follower import FollowMode, FormationLink
from tests.services.autopilot.air.states import PARAMS, Kinematic, cruising
from uvf.control.commands import AltitudeAirspeedSetpoint
from uvf.guidance.formation_slot import FormationSlot, LateralOffset, SlotKeeping, _slowest
from uvf.guidance.leader_track import LeaderReport, LeaderTrack, TrackPoint
from uvf.runtime.messages.convert import stamp

DT = 0.02


class Pair:
    """A leader on a path of headings, and a follower that flies what it is asked for, in a steady wind."""

    SPEED_LAG = 1.0  # s

    def __init__(self, station, rate=0.0, wind=(0.0, 0.0), late=0.0):
        """rate: rad/s, of the leader's heading; late: m, of the follower at the beginning."""
        self.wind, self.rate, self.t = wind, rate, 0.0
        self.leader, self.heading = np.zeros(2), 0.0
        self.trail, self.keeping = LeaderTrack(), SlotKeeping(station)
        self.follower = Kinematic(-station.behind * (25 + wind[0]) / 25 - late, station.right, wind=wind)
        self.airspeed = self.pace = 25.0
        self.seen = []

    def fly(self, seconds, rate=None):
        self.rate = self.rate if rate is None else rate
        for _ in range(round(seconds / DT)):
            self._lead()
            now = self._estimate()
            steered = self.keeping.step(self.trail, self.t, now, PARAMS, DT)
            self.seen.append((self.t, steered.late, steered.aim.error, steered.airspeed))
            self._follow(now, steered)
        return self

    def _lead(self):
        v = 25.0 * np.array((math.cos(self.heading), math.sin(self.heading))) + self.wind
        self.trail.add(LeaderReport(self.t, *self.leader, 60.0, *v, 0.0, self.pace))
        self.leader, self.heading, self.t = self.leader + v * DT, self.heading + self.rate * DT, self.t + DT

    def _estimate(self):
        f = self.follower
        v = self.airspeed * np.array((math.cos(f.heading), math.sin(f.heading))) + self.wind
        return cruising(
            north=f.position[0], east=f.position[1], ground_speed=math.hypot(*v), course=math.atan2(v[1], v[0]), yaw=f.heading,
            roll=f.roll, airspeed=self.airspeed, wind_north=self.wind[0], wind_east=self.wind[1],
        )  # fmt: skip

    def _follow(self, now, steered):
        f = self.follower
        f.roll += DT / f.LAG * (f.steering.bank(steered.aim, now, PARAMS, DT) - f.roll)
        f.heading += DT * 9.80665 / self.airspeed * math.tan(f.roll)
        f.position = [
            f.position[0] + DT * now.ground_speed * math.cos(now.course),
            f.position[1] + DT * now.ground_speed * math.sin(now.course),
        ]
        wanted = min(max(steered.airspeed, PARAMS.min_airspeed), PARAMS.max_airspeed)
        self.airspeed += DT / self.SPEED_LAG * (wanted - self.airspeed)

    def since(self, t):
        return np.array([row for row in self.seen if row[0] >= t])

    @property
    def apart(self):
        return float(np.hypot(*(self.leader - self.follower.position)))


def test_a_late_follower_catches_up_and_stays():
    pair = Pair(FormationSlot(40.0), late=60.0).fly(40.0)
    assert np.abs(pair.since(30.0)[:, 1]).max() < 0.5
    assert pair.apart == pytest.approx(40.0, abs=1.0)


@pytest.mark.parametrize("wind", [(10.0, 0.0), (-10.0, 0.0), (0.0, 10.0), (6.0, -6.0)])
def test_corners_in_wind_are_flown_after_the_leader_at_its_airspeed(wind):
    pair = Pair(FormationSlot(40.0), wind=wind).fly(15.0)
    for rate in (0.4, -0.4, 0.3):
        pair.fly(4.0, rate).fly(10.0, 0.0)
    settled = pair.since(15.0)
    assert np.sqrt(np.mean(settled[:, 1] ** 2)) < 1.0
    assert np.abs(settled[:, 2]).max() < 3.0
    assert np.abs(settled[:, 3] - 25.0).max() < 2.0


@pytest.mark.parametrize("right", [15.0, -15.0])
def test_on_a_circle_the_wing_flies_another_radius_at_another_speed(right):
    pair = Pair(FormationSlot(40.0, right), rate=0.2).fly(60.0)
    settled = pair.since(50.0)
    assert np.abs(settled[:, 1:3]).max() < 1.0
    assert settled[:, 3].mean() == pytest.approx(25.0 - 0.2 * right, abs=0.3)


def test_an_offset_swings_round_no_faster_than_airspeed_allows_and_arrives():
    boom, arm, rate = LateralOffset(20.0), 20.0, 0.5
    spare = 0.5 * min(PARAMS.max_airspeed - PARAMS.trim_airspeed, PARAMS.trim_airspeed - PARAMS.min_airspeed)
    offsets, speeds = [], []
    for i in range(1500):
        course = min(i * DT * rate, math.pi / 2)
        offset, moves = boom.step(TrackPoint(i * DT, 0, 0, 0, course, 25.0, 0, rate / 25 if course < math.pi / 2 else 0.0), PARAMS, DT)
        offsets.append(offset)
        speeds.append(math.hypot(*moves))
    assert offsets[0] == pytest.approx((0.0, arm), abs=0.1)
    assert offsets[-1] == pytest.approx((-arm, 0.0), abs=0.3)
    assert max(speeds) <= spare + 1e-6
    assert np.hypot(*np.array(offsets).T) == pytest.approx(np.full(1500, arm))


def test_in_a_turn_it_flies_no_slower_than_the_wing_carries_it():
    trails = [Pair(FormationSlot(40.0), rate=rate).fly(10.0).trail for rate in (0.0, 0.5)]
    slow = cruising(airspeed=20.0, ground_speed=20.0)
    straight, turning = (_slowest(trail, trail.at(6.0), slow, PARAMS) for trail in trails)
    assert straight == PARAMS.min_airspeed
    load = 1 / math.cos(math.atan(0.5 / 25.0 * 20.0**2 / 9.80665))
    stalls = math.sqrt(PARAMS.alpha_per_load * load * 9.80665 / (PARAMS.alpha_max - PARAMS.alpha_zero_lift))
    assert 1.05 * stalls < turning < 1.1 * stalls


def test_a_station_that_moves_with_the_pace_is_kept():
    """A leader in gusts: the time that its followers stay behind changes by and by."""
    pair = Pair(FormationSlot(80.0)).fly(30.0)
    pair.pace = 28.0
    settled = pair.fly(15.0).since(33.0)
    assert np.abs(settled[:, 1]).max() < 0.5


def state(t, north, east=0.0, height=60.0, sigma=0.3):
    return NavState(
        timestamp=stamp(t), position=Vector3(x=east, y=north, z=height), velocity=Vector3(y=25.0), airspeed=25.0, position_sigma=sigma
    )


class Follower:
    """A pilot that follows 'ahead', and is told of it."""

    def __init__(self):
        self.formation = FormationLink("me", "ahead", FormationSlot(40.0))
        self.pilot = ModeManager([])
        self.pilot.join(self.formation)
        self.t = 0.0

    def fly(self, seconds, heard=True, sigma=0.3, **others):
        for _ in range(round(seconds / DT)):
            self.t += DT
            states = {"ahead": state(self.t, 25 * self.t, sigma=sigma)} if heard else {}
            self.formation.hear(self.t, states | {name: state(self.t, *place) for name, place in others.items()})
            self.now = cruising(north=25 * self.t - 40.0)
            self.flown = self.pilot.step(self.now, PARAMS, DT)
        return self


def test_it_follows_from_the_start_and_tells_whom():
    follower = Follower().fly(5.0)
    assert (follower.pilot.mode, follower.pilot.reason) == (FlightMode.FOLLOW, "follows ahead")
    assert follower.pilot.station < 1.0


def test_until_the_leader_is_heard_it_flies_straight_on_then_holds():
    follower = Follower().fly(4.0, heard=False)
    assert follower.pilot.mode is FlightMode.FOLLOW
    assert isinstance(FollowMode(follower.formation).step(follower.now, PARAMS, DT).asked, AltitudeAirspeedSetpoint)
    assert follower.fly(2.0, heard=False).pilot.mode is FlightMode.HOLD


def test_a_lost_leader_means_hold_and_its_return_means_follow():
    follower = Follower().fly(5.0).fly(0.9, heard=False)
    assert follower.pilot.mode is FlightMode.FOLLOW
    follower.fly(0.3, heard=False)
    assert (follower.pilot.mode, follower.pilot.reason) == (FlightMode.HOLD, "leader ahead lost: holds until it is heard again")
    follower.fly(10.0, heard=False).fly(0.1)
    assert follower.pilot.mode is FlightMode.FOLLOW
    assert follower.formation.trail.at(follower.t).north == pytest.approx(25 * follower.t, abs=1.0)


def test_a_leader_that_does_not_know_where_it_is_is_lost():
    assert Follower().fly(5.0).fly(1.5, sigma=30.0).pilot.mode is FlightMode.HOLD


def test_who_has_told_it_something_else_is_obeyed():
    follower = Follower().fly(5.0).fly(1.5, heard=False)
    follower.pilot.change_mode(FlightMode.HOLD, "test")
    assert follower.fly(3.0).pilot.mode is FlightMode.HOLD
    assert follower.pilot.change_mode(FlightMode.FOLLOW, "test") == ""
    assert follower.fly(1.0).pilot.mode is FlightMode.FOLLOW


def test_without_a_leader_following_is_refused():
    alone = ModeManager([])
    alone.step(cruising(), PARAMS, DT)
    assert "no leader" in alone.change_mode(FlightMode.FOLLOW, "test")


@pytest.mark.parametrize(("height", "goes"), [(63.0, -1), (57.0, 1)])
def test_it_keeps_clear_of_another_aircraft(height, goes):
    follower = Follower().fly(5.0)
    follower.fly(0.1, other=(25 * follower.t - 40.0 + 8.0, 0.0, height))
    assert follower.pilot.reason == "follows ahead, keeps clear of other"
    assert (follower.flown.level.height - height) * goes >= PARAMS.follow_sep
