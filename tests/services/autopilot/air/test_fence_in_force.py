"""The fence about home, beside the plan's; and the action that a parameter gives to both."""

import math

import msgspec
import pytest

from schemas.messages import Breach, Fence, FenceRequest, FenceZone, Mode, ModeRequest, Vector3
from services.autopilot.air.failsafes.prearm import PrearmInputs, faults
from services.autopilot.air.fence_guard import FenceGuard, FenceInForce, in_force, too_small
from tests.services.autopilot.air.sensing import Bench
from tests.services.autopilot.air.states import PARAMS, G, Kinematic, cruising
from uvf.guidance.route import Place

HOME = Place(100.0, 0.0, 10.0)
PLAN = Fence(zones=[FenceZone(centre=Vector3(x=300.0), radius=400.0), FenceZone(centre=Vector3(x=50.0), radius=20.0, excludes=True)])


def with_(**values):
    return msgspec.structs.replace(PARAMS, **values)


def test_what_lies_within_both_counts():
    fence = in_force(PLAN, HOME, with_(max_distance=500.0, max_height=100.0))
    assert fence.region.at((300.0, 100.0)) > 0
    assert fence.region.at((-150.0, 100.0)) < 0, "outside of the plan"
    assert fence.region.at((600.0, 100.0)) < 0, "too far from home"
    assert fence.region.at((50.0, 0.0)) < 0, "kept out of"
    assert fence.ceiling == 110.0


def test_without_a_plan_it_is_a_disc_and_a_ceiling_with_the_action_return():
    fence = in_force(Fence(), HOME, with_(max_distance=500.0))
    assert fence.region.at((0.0, 100.0)) == 500.0 and fence.ceiling == math.inf and fence.action == Fence.RETURN
    assert in_force(Fence(ceiling=50.0), HOME, with_(max_height=100.0)).ceiling == 50.0


def test_it_is_out_of_force_without_home_or_when_fences_are_disabled():
    assert in_force(Fence(), None, with_(max_distance=500.0)).is_open
    assert in_force(Fence(disabled=True), HOME, with_(max_distance=500.0, max_height=50.0)).is_open


@pytest.mark.parametrize(("said", "action"), [("plan", Fence.HOLD), ("warn", Fence.WARN), ("return", Fence.RETURN), ("land", Fence.LAND)])
def test_a_parameter_comes_before_the_plans_own_action(said, action):
    assert in_force(Fence(zones=PLAN.zones, action=Fence.HOLD), HOME, with_(fence_action=said)).action == action


def test_one_that_leaves_no_room_is_only_told_of_and_speaks_against_arming():
    small = with_(max_distance=20.0)
    assert "no room to circle" in too_small(small) and "too low" in too_small(with_(max_height=10.0))
    assert not in_force(Fence(), HOME, small).steers
    assert any(fault.startswith("fence: max_distance") for fault in faults(PrearmInputs(cruising(), small, fence_fault=too_small(small))))


def test_it_is_worked_out_when_something_changes_and_only_then():
    kept, plan = FenceInForce(), Fence()
    first = kept.of(plan, HOME, PARAMS)
    assert kept.of(plan, HOME, PARAMS) is first
    assert kept.of(plan, HOME, with_(max_distance=500.0)) is not first


def test_a_fence_that_is_set_far_within_brings_it_back_once_it_flies_home():
    guard, craft = FenceGuard(), Kinematic(north=600.0, heading=0.0)
    guard.take(in_force(Fence(), Place(0.0, 0.0, 0.0), with_(max_distance=300.0)))
    rooms = []
    for _ in range(round(60.0 / 0.05)):
        now = craft.estimate()
        guard.look(now, PARAMS)
        home = math.remainder(math.atan2(-now.east, -now.north) - now.course, math.tau)
        bank = guard.bank(min(max(home, -0.6), 0.6), now, PARAMS)
        craft.roll += min(max(0.05 / craft.LAG * (bank - craft.roll), -0.08), 0.08)
        craft.heading += 0.05 * G / 25.0 * math.tan(craft.roll)
        craft.position[0] += 0.05 * now.ground_speed * math.cos(now.course)
        craft.position[1] += 0.05 * now.ground_speed * math.sin(now.course)
        rooms.append(guard.outlook.clearance)
    assert rooms[0] < -290.0 and rooms[-1] > 0.0


def test_set_in_flight_it_is_told_and_out_of_force_it_is_not():
    bench = Bench([])
    bench.run(500)
    bench.run(mode=[ModeRequest(mode=Mode.MODE_HOLD)])
    bench.service.params = with_(max_distance=100.0, fence_action="hold")
    bench.run(100)
    assert (bench.status.mode, bench.status.breach, bench.status.reason) == (Mode.MODE_HOLD, Breach.BREACH_EDGE, "fence ahead: turned away")
    circle, home = bench.status.circle, bench.status.home
    assert math.hypot(circle.centre.x - home.x, circle.centre.y - home.y) + circle.radius < 100.0, "it holds within"
    bench.service.params = PARAMS
    bench.run(100)
    assert bench.status.breach == Breach.BREACH_NONE and "inside of the fence" in bench.texts


def test_a_mission_has_to_lie_within_it_too():
    bench = Bench()
    bench.run(20)
    bench.service.params = with_(max_distance=150.0)
    bench.run()
    refused = bench.run(fence=[FenceRequest(fence=Fence())])["fence"][0]
    assert "the mission does not lie within it" in refused.reason
