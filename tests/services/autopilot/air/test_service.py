"""What the autopilot sends, which requests it accepts, and what it does when its sensors fail."""

import math

import pytest

from schemas.messages import (
    ArmRequest,
    Battery,
    Gnss,
    GoalRequest,
    Mission,
    MissionItem,
    MissionProgress,
    MissionRequest,
    Mode,
    ModeRequest,
    SetCurrentRequest,
    Vector3,
)
from services.autopilot.air.service import AutopilotAir
from tests.runtime.stepping import recall, stale
from tests.services.autopilot.air.sensing import WAYPOINTS, Bench, resting, sensors
from tests.stops import ENGAGED, RELEASED


def test_each_report_has_its_own_rate():
    bench = Bench()
    bench.run(cycles=100)
    counts = {name: sum(name in out for out in bench.outputs) for name in AutopilotAir.outputs}
    assert counts == {
        "surfaces": 100,
        "nav_state": 100,
        "pose": 100,
        "body_frame": 100,
        "events": 1,
        "status": 20,
        "targets": 20,
        "quality": 4,
        "progress": 4,
        "path": 4,
        "plan": 1,
        "params": 1,
        "bounds": 1,
        "rally": 1,
    }


def test_the_estimate_is_sent_in_world_axes():
    state = Bench().run(cycles=50)["nav_state"]
    assert state.position.x == pytest.approx(25.0 * 1.0, abs=1.0)
    assert state.velocity.x == pytest.approx(25.0, abs=0.2)
    assert abs(state.orientation.z) < 0.02
    assert state.orientation.y < 0  # nose up


def test_the_status_tells_all():
    bench = Bench()
    bench.run(cycles=6, battery=Battery(voltage=48.0, remaining=0.9))
    status = bench.status
    assert (status.mode, status.armed, status.landed, status.system_id) == (Mode.MODE_MISSION, True, False, 7)
    assert (status.battery_voltage, status.battery_remaining) == (48.0, 0.9)
    assert status.distance_to_waypoint == pytest.approx(900.0, abs=5.0)


def test_an_unknown_battery_is_reported_as_such():
    bench = Bench()
    bench.run()
    assert bench.status.battery_remaining == -1


@pytest.mark.parametrize(("mode", "text"), [(Mode.MODE_HOLD, "mode Hold"), (Mode.MODE_RETURN, "mode Return")])
def test_a_mode_is_changed_and_announced_once(mode, text):
    bench = Bench()
    bench.run()
    (reply,) = bench.run(mode=[ModeRequest(mode=mode, source="test")])["mode"]
    bench.run(cycles=10)
    assert reply.accepted
    assert bench.status.mode == mode
    assert bench.texts.count(text) == 1


@pytest.mark.parametrize("mode", [Mode.MODE_UNSPECIFIED, 99])
def test_a_mode_that_is_not_flown_is_refused_with_a_reason(mode):
    (reply,) = Bench().run(mode=[ModeRequest(mode=mode)])["mode"]
    assert not reply.accepted
    assert "Hold, Mission, Return, Manual, Stabilized" in reply.reason


def test_disarming_in_the_air_takes_force():
    bench = Bench()
    gentle, forced = bench.run(arm=[ArmRequest(arm=False), ArmRequest(arm=False, force=True)])["arm"]
    assert not gentle.accepted
    assert "flying" in gentle.reason
    assert forced.accepted
    assert bench.run()["surfaces"].throttle == 0.0


def test_at_rest_it_disarms_without_force():
    (reply,) = resting().run(speed=0.0, arm=[ArmRequest(arm=False)])["arm"]
    assert reply.accepted


def test_at_rest_and_disarmed_the_surfaces_are_neutral_and_the_brakes_on():
    bench = resting()
    (reply,) = bench.run(speed=0.0, arm=[ArmRequest(arm=False)])["arm"]
    out = bench.run(cycles=100, speed=0.0)["surfaces"]
    assert reply.accepted and bench.status.landed
    assert (out.aileron, out.elevator, out.rudder, out.throttle, out.brake) == (0.0, 0.0, 0.0, 0.0, 1.0)


def test_a_stop_holds_until_it_is_released():
    bench = Bench()
    bench.run(cycles=10, stop=ENGAGED)
    assert (bench.status.mode, bench.status.stopped, bench.status.reason) == (Mode.MODE_HOLD, True, "stopped by gcs (button)")
    (refused,) = bench.run(stop=ENGAGED, mode=[ModeRequest(mode=Mode.MODE_MISSION)])["mode"]
    (accepted,) = bench.run(stop=RELEASED, mode=[ModeRequest(mode=Mode.MODE_MISSION)])["mode"]
    assert (refused.accepted, accepted.accepted) == (False, True)


def test_a_stop_on_the_ground_disarms_and_keeps_it_so():
    bench = resting()
    bench.run(speed=0.0, stop=ENGAGED)
    assert (bench.status.armed, bench.status.reason) == (False, "stopped by gcs (button)")
    out = bench.run(speed=0.0, stop=ENGAGED, arm=[ArmRequest(arm=True)])
    assert not out["arm"][0].accepted
    assert "stopped by gcs (button)" in out["arm"][0].reason
    assert out["surfaces"].throttle == 0.0
    assert bench.run(speed=0.0, stop=RELEASED, arm=[ArmRequest(arm=True)])["arm"][0].accepted


def test_a_stop_in_the_air_leaves_the_motor_alone_even_with_a_blocked_pitot_tube():
    bench = Bench()
    bench.run(cycles=50)
    blocked = sensors(1.0)["air_data"]
    blocked.differential_pressure = 0.0
    bench.run(cycles=50, stop=ENGAGED, air_data=blocked)
    assert bench.status.armed
    assert not bench.status.landed


def test_a_stop_outlasts_a_restart_until_it_is_released():
    bench, heir = Bench(), Bench()
    bench.run(cycles=10, stop=ENGAGED)
    recall(heir.service, status=bench.status)
    (refused,) = heir.run(stop=ENGAGED, mode=[ModeRequest(mode=Mode.MODE_MISSION)])["mode"]
    assert not refused.accepted
    assert "release the stop" in refused.reason
    assert heir.status.stopped
    (accepted,) = heir.run(stop=RELEASED, mode=[ModeRequest(mode=Mode.MODE_MISSION)])["mode"]
    assert accepted.accepted


def test_a_change_of_mode_or_arming_is_in_the_status_at_once():
    bench = Bench()
    bench.run(cycles=6)
    assert bench.run(mode=[ModeRequest(mode=Mode.MODE_HOLD)])["status"].mode == Mode.MODE_HOLD
    assert not bench.run(arm=[ArmRequest(arm=False, force=True)])["status"].armed
    assert bench.run(stop=ENGAGED)["status"].stopped
    assert "status" not in bench.run(stop=ENGAGED)


def test_a_mission_is_taken_announced_and_its_wire_form_kept():
    bench = Bench()
    bench.run()
    mission = Mission(items=[MissionItem(position=Vector3(x=500.0, z=80.0), origin=b"\x07\x08")])
    out = bench.run(mission=[MissionRequest(mission=mission)])
    assert out["mission"][0].accepted
    assert out["plan"].items[0].origin == b"\x07\x08"
    assert out["plan"].id != 0
    assert "plan" not in bench.run()


def test_a_circle_too_tight_is_refused_on_upload_and_a_short_leg_told_of():
    bench = Bench()
    bench.run()
    tight = MissionItem(kind=MissionItem.ORBIT, position=Vector3(x=500.0, z=80.0), radius=20.0)
    out = bench.run(mission=[MissionRequest(mission=Mission(items=[tight]))])
    assert out["mission"][0].reason.startswith("item 0 is a circle of 20 m, too tight at ")
    places = [(0.0, 0.0), (400.0, 0.0), (400.0, 40.0), (0.0, 40.0)]
    rows = Mission(items=[MissionItem(position=Vector3(x=x, y=y, z=80.0)) for x, y in places])
    out = bench.run(mission=[MissionRequest(mission=rows)])
    assert out["mission"][0].accepted
    assert "item 1: a curve is flown past it" in [e.text for e in out["events"]] + [e.text for e in bench.run()["events"]]


def test_pictures_on_a_mission_are_events_with_their_place():
    bench = Bench()
    bench.run()
    items = [MissionItem(kind=MissionItem.TRIGGER), MissionItem(position=Vector3(x=900.0, z=80.0))]
    told = [*bench.run(mission=[MissionRequest(mission=Mission(items=items))])["events"], *bench.run()["events"]]
    assert [e.cause[:5] for e in told if e.text == "camera trigger 1"] == ["at x "]


def test_a_mission_that_cannot_be_flown_is_refused_and_nothing_changes():
    bench = Bench()
    bench.run()
    out = bench.run(mission=[MissionRequest(mission=Mission(items=[MissionItem(kind=98)]))])
    assert not out["mission"][0].accepted
    assert "kind 98" in out["mission"][0].reason
    assert "plan" not in out


def test_progress_follows_the_mission():
    bench = Bench()
    bench.run()
    (reply,) = bench.run(current=[SetCurrentRequest(index=1)])["current"]
    progress = [out["progress"] for out in (bench.run() for _ in range(25)) if "progress" in out][-1]
    assert reply.accepted
    assert (progress.state, progress.current, progress.total) == (MissionProgress.ACTIVE, 1, 2)
    assert progress.mission_id == bench.outputs[0]["plan"].id


def test_a_paused_mission_says_so():
    bench = Bench()
    bench.run()
    bench.run(mode=[ModeRequest(mode=Mode.MODE_HOLD)])
    bench.run(cycles=30)
    assert [out["progress"].state for out in bench.outputs if "progress" in out][-1] == MissionProgress.PAUSED


def test_a_goal_is_flown_to_and_shown_as_a_circle():
    bench = Bench()
    (reply,) = bench.run(goal=[GoalRequest(position=Vector3(x=300.0, y=200.0, z=70.0), source="gcs")])["goal"]
    bench.run(cycles=30)
    path = [out["path"] for out in bench.outputs if "path" in out][-1]
    east = [pose.position.x for pose in path.poses]
    assert reply.accepted
    assert (min(east) + max(east)) / 2 == pytest.approx(300.0, abs=1.0)


def test_the_path_shows_the_mission():
    path = Bench().run()["path"]
    assert [(p.position.x, p.position.y) for p in path.poses] == [(w.position.x, w.position.y) for w in WAYPOINTS]


def test_without_an_imu_it_puts_the_surfaces_to_trim_and_says_so_once():
    bench = Bench()
    bench.run(cycles=10)
    first, second = (stale(bench.service, 0.3 + k / 50, ("imu",)) for k in range(2))
    assert first["surfaces"].aileron == 0.0
    assert first["surfaces"].throttle == pytest.approx(bench.service.params.trim_throttle)
    assert [e.cause for e in first["events"]] == ["imu"]
    assert second["events"] == []
    assert "imu" in first["status"].reason


def test_until_the_first_fix_requests_are_refused_and_nothing_is_commanded():
    out = Bench().run(gnss=Gnss(), arm=[ArmRequest(arm=True)])
    assert "no satellite fix" in out["arm"][0].reason
    assert "surfaces" not in out


def test_a_lost_fix_is_bridged():
    bench = Bench()
    bench.run(cycles=50)
    state = bench.run(cycles=25, gnss=Gnss())["nav_state"]
    assert state.position.x == pytest.approx(25.0 * 1.5, abs=2.0)


@pytest.mark.parametrize("axis", ["x", "y", "z"])
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_goal_that_is_no_place_is_refused(axis, value):
    bench = Bench()
    bench.run()
    (reply,) = bench.run(goal=[GoalRequest(position=Vector3(**{"z": 60.0, axis: value}))])["goal"]
    assert not reply.accepted
    assert "not finite" in reply.reason


@pytest.mark.parametrize("field", ["acceptance_radius", "hold", "radius", "turns", "speed"])
def test_an_item_with_a_number_that_is_not_finite_is_refused_and_nothing_changes(field):
    bench = Bench()
    bench.run()
    mission = Mission(items=[MissionItem(), MissionItem(**{field: math.nan})])
    out = bench.run(mission=[MissionRequest(mission=mission)])
    assert not out["mission"][0].accepted
    assert out["mission"][0].reason == "item 1 holds a number that is not finite"
    assert "plan" not in out


def test_the_return_of_the_imu_is_an_event():
    bench = Bench()
    bench.run()
    stale(bench.service, 0.05, ("imu",))
    bench.run()
    assert "IMU back" in bench.texts


def test_before_its_first_cycle_it_leaves_the_surfaces_alone():
    out = stale(Bench().service, 0.02, ("gnss",))
    assert "surfaces" not in out
    assert "plan" in out
