"""A ground vehicle holds when its link or its setpoints end, and stops before its fence."""

import math
import re
from typing import get_args

import pytest

from schemas.messages import Fence, FenceRequest, FenceZone, Link, Mission, MissionItem, MissionRequest, Mode, ModeRequest, Vector3
from services.autopilot.failsafes import FailsafeAction, FailsafeWatch
from services.autopilot.ground.failsafes import ACTIONS, GROUND_RULES, GroundFailsafeInputs
from services.autopilot.ground.fence import MARGIN, GroundPose, stops
from services.autopilot.ground.params import Choice, GroundAutopilotParams
from tests.services.autopilot.ground.test_service import BODY, Bench
from uvf.maths.kinematics import Twist
from uvf.maths.zones import Disc, Region
from uvf.models.mission.fence import Fencing
from uvf.models.scenario import ROOT
from uvf.runtime.messages.convert import stamp

DISC = Fencing(Region((Disc((0.0, 0.0), 3.0),)), -math.inf, math.inf, Fence.HOLD)
KEEP = (BODY.radius, BODY.max_linear_acceleration)
AREA = Fence(zones=[FenceZone(radius=3.0)], action=Fence.HOLD)


def fenced():
    bench = Bench()
    bench.step(pose=(0.0, 0.0), set_fence=[FenceRequest(fence=AREA, source="test")])
    assert bench.said["set_fence"][0].accepted
    return bench


def drive(bench, mode, source, seconds):
    """Moves with the commanded speed along x; returns the places."""
    x, places = 0.0, []
    bench.step(set_mode=[ModeRequest(mode=mode)])
    for _ in range(round(seconds / 0.02)):
        bench.step(linear=0.5, source=source, pose=(x, 0.0))
        x += 0.02 * bench.speed
        places.append(x)
    return places


@pytest.mark.parametrize(
    ("mode", "source"), [(Mode.MODE_MANUAL, "teleop"), (Mode.MODE_MISSION, "planner"), (Mode.MODE_OFFBOARD, "offboard")]
)
def test_it_stops_before_the_fence_in_every_mode_and_may_turn_back(mode, source):
    bench = fenced()
    places = drive(bench, mode, source, 10.0)
    assert 3.0 - BODY.radius - MARGIN - 0.25 < places[-1] < 3.0 - BODY.radius
    assert bench.speed == 0.0 and "fence ahead: stopped" in bench.events
    bench.step(n=60, linear=-0.5, source=source, pose=(places[-1], 0.0))
    assert bench.speed == pytest.approx(-0.5)
    bench.step(n=60, linear=-0.5, source=source, pose=(1.0, 0.0))
    assert "clear of the fence" in bench.events


def test_only_what_leads_nearer_is_stopped():
    edge = GroundPose(2.95, 0.0, 0.0)
    assert stops(DISC, edge, Twist(0.2, 0.0), KEEP) and not stops(DISC, edge, Twist(-0.2, 0.0), KEEP)
    assert not stops(DISC, edge, Twist(0.0, 1.0), KEEP)
    aside = GroundPose(2.95, 0.0, -math.pi / 2)
    assert stops(DISC, aside, Twist(0.0, 0.0, 0.2), KEEP) and not stops(DISC, aside, Twist(0.0, 0.0, -0.2), KEEP)
    assert not stops(DISC, GroundPose(0.0, 0.0, 0.0), Twist(0.5, 0.0), KEEP)
    assert not stops(DISC, GroundPose(2.95, 0.0, math.pi), Twist(0.2, 0.0), KEEP)


def test_missions_and_fences_that_do_not_go_together_are_refused():
    bench = fenced()
    far = Mission(items=[MissionItem(), MissionItem(position=Vector3(x=5.0))])
    bench.step(pose=(0.0, 0.0), set_mission=[MissionRequest(mission=far)])
    assert "item 1: (5.0, 0.0) is 2.0 m outside of the fence" in bench.said["set_mission"][0].reason
    away = Fence(zones=[FenceZone(centre=Vector3(x=9.0), radius=1.0)])
    bench.step(pose=(0.0, 0.0), set_fence=[FenceRequest(fence=away)])
    assert "outside of it" in bench.said["set_fence"][0].reason
    assert bench.said["bounds"].zones[0].radius == 3.0


def test_without_its_ground_station_it_holds_until_told_otherwise():
    bench = Bench()
    bench.step(n=50, linear=0.3, pose=(0.0, 0.0), link=Link(timestamp=stamp(0.9), stations=1))
    bench.step(n=260, linear=0.3, pose=(0.0, 0.0), link=Link(timestamp=stamp(1.5), stations=0))
    assert "ground station lost" in bench.events
    assert bench.said["status"].mode == Mode.MODE_HOLD and bench.speed == 0.0
    bench.step(set_mode=[ModeRequest(mode=Mode.MODE_MISSION)])
    bench.step(n=100, linear=0.3, pose=(0.0, 0.0))
    assert bench.said["status"].mode == Mode.MODE_MISSION and list(bench.said["status"].failsafes) == ["ground station lost"]
    bench.step(pose=(0.0, 0.0), link=Link(timestamp=stamp(bench.t), stations=1))
    assert "ground station back" in bench.events


def test_offboard_without_setpoints_becomes_hold():
    bench = Bench()
    bench.step(set_mode=[ModeRequest(mode=Mode.MODE_OFFBOARD)])
    bench.step(n=50, linear=0.3, source="offboard")
    bench.step(n=70)
    assert bench.said["status"].mode == Mode.MODE_HOLD
    assert "no setpoint from outside" in bench.events


def test_without_a_pose_a_mission_stands_and_says_so():
    bench = Bench()
    bench.step(n=60)
    assert "position lost: stands" in bench.events
    bench.step(n=60, pose=(0.0, 0.0))
    assert "position back" in bench.events


def test_the_documented_table_is_that_of_the_code():
    text = (ROOT / "docs" / "reference" / "failsafes.md").read_text().partition("## Ground")[2]
    rows = [line.strip("|").split("|") for line in text.splitlines() if line.startswith("| `")]
    assert [row[0].strip(" `") for row in rows] == [rule.name for rule in GROUND_RULES]
    assert [re.findall(r"`(\w+)`", row[2]) for row in rows] == [list(rule.parameters) for rule in GROUND_RULES]
    assert all(rule.raised_text.split(":")[0] in row[4] for rule, row in zip(GROUND_RULES, rows, strict=True))


CAUSES = {
    "link": {"silence": 6.0},
    "sticks": {"stick_released": True, "params": GroundAutopilotParams(stick_action="hold")},
    "pose": {"pose_age": 1.5},
    "scan": {"unseen": 2.0},
    "map": {"map_age": 6.0},
    "offboard": {"setpoint_age": 1.0},
    "fence": {"fence": True},
    "stuck": {"stuck_for": 5.0, "stuck": "wheels are held fast"},
    "edge": {"edge": True},
    "tipped": {"tilt": 0.8},
    "battery_low": {"charge": 0.15},
    "battery_critical": {"charge": 0.05},
    "battery_emergency": {"charge": 0.03},
}


def after(seconds, watch, **changes):
    seen, orders = [], []
    for _ in range(round(seconds / 0.02)):
        changed, order = watch.step(GroundFailsafeInputs(**changes), 0.02)
        seen += [(c.rule.name, c.began) for c in changed]
        orders += [order.action] if order else []
    return seen, orders


@pytest.mark.parametrize("rule", GROUND_RULES, ids=lambda rule: rule.name)
def test_each_rule_begins_once_on_its_cause_and_ends_with_it(rule):
    watch = FailsafeWatch([rule])
    assert after(10.0, watch)[0] == []
    assert after(10.0, watch, **CAUSES[rule.name])[0] == [(rule.name, True)]
    assert after(10.0, watch)[0] == [(rule.name, False)]


def test_who_is_stuck_on_the_way_home_stands_and_who_is_stuck_by_hand_is_told_only():
    watch = FailsafeWatch(GROUND_RULES)
    assert after(5.0, watch, charge=0.15)[1] == [FailsafeAction.RETURN]
    assert after(1.0, watch, charge=0.15, stuck_for=31.0)[1] == [FailsafeAction.STAND]
    assert after(1.0, FailsafeWatch(GROUND_RULES), by_itself=False, stuck_for=5.0)[1] == [FailsafeAction.STAND]
    assert after(1.0, FailsafeWatch(GROUND_RULES), by_itself=True, stuck_for=5.0) == (
        [("stuck", True)],
        [],
    )  # the planner tries to get free
    assert after(1.0, FailsafeWatch(GROUND_RULES), by_hand=True, stuck_for=5.0) == ([("stuck", True)], [])


def test_what_is_ordered_stays_in_force_until_its_cause_ends_or_somebody_overrules_it():
    watch = FailsafeWatch(GROUND_RULES)
    after(5.0, watch, charge=0.15)
    assert watch.in_force(GroundFailsafeInputs()).rule.name == "battery_low"
    watch.overrule()
    assert watch.in_force(GroundFailsafeInputs()) is None
    after(5.0, watch)
    after(5.0, watch, charge=0.15)
    assert watch.in_force(GroundFailsafeInputs()).rule.name == "battery_low"


def test_every_choice_of_an_action_is_known():
    assert {*get_args(Choice), "wait"} == set(ACTIONS)
