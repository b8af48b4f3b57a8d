"""Each failsafe of a ground vehicle by its real cause, in drives with physics: what is said, what is done, and how it recovers."""

import msgspec
import pytest

from schemas import topics
from schemas.messages import ArmRequest, Mode, RemoveRequest, SetPoseRequest, SimObject, SpawnRequest
from tests.services.autopilot.ground.trip import THERE_AND_BACK, Trip
from tests.services.autopilot.proofs import shows
from uvf.maths.rotations import from_euler
from uvf.models.vehicle.air import BatteryPack
from uvf.models.vehicle.file import Friction
from uvf.models.vehicle.sensors import Mount, RangeFinder
from uvf.models.world.file import Box, Origin, Ramp, WorldFile
from uvf.runtime.messages.convert import planar_pose, quaternion

ON_ITS_OWN = {"job": THERE_AND_BACK}


@shows("ground", "link")
def test_without_its_ground_station_it_holds_and_goes_on_when_asked(tmp_path):
    trip = Trip(tmp_path, entry=ON_ITS_OWN)
    trip.linked = True
    trip.run(3.0)
    trip.linked = False
    trip.run(9.0)
    assert trip.mode == "HOLD" and trip.way(8.6, 9.0) < 0.01
    trip.linked = True
    trip.run(10.0)
    trip.take("mission")
    trip.run(13.0)
    assert trip.mode == "MISSION" and trip.way(10.0, 13.0) > 0.1
    return trip


@shows("ground", "pose", "scan", "map")
def test_blind_or_lost_it_stands_and_goes_on_by_itself(tmp_path):
    faults = [("wheels", "lost", 4.0, 6.5), ("scan", "lost", 10.0, 18.0), ("scan", "frozen", 21.0, 25.0)]
    trip = Trip(tmp_path, faults, ON_ITS_OWN)
    trip.run(30.0)
    assert trip.mode == "MISSION"
    assert trip.way(5.8, 6.4) < 0.02 and trip.way(12.0, 17.9) < 0.02 and trip.way(24.0, 24.9) < 0.02
    assert trip.way(2.0, 4.0) > 0.1 and trip.way(7.5, 9.5) > 0.1 and trip.way(26.0, 30.0) > 0.1
    assert len(trip.told("lidar silent or frozen")) == 2
    return trip


@shows("ground", "offboard")
def test_setpoints_that_end_are_a_hold(tmp_path):
    trip = Trip(tmp_path, entry=ON_ITS_OWN, thinks=False)
    trip.outside = (0.15, 0.0)
    trip.run(0.5)
    trip.take("offboard")
    trip.run(2.0)
    trip.outside = None
    trip.run(4.0)
    assert trip.mode == "HOLD" and trip.way(0.5, 2.0) > 0.1 and trip.way(3.5, 4.0) < 0.01
    return trip


@shows("ground", "fence", "sticks")
def test_driven_by_hand_it_stops_before_its_fence_may_turn_back_and_is_missed_when_let_go(tmp_path):
    fence = {"zones": [{"circle": [5.0, 4.4, 0.6]}]}
    trip = Trip(tmp_path, entry={**ON_ITS_OWN, "fence": fence, "job": {"mission": [{"x": 5.2, "y": 4.4}]}})
    trip.hand = (0.2, 0.0)
    trip.run(0.5)
    trip.take("manual")
    trip.run(5.0)
    assert 0.25 < trip.truth[-1][1].position.x - 5.0 < 0.6 - 0.115
    assert trip.way(4.5, 5.0) < 0.01
    trip.hand = (-0.2, 0.0)
    trip.run(7.5)
    assert trip.way(5.0, 7.5) > 0.3
    trip.set("stick_action", "hold")
    trip.hand = None
    trip.run(8.5)
    assert trip.mode == "HOLD"
    return trip


PLATFORM = WorldFile(
    about="test",
    origin=Origin(0.0, 0.0),
    floor=(0.0, 0.0, 10.0, 10.0),
    boxes=[Box("platform", (5.5, 4.4, 0.1), (2.0, 2.0, 0.2))],
    ramps=[Ramp("ramp", (2.5, 4.4), height=0.2, length=2.0, width=1.0)],
)
LOOKS_DOWN = RangeFinder(Mount((0.09, 0.0, 0.06), (0.0, 1.2, 0.0)), hz=20.0, range_min=0.005, range_max=0.3, noise=0.002)


@shows("ground", "edge")
def test_it_stands_before_an_edge_that_a_range_finder_sees_and_may_drive_away(tmp_path):
    trip = Trip(tmp_path, entry=ON_ITS_OWN, thinks=False, world=PLATFORM, sensors={"rangefinders": [LOOKS_DOWN]})
    trip.hand = (0.25, 0.0)
    trip.run(0.5)
    trip.take("manual")
    trip.run(9.0)
    assert 6.3 < trip.truth[-1][1].position.x < 6.5 and trip.truth[-1][1].position.z > 0.19
    assert trip.way(8.0, 9.0) < 0.01
    trip.hand = (-0.25, 0.0)
    trip.run(13.0)
    assert trip.way(9.0, 13.0) > 0.4
    return trip


def looks_aside(frame, x, y, yaw):
    return RangeFinder(Mount((x, y, 0.06), (0.0, 1.2, yaw)), hz=20.0, range_min=0.005, range_max=0.3, noise=0.002, frame=frame)


def test_it_explores_a_table_and_stays_on_it(tmp_path):
    table, posts = (
        Box("table", (5.5, 4.4, 0.1), (4.0, 4.0, 0.2)),
        [Box(f"post_{x}", (x, y, 0.6), (0.3, 0.3, 1.0)) for x, y in ((6.5, 5.2), (4.2, 3.2))],
    )
    world = msgspec.structs.replace(PLATFORM, boxes=[table, *posts], ramps=[Ramp("ramp", (1.5, 4.4), height=0.2, length=2.0, width=1.0)])
    finders = [
        LOOKS_DOWN,
        looks_aside("left", 0.075, 0.06, 0.9),
        looks_aside("right", 0.075, -0.06, -0.9),
        looks_aside("back", -0.1, 0.0, 3.1416),
    ]
    trip = Trip(tmp_path, entry={"job": {"explore": True}}, world=world, sensors={"rangefinders": finders})
    trip.run(60.0)
    assert min(m.position.z for _, m in trip.truth) > 0.19
    assert trip.told("no floor ahead: stopped")
    xs, ys = [m.position.x for _, m in trip.truth], [m.position.y for _, m in trip.truth]
    assert max(xs) - min(xs) + max(ys) - min(ys) > 3.0


@shows("ground", "stuck")
@pytest.mark.parametrize(("grip", "how"), [(1.0, "held fast"), (0.12, "in vain")])
def test_at_a_step_that_the_lidar_does_not_see_it_gives_up_and_drives_on_when_that_is_gone(tmp_path, grip, how):
    trip = Trip(tmp_path, entry=ON_ITS_OWN, ground={"friction": Friction(mu=grip, mu2=grip)})
    step = SimObject(name="step", shape="box", size=[0.1, 1.0, 0.1], pose=planar_pose(5.35, 4.4, 0.0))
    step.pose.position.z = 0.05
    trip.ask(topics.SPAWN, SpawnRequest(object=step), "sys")
    trip.outside = (0.15, 0.0)
    trip.run(0.5)
    assert trip.replies[-1].accepted, trip.replies
    trip.take("offboard")
    trip.run(9.0)
    (began,) = [(t, m) for t, m in trip.events if m.text == "stuck"]
    assert trip.mode == "HOLD" and how in began[1].cause
    assert trip.status[-1][1].failsafes
    trip.ask(topics.REMOVE, RemoveRequest(name="step"), "sys")
    trip.take("offboard")
    trip.run(12.0)
    assert trip.mode == "OFFBOARD" and trip.way(9.0, 12.0) > 0.2 and len(trip.told("stuck")) == 1
    return trip


@shows("ground", "tipped")
def test_tipped_over_its_motors_are_off_until_it_is_upright_and_armed_again(tmp_path):
    trip = Trip(tmp_path, entry=ON_ITS_OWN, thinks=False)
    trip.outside = (0.15, 0.0)
    trip.run(0.5)
    trip.take("offboard")
    trip.run(1.5)
    knocked = planar_pose(5.3, 4.4, 0.0)
    knocked.position.z = 0.15
    knocked.orientation.CopyFrom(quaternion(from_euler(1.2, 0.0, 0.0)))
    trip.ask(topics.SET_POSE, SetPoseRequest(name="burger", pose=knocked), "sys")
    trip.run(4.0)
    assert trip.replies[-1].accepted, trip.replies
    assert trip.told("tipped") and not trip.status[-1][1].armed
    trip.ask(topics.ARM, ArmRequest(arm=True, source="test"))
    trip.run(4.2)
    assert trip.replies[-1].reason == "tipped: motors off"
    trip.ask(topics.SET_POSE, SetPoseRequest(name="burger", pose=planar_pose(5.3, 4.4, 0.0)), "sys")
    trip.run(7.0)
    trip.ask(topics.ARM, ArmRequest(arm=True, source="test"))
    trip.take("offboard")
    trip.run(9.0)
    assert trip.way(7.0, 9.0) > 0.1
    return trip


@shows("ground", "battery_low", "battery_critical", "battery_emergency")
def test_on_a_battery_that_runs_out_it_drives_home_and_then_stands_disarmed(tmp_path):
    """Until the pack's gauge finds that there is more in it than it told."""
    pack = BatteryPack(energy=200.0, full=12.6, empty=9.6, resistance=0.1, avionics=6.0)
    trip = Trip(tmp_path, [("battery", "bias", 36.0, None, 0.5)], ON_ITS_OWN, {"battery": pack})
    trip.set("emergency_charge", 0.069)
    trip.run(44.0)
    (low,), (critical,) = trip.told("battery low"), trip.told("battery critical")
    assert next(m.mode for t, m in trip.status if t > low + 0.2) == Mode.MODE_RETURN
    assert critical < 36.0
    last = trip.status[-1][1]
    assert not last.armed and last.battery_remaining > 0.4
    return trip


def test_an_empty_battery_stops_the_wheels(tmp_path):
    pack = BatteryPack(energy=30.0, full=12.6, empty=9.6, avionics=6.0)
    trip = Trip(tmp_path, [("battery", "frozen", 0.0, None)], ON_ITS_OWN, {"battery": pack}, thinks=False)
    trip.outside = (0.15, 0.0)
    trip.run(0.5)
    trip.take("offboard")
    trip.run(8.0)
    assert trip.way(0.5, 3.0) > 0.2 and trip.way(6.0, 8.0) < 0.005
