"""Our own autopilot in one system, the bridge in another, UDP between them: what the second sees is so, and what it asks is flown."""

import math

import msgspec
import numpy as np
import pytest

from schemas import topics
from schemas.messages import (
    AltitudeCommand,
    ArmRequest,
    CancelRequest,
    Fence,
    FenceRequest,
    FenceZone,
    GoalRequest,
    Mission,
    MissionItem,
    MissionProgress,
    MissionRequest,
    Mode,
    ModeRequest,
    ParamRequest,
    RallyPoints,
    RallyRequest,
    SetCurrentRequest,
    StopCommand,
    Vector3,
    VehicleCommandRequest,
)
from services.autopilot.air.build import hosts as air_hosts
from services.autopilot.ground.build import hosts as ground_hosts
from services.autopilot.mavlink.build import facts_of
from services.planner.build import build as planner
from services.sim_air.build import build as air_sim
from services.sim_ground.build import build as ground_sim
from services.slam.build import build as slam
from tests.services.mavlink_bridge.flown import Sides
from uvf.maths.rotations import inverse, multiply
from uvf.models.mission.file import JobFile
from uvf.models.scenario import ROOT, MissionVehicle, load_scenario
from uvf.runtime.messages.convert import array, wxyz
from uvf.runtime.state.stop_all import StopVoice

SPEED = 30.0  # m/s, faster than it flies


def alone(name):
    """One vehicle of the demo, without a job."""
    site = load_scenario(ROOT / "missions" / "demo.yaml")
    member = site.members[name]
    entry = msgspec.structs.replace(member.entry, job=JobFile())
    site.members.clear()
    site.members[name] = MissionVehicle(name, entry, member.file, member.folder)
    return site


@pytest.fixture(scope="module")
def plane():
    """In flight, without a job."""
    site = alone("milvus")
    with Sides(site, [*air_sim(site), *air_hosts(site)], "plane2", facts_of(site)[0].origin) as sides:
        assert sides.run(6.0, lambda: sides.newest(topics.MISSION) is not None and sides.newest(topics.NAV_STATE) is not None)
        sides.run(2.0)
        yield sides


def mode(sides):
    return sides.newest(topics.STATUS).mode


def waypoint(x, y, z):
    return MissionItem(kind=MissionItem.WAYPOINT, position=Vector3(x=x, y=y, z=z))


def near(sides, x, y, within):
    return math.hypot(sides.truth.position.x - x, sides.truth.position.y - y) < within


def test_it_is_known_as_any_vehicle(plane):
    status = plane.newest(topics.STATUS)
    assert (status.kind, status.mode, status.armed, status.landed, status.system_id) == (2, Mode.MODE_HOLD, True, False, 1)
    assert status.battery_remaining == pytest.approx(1.0, abs=0.02) and not status.failsafes
    assert plane.newest(topics.PROGRESS).state == MissionProgress.NO_MISSION
    assert plane.newest(topics.EXTERNAL_VEHICLE).model == "x"
    assert any("simulated autopilot" in text for text in plane.events)


def test_a_refusal_comes_with_the_autopilots_words(plane):
    reply = plane.ask(topics.ARM, ArmRequest(arm=False))
    assert not reply.accepted and "Disarming denied: the aircraft is flying" in reply.reason
    assert plane.newest(topics.STATUS).armed


def test_its_motion_is_told_as_exactly_as_the_rates_allow(plane):
    """25 Hz over the link and 50 Hz steps on both ends: 0.08 s at most behind, beside the estimator's own error."""
    apart, turned, gaps, before = [], [], [], None

    def look():
        nav = plane.newest(topics.NAV_STATE)
        apart.append(float(np.linalg.norm(array(nav.position) - array(plane.truth.position))))
        turn = multiply(wxyz(nav.orientation), inverse(wxyz(plane.truth.orientation)))
        turned.append(2 * math.acos(min(abs(float(turn[0])), 1.0)))
        nonlocal before
        gaps.append(before is not nav)
        before = nav
        return False

    plane.run(10.0, look, 0.05)
    assert max(apart) < 0.08 * SPEED + 2.5 and np.mean(apart) < 2.5
    assert max(turned) < 0.12
    assert np.mean(gaps) > 0.95, "news in nearly each 0.05 s"
    nav = plane.newest(topics.NAV_STATE)
    assert array(nav.velocity) == pytest.approx(array(plane.truth.velocity), abs=2.0)
    assert nav.airspeed == pytest.approx(plane.truth.airspeed, abs=2.5)


def test_a_goal_is_flown_to_and_circled(plane):
    assert plane.ask(topics.GOAL, GoalRequest(position=Vector3(x=-200.0, y=150.0, z=80.0), yaw=math.nan)).accepted
    assert plane.run(60.0, lambda: near(plane, -200.0, 150.0, 160.0))
    assert plane.run(20.0, lambda: plane.truth.position.z == pytest.approx(80.0, abs=5.0)) and near(plane, -200.0, 150.0, 160.0)


def test_higher_is_higher(plane):
    assert plane.ask(topics.VEHICLE_COMMAND, VehicleCommandRequest(altitude=AltitudeCommand(altitude=110.0))).accepted
    assert plane.run(30.0, lambda: abs(plane.truth.position.z - 110.0) < 6.0)


def test_a_mission_goes_up_comes_back_the_same_and_is_flown(plane):
    items = [waypoint(-200.0, 150.0, 100.0), waypoint(100.0, 150.0, 100.0), waypoint(100.0, -250.0, 100.0)]
    assert plane.ask(topics.SET_MISSION, MissionRequest(mission=Mission(items=items))).accepted
    told = plane.newest(topics.MISSION)
    assert [array(i.position) for i in told.items] == [pytest.approx(array(i.position), abs=0.1) for i in items]
    assert plane.ask(topics.SET_CURRENT, SetCurrentRequest(index=1)).accepted
    assert plane.ask(topics.SET_MODE, ModeRequest(mode=Mode.MODE_MISSION)).accepted
    assert plane.run(3.0, lambda: plane.newest(topics.PROGRESS).state == MissionProgress.ACTIVE and mode(plane) == Mode.MODE_MISSION)
    progress = plane.newest(topics.PROGRESS)
    assert (progress.current, progress.total, progress.mission_id) == (1, 3, told.id)
    assert plane.run(60.0, lambda: near(plane, 100.0, 150.0, 40.0))
    assert plane.run(10.0, lambda: plane.newest(topics.PROGRESS).current == 2)


def test_a_mission_that_cannot_be_is_refused_with_the_autopilots_reason(plane):
    before = plane.newest(topics.MISSION)
    bad = Mission(items=[waypoint(10.0 * i, 0.0, 50.0) for i in range(600)])
    reply = plane.ask(topics.SET_MISSION, MissionRequest(mission=bad))
    assert not reply.accepted and reply.reason == "too many items: Mission refused: 600 items; 500 are possible"
    assert plane.newest(topics.MISSION) is before


def test_another_stations_plan_shows_up_by_itself(plane):
    """Here the autopilot's own bus is that other station."""
    items = [waypoint(400.0, 0.0, 90.0), waypoint(-400.0, 0.0, 90.0)]
    request, got = topics.SET_MISSION, []
    payload = MissionRequest(mission=Mission(items=items), source="page").SerializeToString()
    plane.run_far.bus.call(request.at("milvus"), payload, 0, lambda reply, reason, at: got.append(request.reply.FromString(reply)))
    assert plane.run(5.0, lambda: len(plane.newest(topics.MISSION).items) == 2), (got, plane.events[-3:])
    assert plane.newest(topics.MISSION).items[0].position.x == pytest.approx(400.0, abs=0.1)


def test_fence_and_rally_points_go_up(plane):
    zone = FenceZone(centre=Vector3(), radius=3000.0)
    assert plane.ask(topics.SET_FENCE, FenceRequest(fence=Fence(zones=[zone]))).accepted
    assert plane.ask(topics.SET_RALLY, RallyRequest(rally=RallyPoints(points=[Vector3(x=100.0, y=100.0, z=80.0)]))).accepted
    refused = plane.ask(topics.SET_FENCE, FenceRequest(fence=Fence(ceiling=200.0)))
    assert not refused.accepted and "parameters of the autopilot" in refused.reason


def test_a_parameter_of_the_autopilot_is_read_and_set(plane):
    param = topics.PARAM.by("autopilot")
    assert plane.ask(param, ParamRequest(name="RTL_RETURN_ALT", value="70")).accepted
    assert float(plane.ask(param, ParamRequest(name="RTL_RETURN_ALT")).params[0].value) == 70.0
    refused = plane.ask(param, ParamRequest(name="SYS_AUTOSTART", value="7"))
    assert not refused.accepted


def test_stop_all_makes_it_hold_and_nothing_else_is_taken_until_the_release(plane):
    plane.ask(topics.SET_MODE, ModeRequest(mode=Mode.MODE_MISSION))
    stop = plane.bus.publisher(topics.STOP.by("gcs").at("sys"), StopCommand.DESCRIPTOR.full_name, topics.STOP.qos)
    voice = StopVoice("gcs")
    stop.put(voice.engage(0, "").SerializeToString(), 0)
    assert plane.run(3.0, lambda: mode(plane) == Mode.MODE_HOLD and plane.newest(topics.STATUS).stopped)
    refused = plane.ask(topics.SET_MODE, ModeRequest(mode=Mode.MODE_MISSION))
    assert not refused.accepted and "STOP ALL" in refused.reason
    stop.put(voice.release(0, plane.newest(topics.STATUS).stops).SerializeToString(), 0)
    assert plane.ask(topics.SET_MODE, ModeRequest(mode=Mode.MODE_RETURN)).accepted
    assert plane.run(1.0, lambda: mode(plane) == Mode.MODE_RETURN)


def test_a_lost_link_is_told_requests_are_refused_and_it_comes_back_by_itself(plane):
    plane.speaks = False
    assert plane.run(6.0, lambda: any("link lost" in text for text in plane.newest(topics.STATUS).failsafes))
    nav = plane.newest(topics.NAV_STATE)
    reply = plane.ask(topics.ARM, ArmRequest(arm=False))
    assert not reply.accepted and reply.reason == "no link to the autopilot"
    plane.run(1.0)
    assert plane.newest(topics.NAV_STATE) is nav, "what is not told is not made up"
    plane.speaks = True
    assert plane.run(5.0, lambda: not plane.newest(topics.STATUS).failsafes)
    assert plane.ask(topics.SET_MODE, ModeRequest(mode=Mode.MODE_HOLD)).accepted


@pytest.fixture(scope="module")
def rover():
    """The burger in its house with its planner. No site is given: the world begins where it stood."""
    site = alone("burger")
    with Sides(site, [host for build in (ground_sim, slam, planner, ground_hosts) for host in build(site)], "rover2") as sides:
        assert sides.run(8.0, lambda: sides.newest(topics.NAV_STATE) is not None)
        sides.run(2.0)
        yield sides


def test_a_rover_without_a_site_has_its_home_for_origin(rover):
    assert any("the world begins at home" in text for text in rover.events)
    status, nav = rover.newest(topics.STATUS), rover.newest(topics.NAV_STATE)
    assert status.kind == 1 and array(status.home) == pytest.approx((0.0, 0.0, 0.0), abs=0.05)
    assert array(nav.position) == pytest.approx((0.0, 0.0, 0.0), abs=0.2)


def test_a_rover_is_armed_and_driven_to_a_goal(rover):
    begun = array(rover.truth.position)
    assert rover.ask(topics.ARM, ArmRequest(arm=True)).accepted
    assert rover.run(1.0, lambda: rover.newest(topics.STATUS).armed)
    assert rover.ask(topics.GOAL, GoalRequest(position=Vector3(x=-0.8, y=-0.4), yaw=math.nan)).accepted
    assert rover.run(2.0, lambda: mode(rover) == Mode.MODE_MISSION)
    there = begun + np.array((-0.8, -0.4, 0.0))
    assert rover.run(40.0, lambda: np.linalg.norm((array(rover.truth.position) - there)[:2]) < 0.25)
    assert array(rover.newest(topics.NAV_STATE).position)[:2] == pytest.approx((array(rover.truth.position) - begun)[:2], abs=0.2)


def test_a_rover_stands_when_the_goal_is_cancelled(rover):
    assert rover.ask(topics.GOAL, GoalRequest(position=Vector3(x=0.0, y=0.0), yaw=math.nan)).accepted
    rover.run(2.0)
    assert rover.ask(topics.CANCEL, CancelRequest()).accepted
    assert rover.run(2.0, lambda: mode(rover) == Mode.MODE_HOLD)
    rover.run(1.0)
    stood = array(rover.truth.position)
    rover.run(1.0)
    assert np.linalg.norm(array(rover.truth.position) - stood) < 0.01
