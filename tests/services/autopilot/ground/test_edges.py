"""Edges of the floor: who is stopped by which range finder, and when one counts that fails."""

from schemas.messages import Range
from services.autopilot.ground.edges import EdgeWatch
from uvf.maths.kinematics import Twist
from uvf.runtime.messages.convert import stamp
from uvf.sensors.cliffs import FloorSight

SIGHTS = {"front": FloorSight((0.15, 0.0), 0.05), "rear": FloorSight((-0.15, 0.0), 0.05)}


def said(t, frame, measured):
    return Range(timestamp=stamp(t), frame_id=f"v/{frame}", range=measured)


def watch(*readings):
    made = EdgeWatch(SIGHTS)
    for t, frame, measured in readings:
        made.step(t, [said(t, frame, measured)])
    return made


def test_an_edge_ahead_stops_who_drives_ahead_and_lets_him_back():
    edges = watch((0.0, "front", 0.05), (0.1, "front", 0.2), (0.15, "front", 0.0))
    assert edges.stops(Twist(0.2, 0.0)) and not edges.stops(Twist(-0.2, 0.0)) and not edges.stops(Twist(0.0, 0.0))
    edges.step(0.2, [said(0.2, "front", 0.05)])
    assert not edges.stops(Twist(0.2, 0.0))


def test_an_edge_behind_stops_who_backs():
    edges = watch((0.1, "rear", 0.0), (0.15, "rear", 0.0))
    assert edges.stops(Twist(-0.2, 0.0)) and not edges.stops(Twist(0.2, 0.0))


def test_one_reading_that_is_lost_stops_nobody():
    assert not watch((0.1, "front", 0.0)).stops(Twist(0.2, 0.0))


def test_a_range_finder_that_falls_silent_sees_no_floor_and_one_that_never_spoke_is_not_there():
    edges = watch((0.1, "front", 0.05))
    edges.step(1.0, [])
    assert not edges.stops(Twist(0.2, 0.0))
    edges.step(1.3, [])
    assert edges.stops(Twist(0.2, 0.0)) and not edges.stops(Twist(-0.2, 0.0))


def test_others_are_left_alone():
    assert not watch((0.1, "roof", 0.0), (0.2, "roof", 0.0)).stops(Twist(0.2, 0.0))
