"""Where Return leads: home and rally points, the nearest that lies within the fence."""

import math

import pytest

from schemas.messages import Breach, Fence, FenceRequest, FenceZone, Mode, ModeRequest, RallyPoints, RallyRequest, Vector3
from services.autopilot.air.modes import return_mode
from tests.runtime.stepping import recall
from tests.services.autopilot.air.sensing import Bench
from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.guidance.route import Place
from uvf.maths.zones import Disc, Region
from uvf.models.mission.fence import OPEN, Fencing

HOME = Place(0.0, 0.0, 5.0)
NEAR, FAR = Place(1000.0, 0.0, 120.0), Place(0.0, 4000.0, 10.0)
LOWEST = HOME.height + PARAMS.return_altitude


def within(radius, action=Fence.RETURN):
    return Fencing(Region((Disc((0.0, 0.0), radius),)), -math.inf, math.inf, action)


@pytest.mark.parametrize(
    ("north", "fence", "leads_to"),
    [
        (100.0, OPEN, Place(0.0, 0.0, LOWEST)),
        (800.0, OPEN, NEAR),
        (800.0, within(600.0), Place(0.0, 0.0, LOWEST)),
        (800.0, within(600.0, Fence.WARN), NEAR),
        (800.0, within(50.0), Place(0.0, 0.0, LOWEST)),  # none is within it
    ],
)
def test_return_leads_to_the_nearest_that_lies_within_the_fence(north, fence, leads_to):
    assert return_mode.return_point(cruising(north=north), HOME, (NEAR, FAR), fence, PARAMS) == leads_to


def test_a_rally_point_is_circled_no_lower_than_home_would_be():
    assert return_mode.return_point(cruising(east=3900.0), HOME, (NEAR, FAR), OPEN, PARAMS) == Place(0.0, 4000.0, LOWEST)


def test_rally_points_outside_of_the_fence_are_refused_by_number():
    assert return_mode.fault((NEAR, FAR), HOME, OPEN, PARAMS) == ""
    assert return_mode.fault((NEAR, FAR), HOME, within(1500.0), PARAMS).startswith("item 1: (4000, 0) is 2500 m outside")
    assert "not finite" in return_mode.fault((Place(math.nan, 0.0, 0.0),), HOME, OPEN, PARAMS)


def rallied(*points):
    return [RallyRequest(rally=RallyPoints(points=points))]


def test_the_autopilot_returns_to_a_rally_point_tells_of_it_and_takes_it_up_again():
    bench = Bench()
    bench.run(600)
    out = bench.run(set_rally=rallied(Vector3(x=300.0, y=200.0, z=150.0)))
    assert out["set_rally"][0].accepted
    assert [(p.x, p.z) for p in out["rally"].points] == [(300.0, 150.0)]
    bench.run(mode=[ModeRequest(mode=Mode.MODE_RETURN)])
    bench.run()
    centre = bench.service._mode_manager.circle.centre
    assert (centre.east, centre.north, centre.height) == (300.0, 200.0, 150.0)
    again = Bench()
    recall(again.service, rally=out["rally"])
    assert again.service._mode_manager.rally == (Place(200.0, 300.0, 150.0),)


def test_at_its_fence_it_goes_to_the_fences_own_return_point_and_outside_of_it_says_so():
    bench = Bench([])
    bench.run(20)
    bench.run(mode=[ModeRequest(mode=Mode.MODE_HOLD)])
    fence = Fence(zones=[FenceZone(centre=Vector3(x=200.0), radius=250.0)], return_point=Vector3(x=200.0, z=90.0))
    assert bench.run(fence=[FenceRequest(fence=fence)])["fence"][0].accepted
    bench.run(700)  # straight on, whatever it commands
    assert bench.status.reason == "fence ahead: turned away"
    centre = bench.service._mode_manager.circle.centre
    assert (centre.east, centre.north, centre.height) == (200.0, 0.0, 90.0)
    bench.run(300)
    assert (bench.status.breach, bench.status.breaches) == (Breach.BREACH_EDGE, 1)
    fence.disabled = True
    assert bench.run(fence=[FenceRequest(fence=fence)])["fence"][0].accepted
    bench.run(100)
    assert (bench.status.breach, bench.status.breaches) == (Breach.BREACH_NONE, 1)
    fence.disabled = False
    assert "outside of it" in bench.run(fence=[FenceRequest(fence=fence)])["fence"][0].reason


def test_a_return_point_outside_of_its_fence_is_refused():
    bench = Bench()
    bench.run(20)
    fence = Fence(zones=[FenceZone(radius=2000.0)], return_point=Vector3(x=-5000.0, z=90.0))
    assert "its return point" in bench.run(fence=[FenceRequest(fence=fence)])["fence"][0].reason
