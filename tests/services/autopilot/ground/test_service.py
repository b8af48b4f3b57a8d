"""The ground autopilot step by step: nothing moves that should not, and it says why."""

import pytest
from msgspec import structs

from schemas.messages import (
    ArmRequest,
    Battery,
    DriveCommand,
    Fence,
    FenceRequest,
    FenceZone,
    Link,
    Mission,
    MissionItem,
    MissionProgress,
    MissionRequest,
    Mode,
    ModeRequest,
    PoseInFrame,
    SetCurrentRequest,
    Vector3,
)
from services.autopilot.ground.multiplexer import SOURCES
from services.autopilot.ground.params import GroundAutopilotParams
from services.autopilot.ground.service import GroundAutopilot
from tests.runtime.stepping import recall, stepped
from tests.services.live_params import all_settable_are_read
from tests.stops import ENGAGED, RELEASED
from uvf.models.vehicle.drive import DifferentialDriveFile, MecanumFile
from uvf.models.vehicle.file import GroundBody, Motor
from uvf.runtime.messages.convert import planar_pose, stamp
from uvf.runtime.state.stop_all import StopStatus

BODY = GroundBody(
    urdf="x.urdf",
    drive=DifferentialDriveFile(left="l", right="r", wheel_radius=0.05, track=0.2),
    radius=0.15,
    max_linear=0.5,
    max_angular=2.0,
    max_linear_acceleration=1.0,
    max_angular_acceleration=4.0,
    motor=Motor(stall_torque=1.0, no_load_speed=100.0),
)
WAYPOINTS = [MissionItem(position=Vector3(x=1.0)), MissionItem(position=Vector3(x=2.0))]
NOBODY = dict.fromkeys(("teleop", "mavlink", "gcs", "client", "executive", "offboard", "planner", "pose", "link"))
NOBODY |= {"stop": StopStatus(), "imu": [], "ticks": None, "scan": None, "joints": None, "correction": None, "battery": None}
NOTHING_ASKED = {name: [] for name in GroundAutopilot.requests}


class Bench:
    """Steps the service at 50 Hz, keeping commands fresh, and remembers what it last said."""

    def __init__(self, begins=True, items=(), body=BODY):
        self.service = GroundAutopilot(body, (3.0, 4.0), (begins, begins, list(items)), 7, GroundAutopilotParams())
        self.t = 0.0
        self.said = {}
        self.events = []

    def step(self, n=1, linear=None, source="planner", pose=None, **inputs):
        for _ in range(n):
            self.t += 0.02
            values = {**NOBODY, **NOTHING_ASKED, **inputs}
            if linear is not None:
                values[source] = DriveCommand(timestamp=stamp(self.t - 0.02), linear=linear)
            if pose is not None:
                values["pose"] = PoseInFrame(pose=planar_pose(*pose, 0.0))
            out = stepped(self.service, self.t, **values)
            self.said.update(out)
            self.events += [e.text for e in out["events"]]
        return self

    @property
    def speed(self):
        wheels = self.said["wheels"]
        return BODY.drive.wheel_radius * (wheels.left + wheels.right) / 2


def test_the_planner_drives_in_mode_mission():
    bench = Bench().step(40, linear=0.4)
    assert bench.speed == pytest.approx(0.4)
    assert (bench.said["status"].command_source, bench.said["status"].system_id) == ("planner", 7)
    assert "commands from planner" in bench.events


def test_speed_rises_no_faster_than_the_body_allows():
    assert Bench().step(1, linear=0.5).speed == pytest.approx(1.0 * 0.02)


def test_turning_left_drives_the_right_wheel():
    bench = Bench()
    for i in range(60):
        bench.step(planner=DriveCommand(timestamp=stamp(0.02 * i), angular=1.0))
    assert bench.said["wheels"].right == pytest.approx(2.0)
    assert bench.said["wheels"].left == pytest.approx(-2.0)


def test_sideways_each_wheel_has_a_speed_of_its_own():
    drive = MecanumFile(left=["a", "b"], right=["c", "d"], wheel_radius=0.05, track=0.2, wheelbase=0.2)
    bench = Bench(body=structs.replace(BODY, drive=drive))
    for i in range(60):
        bench.step(planner=DriveCommand(timestamp=stamp(0.02 * i), lateral=1.0))
    assert list(bench.said["wheels"].each) == pytest.approx([-10.0, 10.0, 10.0, -10.0])  # at the limit of 0.5 m/s
    assert bench.said["status"].throttle == pytest.approx(1.0)


def test_who_cannot_drive_sideways_says_so_once_and_drives_on():
    bench = Bench()
    for i in range(60):
        bench.step(planner=DriveCommand(timestamp=stamp(0.02 * i), linear=0.3, lateral=0.4))
    assert bench.speed == pytest.approx(0.3) and not bench.said["wheels"].each
    assert bench.events.count("sideways velocity of planner left out") == 1


def test_a_stale_command_stops_within_half_a_second_and_the_ramp():
    bench = Bench().step(40, linear=0.4)
    last = DriveCommand(timestamp=stamp(bench.t - 0.02), linear=0.4)
    bench.step(23, planner=last)
    assert bench.speed == pytest.approx(0.4)
    bench.step(23, planner=last)
    assert bench.speed == 0.0
    bench.step(5, planner=last)
    assert "no fresh command" in bench.said["status"].reason


@pytest.mark.parametrize("wrong", [float("nan"), float("inf")])
def test_a_command_that_is_no_number_stops_it_once_and_is_forgotten(wrong):
    bench = Bench().step(40, linear=0.4).step(40, linear=wrong)
    assert bench.speed == 0.0
    assert "not a velocity: planner" in bench.said["status"].reason
    assert bench.step(40, linear=0.4).speed == pytest.approx(0.4)


def test_refusals_are_told_at_most_every_ten_seconds():
    bench = Bench().step(49 * 10 + 40, linear=float("nan"))
    assert len([e for e in bench.events if e.startswith("command refused: planner")]) == 2


def test_stop_all_holds_until_it_is_released():
    bench = Bench().step(40, linear=0.4)
    bench.step(25, linear=0.4, stop=ENGAGED)
    assert bench.speed == 0.0
    bench.step(200, linear=0.4, stop=ENGAGED)
    assert bench.speed == 0.0
    assert bench.said["status"].stopped
    bench.step(40, linear=0.4, stop=RELEASED)
    assert bench.speed == pytest.approx(0.4)
    assert [e for e in bench.events if "STOP" in e] == ["STOP ALL: standing until it is released", "STOP ALL is released"]


def test_what_it_says_names_who_engaged_stop_all_and_why():
    bench = Bench().step(30, linear=0.4, stop=ENGAGED)
    assert bench.said["status"].reason == "STOP ALL is engaged by gcs (button)"
    refused = bench.step(stop=ENGAGED, arm=[ArmRequest(arm=True)]).said["arm"][0].reason
    assert refused == "STOP ALL is engaged by gcs (button): release it first"


def test_cannot_be_armed_under_stop_all():
    bench = Bench(begins=False).step(stop=ENGAGED, arm=[ArmRequest(arm=True)])
    assert not bench.said["arm"][0].accepted


def test_without_a_job_it_begins_disarmed_and_holding():
    bench = Bench(begins=False).step(40, linear=0.4)
    assert bench.speed == 0.0
    assert (bench.said["status"].armed, bench.said["status"].mode) == (False, Mode.MODE_HOLD)


def test_disarmed_means_no_motion_in_any_mode():
    for mode in SOURCES:
        bench = Bench(begins=False).step(set_mode=[ModeRequest(mode=mode)])
        for source in ("teleop", "planner", "offboard"):
            assert bench.step(10, linear=0.4, source=source).speed == 0.0


def test_a_person_takes_over_by_mode_and_gives_back():
    bench = Bench().step(40, linear=0.4).step(set_mode=[ModeRequest(mode=Mode.MODE_MANUAL, source="gcs")], linear=0.4)
    assert bench.step(40, linear=0.4).speed == 0.0
    assert bench.step(40, linear=-0.2, source="teleop").speed == pytest.approx(-0.2)
    bench.step(set_mode=[ModeRequest(mode=Mode.MODE_MISSION, source="gcs")]).step(60, linear=0.4)
    assert bench.speed == pytest.approx(0.4)
    assert [e for e in bench.events if "mode" in e] == ["mode MANUAL", "mode MISSION"]


def test_a_mode_that_a_ground_vehicle_lacks_is_refused():
    reply = Bench().step(set_mode=[ModeRequest(mode=Mode.MODE_LAND)]).said["set_mode"][0]
    assert not reply.accepted
    assert "MANUAL" in reply.reason
    assert "no mode LAND" in reply.reason


def test_the_mission_advances_with_the_pose():
    bench = Bench(items=WAYPOINTS).step(1, pose=(0.0, 0.0))
    assert bench.said["mission"].items[1].position.x == 2.0
    bench.step(50, pose=(0.9, 0.0))
    assert (bench.said["progress"].current, bench.said["progress"].reached) == (1, 0)
    assert bench.said["status"].distance_to_waypoint == pytest.approx(1.1)
    bench.step(50, pose=(2.1, 0.0))
    assert bench.said["progress"].state == MissionProgress.COMPLETE
    assert "mission item 1 reached" in bench.events


def test_a_new_mission_is_published_once():
    bench = Bench(items=WAYPOINTS).step(10)
    bench.said.pop("mission")
    bench.step(set_mission=[MissionRequest(mission=Mission(items=WAYPOINTS[:1]))])
    assert len(bench.said.pop("mission").items) == 1
    assert "mission" not in bench.step(10).said


def test_a_mission_for_aircraft_is_refused_and_the_old_one_kept():
    bench = Bench(items=WAYPOINTS).step(set_mission=[MissionRequest(mission=Mission(items=[MissionItem(kind=MissionItem.LAND)]))])
    assert bench.said["set_mission"][0].reason == "item 0: LAND is not for a ground vehicle"
    assert bench.step(30, pose=(0.0, 0.0)).said["progress"].total == 2


def test_jumps_to_an_item_on_request():
    bench = Bench(items=WAYPOINTS).step(set_current=[SetCurrentRequest(index=1), SetCurrentRequest(index=5)])
    assert [r.accepted for r in bench.said["set_current"]] == [True, False]
    assert bench.step(30, pose=(0.0, 0.0)).said["progress"].current == 1


def test_started_again_it_goes_on_as_it_was():
    old = Bench(items=WAYPOINTS).step(30, pose=(0.9, 0.0)).step(set_mode=[ModeRequest(mode=Mode.MODE_MANUAL)]).step(30)
    new = Bench(begins=False)
    recall(new.service, status=old.said["status"], mission=old.said["mission"], progress=old.said["progress"])
    new.step(1)
    assert (new.said["status"].mode, new.said["status"].armed) == (Mode.MODE_MANUAL, True)
    assert (new.said["progress"].current, new.said["progress"].total) == (1, 2)


def test_stop_all_stays_through_a_restart_until_it_is_released():
    old = Bench().step(30, linear=0.4, stop=ENGAGED)
    new = Bench()
    recall(new.service, status=old.said["status"])
    new.step(40, linear=0.4, stop=ENGAGED)
    assert (new.speed, new.said["status"].stopped, list(new.said["status"].stops)) == (0.0, True, list(ENGAGED.engagements))
    assert new.step(40, linear=0.4, stop=RELEASED).speed == pytest.approx(0.4)


def test_a_release_that_was_missed_during_a_restart_counts():
    old = Bench().step(30, stop=ENGAGED)
    new = Bench()
    recall(new.service, status=old.said["status"])
    assert new.step(40, linear=0.4, stop=RELEASED).speed == pytest.approx(0.4)


def test_a_speed_item_limits_the_mission_but_not_the_person():
    bench = Bench(items=[MissionItem(kind=MissionItem.SPEED, speed=0.1), *WAYPOINTS]).step(60, linear=0.4, pose=(0.0, 0.0))
    assert bench.speed == pytest.approx(0.1)
    bench.step(set_mode=[ModeRequest(mode=Mode.MODE_MANUAL)]).step(60, linear=0.4, source="teleop")
    assert bench.speed == pytest.approx(0.4)


def test_parameters_set_while_running_count():
    bench = Bench(items=WAYPOINTS)
    with all_settable_are_read(bench.service):
        bench.step(170, pose=(0.0, 0.0), battery=Battery(remaining=0.01), link=Link(stations=1))
        bench.step(arm=[ArmRequest(arm=True, force=True)], set_mode=[ModeRequest(mode=Mode.MODE_MANUAL)])
        bench.step(30, linear=0.4, source="teleop", pose=(0.0, 0.0)).step(300)
        fence = Fence(zones=[FenceZone(centre=Vector3(x=0.0), radius=0.5)])
        bench.step(set_fence=[FenceRequest(fence=fence)], set_mode=[ModeRequest(mode=Mode.MODE_MANUAL)], pose=(0.0, 0.0))
        bench.step(30, linear=0.4, source="teleop", pose=(0.28, 0.0))
    bench = Bench(items=WAYPOINTS)
    bench.step(30, pose=(0.5, 0.0))
    assert bench.said["progress"].reached == -1
    bench.service.params = GroundAutopilotParams(acceptance_radius=0.6)
    assert bench.step(30, pose=(0.5, 0.0)).said["progress"].reached == 0


def test_offboard_is_refused_while_it_is_disarmed_with_the_reason():
    reply = Bench(begins=False).step(set_mode=[ModeRequest(mode=Mode.MODE_OFFBOARD, source="client")]).said["set_mode"][0]
    assert not reply.accepted and "arm it before mode Offboard" in reply.reason
