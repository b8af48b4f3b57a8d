"""An aircraft that is steered at a fence turns away in time, in any wind that it can fly in."""

import math
from dataclasses import replace

import numpy as np
import pytest

from schemas.messages import Fence
from services.autopilot.air.fence_guard import FenceGuard, circle_within, clamped, kept, turn
from tests.services.autopilot.air.states import PARAMS, G, Kinematic, cruising
from uvf.control.commands import AltitudeAirspeedSetpoint
from uvf.guidance.fence_plan import fence_fit, mission_fault, place_fault
from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.route import Place
from uvf.maths.zones import Disc, Polygon, Region
from uvf.models.mission.fence import OPEN, Fencing

SQUARE = Polygon([(-400.0, -400.0), (400.0, -400.0), (400.0, 400.0), (-400.0, 400.0)])
NOTCH = [(60.0, 400.0), (60.0, 150.0), (-60.0, 150.0), (-60.0, 400.0)]
NOTCHED = Polygon([(-400.0, -400.0), (400.0, -400.0), (400.0, 400.0), *NOTCH, (-400.0, 400.0)])
REGIONS = {
    "square": Region((SQUARE,)),
    "notched": Region((NOTCHED,)),
    "disc": Region((Disc((0.0, 0.0), 400.0),)),
    "mast": Region((SQUARE,), (Disc((200.0, 0.0), 40.0), Disc((0.0, 230.0), 50.0))),
}


def fence(region=REGIONS["square"], floor=-math.inf, ceiling=math.inf, action=Fence.HOLD):
    return Fencing(region, floor, ceiling, action)


def flown(region, heading, wind, wanted=0.0, seconds=35.0, dt=0.05):
    """(n, 3) east, north, clearance of an aircraft that would always fly this bank; whether the guard had to act."""
    guard, craft, rows, acted = FenceGuard(), Kinematic(heading=heading, wind=wind), [], False
    guard.take(fence(region))
    for _ in range(round(seconds / dt)):
        now = craft.estimate()
        guard.look(now, PARAMS)
        bank = guard.bank(wanted, now, PARAMS)
        acted |= guard.evades
        craft.roll += min(max(dt / craft.LAG * (bank - craft.roll), -1.6 * dt), 1.6 * dt)
        craft.heading += dt * G / 25.0 * math.tan(craft.roll)
        craft.position[0] += dt * now.ground_speed * math.cos(now.course)
        craft.position[1] += dt * now.ground_speed * math.sin(now.course)
        rows.append((now.east, now.north, region.at((now.east, now.north))))
    return np.array(rows), acted


@pytest.mark.parametrize("wind", [(0.0, 0.0), (10.0, 0.0), (-6.0, 8.0)])
@pytest.mark.parametrize("heading", [0.0, 1.57, 4.0])
@pytest.mark.parametrize("name", REGIONS)
def test_it_never_leaves_though_it_is_steered_out_all_the_time(name, heading, wind):
    rows, acted = flown(REGIONS[name], heading, wind)
    assert acted
    assert rows[:, 2].min() > 0.0


def test_it_uses_the_room_there_is():
    rows, _ = flown(REGIONS["square"], 0.0, (0.0, 0.0), seconds=20.0)
    assert rows[:, 2].min() < 60.0


def test_along_a_fence_it_flies_on():
    guard = FenceGuard()
    guard.take(fence())
    now = cruising(east=400.0 - PARAMS.fence_margin - 5.0)
    guard.look(now, PARAMS)
    assert guard.bank(0.1, now, PARAMS) == 0.1


def test_a_fence_that_only_warns_does_not_steer():
    guard = FenceGuard()
    guard.take(fence(action=Fence.WARN, ceiling=50.0))
    now = cruising(north=395.0)
    assert guard.look(now, PARAMS).spare(PARAMS) < 0
    wanted = AltitudeAirspeedSetpoint(0.0, 60.0, 0.0, 25.0)
    assert kept(wanted, guard, now, PARAMS) == wanted


def test_without_a_fence_nothing_is_near():
    guard = FenceGuard()
    assert guard.look(cruising(), PARAMS).spare(PARAMS) == math.inf
    assert not guard.outlook.breached


def test_the_turn_that_is_predicted_is_the_one_that_is_flown():
    craft = Kinematic(wind=(3.0, -8.0))
    predicted = turn(craft.estimate(), 0.9)
    flown_to = []
    for _ in range(300):
        now = craft.estimate()
        flown_to.append((now.east, now.north))
        craft.roll += 0.02 / craft.LAG * (0.9 - craft.roll)
        craft.heading += 0.02 * G / 25.0 * math.tan(craft.roll)
        craft.position[0] += 0.02 * now.ground_speed * math.cos(now.course)
        craft.position[1] += 0.02 * now.ground_speed * math.sin(now.course)
    apart = [np.hypot(*(np.array(flown_to) - p).T).min() for p in predicted[:20]]
    assert max(apart) < 10.0


def test_a_climb_is_ended_below_the_ceiling():
    guard = FenceGuard()
    guard.take(fence(ceiling=100.0, floor=20.0))
    now = cruising(height=94.0, climb=6.0)
    assert guard.look(now, PARAMS).spare(PARAMS) < 0
    assert kept(AltitudeAirspeedSetpoint(0.0, None, 6.0, 25.0), guard, now, PARAMS).height == 94.0
    assert kept(AltitudeAirspeedSetpoint(0.0, 150.0, 6.0, 25.0), guard, now, PARAMS) == AltitudeAirspeedSetpoint(0.0, 95.0, 0.0, 25.0)


def test_the_floor_counts_from_when_it_has_been_above_it():
    guard = FenceGuard()
    guard.take(fence(floor=40.0))
    low = cruising(height=10.0)
    assert guard.look(low, PARAMS).spare(PARAMS) > 0
    assert kept(AltitudeAirspeedSetpoint(0.0, 20.0, 0.0, 25.0), guard, low, PARAMS).height == 20.0
    guard.look(cruising(height=60.0), PARAMS)
    assert kept(AltitudeAirspeedSetpoint(0.0, 20.0, 0.0, 25.0), guard, cruising(height=60.0), PARAMS).height == 45.0


def test_it_holds_where_there_is_room_for_the_circle():
    circle = circle_within(fence(), Place(390.0, 390.0, 300.0), 90.0, PARAMS)
    assert REGIONS["square"].at((circle.centre.east, circle.centre.north)) >= 98.0
    assert circle_within(fence(), Place(0.0, 0.0, 60.0), 395.0, PARAMS) is None
    assert clamped(300.0, fence(ceiling=120.0, floor=20.0), PARAMS) == 115.0


def item(north, east, height=60.0, **fields):
    return PlanItem(fields.pop("kind", ItemKind.WAYPOINT), Place(north, east, height), **fields)


@pytest.mark.parametrize(
    ("items", "why"),
    [
        ([item(0.0, 0.0), item(500.0, 0.0)], "item 1: (0, 500) is 100 m outside of the fence"),
        ([item(0.0, 300.0), item(0.0, 100.0)], "item 1: the way there comes too near to the fence at (2"),
        ([item(0.0, 300.0), item(0.0, 0.0, kind=ItemKind.JUMP), item(0.0, 100.0)], ""),
        (
            [item(0.0, -330.0, kind=ItemKind.ORBIT, radius=-80.0)],
            "item 0: (-330, 0) is 70 m from the fence, 92 m are needed to circle at 80 m",
        ),
        ([item(0.0, 0.0, height=140.0)], "item 0: its height of 140 m is not within 25 to 115 m"),
        ([item(0.0, 0.0), item(-300.0, 0.0), item(0.0, 0.0, kind=ItemKind.RETURN)], ""),
    ],
)
def test_a_mission_that_leaves_the_fence_is_refused_with_item_and_reason(items, why):
    said = mission_fault(items, fence(REGIONS["mast"], 20.0, 120.0), PARAMS)
    assert said.startswith(why) and bool(said) is bool(why)


def test_a_fence_has_to_hold_the_aircraft_and_leave_it_room():
    here = Place(0.0, 0.0, 60.0)
    assert fence_fit(OPEN, here, True, PARAMS) == ""
    assert fence_fit(fence(floor=20.0, ceiling=120.0), here, True, PARAMS) == ""
    assert "outside of it" in fence_fit(fence(), replace(here, north=500.0), True, PARAMS)
    assert "at 60 m" in fence_fit(fence(floor=70.0), here, True, PARAMS)
    assert "10 m apart" in fence_fit(fence(floor=55.0, ceiling=65.0), here, True, PARAMS)
    assert "no room to circle" in fence_fit(fence(Region((Disc((0.0, 0.0), 50.0),))), here, True, PARAMS)


def test_goals_need_room_for_their_circle():
    assert place_fault(Place(0.0, 0.0, 60.0), fence(), PARAMS, 90.0) == ""
    assert "90 m" in place_fault(Place(350.0, 0.0, 60.0), fence(), PARAMS, 90.0)
