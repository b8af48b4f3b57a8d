"""An aircraft flown from a terminal, with an aircraft of a few lines; what reaches a real one is tested with the autopilot."""

import math
from contextlib import suppress
from itertools import pairwise

import pytest

from launch.teleop.aircraft import AirLink, Cockpit, FlownState, cockpit
from launch.teleop.command import post_for, wanted_aircraft
from launch.teleop.loop import operate
from schemas import topics
from schemas.messages import NavState, SurfaceCommand, VehicleStatus
from tests.launch.teleop.test_command import Clock, Console
from tests.launch.teleop.test_command import Stick as Nothing
from uvf.control.teleop_flight import PARKED, FlightTeleop, SurfaceLimits, SurfaceSetting
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput

LEVEL = SurfaceSetting(elevator=-0.1, throttle=0.6)


class Plane:
    """Obeys once it is taken over at ``obeys_at`` [s]; until then its autopilot holds LEVEL."""

    def __init__(self, clock, landed=False, heard=True):
        self.clock, self.landed, self.heard = clock, landed, heard
        self.by_hand, self.sent, self.asked_at = False, [], []
        self.roll, self.held = 0.1, LEVEL

    def send(self, setting):
        self.sent.append((self.clock.t, setting))

    def take_over(self):
        self.asked_at.append(len(self.sent))
        self.by_hand = True
        return ""

    def state(self):
        return "LIVE teleop"

    def flight(self, patience=0.0):
        surfaces = self.sent[-1][1] if self.by_hand and self.sent else self.held
        return FlownState(self.by_hand, self.landed, surfaces, 24.96, 60.4, (self.roll, -0.05, -math.pi / 2)) if self.heard else None


def fly(script, **how):
    clock = Clock()
    plane, console = Plane(clock, **how), Console(clock, script)
    operate(Cockpit(FlightTeleop(SurfaceLimits(0.4, 0.5, 0.3, 0.6)), plane), console, Nothing(clock), clock)
    return plane, console


def test_commands_go_out_twenty_times_a_second_all_the_time():
    plane, _ = fly([(5.0, "x")])
    times = [t for t, _ in plane.sent]
    assert 99 <= len(times) <= 103
    assert max(b - a for a, b in pairwise(times)) < 0.06


def test_it_is_taken_over_where_the_autopilot_has_it():
    plane, _ = fly([(1.0, "x")])
    assert plane.asked_at[0] == 1, "the first command is there before the mode is asked for"
    assert {setting for _, setting in plane.sent} == {LEVEL}


def test_on_the_ground_it_is_taken_over_parked():
    plane, _ = fly([(1.0, "x")], landed=True)
    assert {setting for _, setting in plane.sent} == {PARKED}


def test_keys_move_the_surfaces_from_there():
    plane, _ = fly([(1.0, "d"), (1.5, "x")])
    assert plane.sent[-1][1] == pytest.approx(LEVEL._replace(aileron=0.02))


def test_while_somebody_else_flies_it_goes_along_and_m_takes_over_again():
    clock = Clock()
    plane = Plane(clock)
    post = Cockpit(FlightTeleop(SurfaceLimits(0.4, 0.5, 0.3, 0.6)), plane)
    post.take_over()
    post.key(0.1, "d")
    plane.by_hand = False  # STOP ALL, or another mode asked for
    post.turn(0.2, Nothing(clock).read())
    assert plane.sent[-1][1] == LEVEL
    post.take_over()
    post.key(0.3, "a")
    post.turn(0.4, Nothing(clock).read())
    assert plane.sent[-1][1].aileron == pytest.approx(-0.02)


@pytest.mark.parametrize("end", ["x", KeyboardInterrupt()])
def test_left_it_falls_silent_so_that_the_autopilot_takes_over(end):
    script = [(1.0, "d"), (2.0, end)]
    clock = Clock()
    plane = Plane(clock)
    post = Cockpit(FlightTeleop(SurfaceLimits(0.4, 0.5, 0.3, 0.6)), plane)
    with suppress(KeyboardInterrupt):
        operate(post, Console(clock, script), Nothing(clock), clock)
    assert plane.sent[-1][0] <= 2.0


def test_the_line_tells_airspeed_height_attitude_and_surfaces():
    _, console = fly([(0.01, "b"), (1.0, "x")])
    assert console.lines[-1] == (
        "LIVE teleop | 25.0 m/s 60 m roll +6 pitch -3 hdg 270 | ail +0.0 ele -5.7 rud +0.0 flap 0 | thr 60 % BRAKES"
    )


def test_before_anything_is_heard_it_takes_over_nothing_and_says_so():
    plane, console = fly([(0.3, "d"), (0.5, "x")], heard=False)
    assert (plane.sent, plane.asked_at) == ([], [])
    assert console.lines[0].startswith("no state heard yet: m tries again | ")


def test_from_another_hand_it_is_taken_over_where_that_one_had_it():
    clock = Clock()
    plane = Plane(clock)
    plane.by_hand = True
    Cockpit(FlightTeleop(SurfaceLimits(0.4, 0.5, 0.3, 0.6)), plane).take_over()
    assert plane.sent[-1][1] == LEVEL


def test_taken_over_in_a_steep_turn_the_elevator_springs_back_to_where_straight_flight_had_it():
    clock = Clock()
    plane = Plane(clock)
    post = Cockpit(FlightTeleop(SurfaceLimits(0.4, 0.5, 0.3, 0.6)), plane)
    post.take_over()
    plane.by_hand = False
    post.turn(0.1, Nothing(clock).read())
    plane.roll, plane.held = 0.8, LEVEL._replace(elevator=-0.25)  # the autopilot turns steeply
    post.turn(0.2, Nothing(clock).read())
    assert "n trims" in post.take_over()
    assert plane.sent[-1][1].elevator == -0.25, "at first nothing moves"
    post.key(0.3, "c")
    post.turn(0.4, Nothing(clock).read())
    assert plane.sent[-1][1].elevator == LEVEL.elevator


class Heard:
    """A client that hears one topic after the other, each only once somebody listens for it."""

    def __init__(self):
        self.listened = {}

    def heard(self, owner, topic):
        self.listened[topic.key] = self.listened.get(topic.key, 0) + 1
        return int(self.listened[topic.key] > 1)

    def wait(self, condition, timeout, what=""):
        if not (condition() or (timeout and condition())):
            raise TimeoutError

    def read(self, owner, topic):
        told = {topics.STATUS: VehicleStatus(landed=True), topics.NAV_STATE: NavState(airspeed=3.0)}
        return told.get(topic, SurfaceCommand(flap=0.1))


def test_all_that_is_known_of_an_aircraft_is_listened_for_at_once():
    link = AirLink(Heard(), "milvus")
    assert link.flight() is None
    flight = link.flight()
    assert (flight.landed, flight.airspeed, flight.surfaces) == (True, 3.0, SurfaceSetting(flap=0.1))


@pytest.fixture(scope="module")
def site():
    return load_scenario(ROOT / "missions" / "demo.yaml")


def test_the_limits_are_those_of_the_vehicles_file(site):
    body = site.members["milvus"].file.air
    post = cockpit(None, "milvus", body)
    for _ in range(30):
        post.key(0.0, "d")
        post.key(0.0, "q")
    limits = body.controls
    assert (post._stick.setting.aileron, post._stick.setting.rudder) == (limits.aileron.limit, limits.rudder.limit)


def test_an_aircraft_is_flown_alone(site):
    assert wanted_aircraft(site, ["milvus", "milvus"]) == "milvus"
    assert wanted_aircraft(site, ["burger"]) == wanted_aircraft(site, []) == ""
    with pytest.raises(BadInput, match="'milvus' flies, and one flies one aircraft at a time"):
        wanted_aircraft(site, ["burger", "milvus"])


def test_the_kind_of_the_vehicle_decides_about_the_keys(site):
    assert "flaps" in post_for(site, ["milvus"])[0]
    assert "curves" in post_for(site, ["burger"])[0]
