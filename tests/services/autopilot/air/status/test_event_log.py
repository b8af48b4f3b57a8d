"""Corners that have no room any more are told of when that changes, and not again and again."""

import math

import msgspec

from services.autopilot.air.active_mode import ActiveMode
from services.autopilot.air.mode_table import FlightMode
from services.autopilot.air.status.event_log import EventLog
from tests.services.autopilot.air.states import PARAMS, Kinematic
from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.flyable import advice
from uvf.guidance.plan_follower import PlanFollower
from uvf.guidance.route import Place

SHARP = [PlanItem(ItemKind.WAYPOINT, Place(n, e, 60.0), acceptance=math.inf) for n, e in ((300.0, 0.0), (300.0, 150.0), (0.0, 150.0))]
TEXT = "item 1: a curve is flown past it"


def told(bank_of, seconds=12.0):
    """Of a flight along the legs, the times [s] and texts of what is told, with bank_of(t) for corners."""
    navigator, log, seen = PlanFollower(SHARP), EventLog(), []
    log.new_mission(advice(SHARP, PARAMS))
    navigator.resume()
    active, t = ActiveMode(FlightMode.MISSION, navigator), [0.0]

    def aim(now):
        t[0] += 0.02
        reference = navigator.step(now, msgspec.structs.replace(PARAMS, turn_bank=bank_of(t[0])), 0.02)[0]
        seen.extend((t[0], e.text) for e in log.events(t[0], active, True) if "curve" in e.text)
        return reference

    Kinematic().follow(aim, seconds)
    return seen


def test_with_the_bank_that_was_planned_nothing_is_told():
    assert told(lambda t: PARAMS.turn_bank) == []


def test_a_bank_that_leaves_a_corner_without_room_is_told_once():
    (said,) = told(lambda t: PARAMS.turn_bank if t < 4.0 else 0.35, seconds=18.0)
    assert said[1] in (TEXT, TEXT.replace("1", "0")) and said[0] > 4.0
