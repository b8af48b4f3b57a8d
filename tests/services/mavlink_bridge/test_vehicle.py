"""A bridged vehicle before scripted packets: what it tells, what it leaves out, and how it meets restarts and odd autopilots."""

import math

import numpy as np
import pytest

from schemas.messages import ArmRequest, Event, GoalRequest, Mission, MissionItem, MissionRequest, Mode, ModeRequest, Vector3
from services.mavlink_bridge.autopilot import Autopilot
from services.mavlink_bridge.frame import BridgeOrigin
from services.mavlink_bridge.requests import Requests
from tests.services.autopilot.mavlink.rig import ORIGIN
from tests.services.mavlink_bridge.far_end import ARDUPILOT, DT, PX4, PlanKeeper, ack, heartbeat, item, text
from uvf.maths.rotations import from_euler
from uvf.mavlink import dialect as mav
from uvf.runtime.messages.convert import array

HOME = (407700000, 147900000, 320000)  # 1e-7 deg, mm
ACCEPTED = mav.MAV_RESULT_ACCEPTED


def position(ms=1000, lat=HOME[0], lon=HOME[1], alt=400000, velocity=(300, 400, -100)):
    return mav.MAVLink_global_position_int_message(ms, lat, lon, alt, alt - HOME[2], *velocity, 9000)


def attitude(ms=1000, roll=0.1, pitch=0.2, yaw=0.3):
    w, x, y, z = from_euler(roll, pitch, yaw)
    return mav.MAVLink_attitude_quaternion_message(ms, w, x, y, z, 0.01, 0.02, 0.03)


def home(lat=HOME[0], lon=HOME[1], alt=HOME[2]):
    nan = math.nan
    return mav.MAVLink_home_position_message(lat, lon, alt, 0, 0, 0, (nan,) * 4, nan, nan, nan)


def current(seq=0, total=0, state=0, ids=(0, 0, 0)):
    return mav.MAVLink_mission_current_message(seq, total, state, 0, *ids)


class Scripted:
    """Its autopilot beats each second, accepts what it is told to, and keeps plans."""

    def __init__(self, autopilot=PX4, type_=mav.MAV_TYPE_FIXED_WING, origin=ORIGIN, custom=50593792):
        self.beat = lambda: heartbeat(autopilot, type_, self.custom, self.base)
        self.custom, self.base = custom, 1 | 128
        self.keeper = PlanKeeper()
        self.results = {}
        self.beats, self.t, self.next_beat = True, 0.0, 0.0
        self.sent, self.said, self.telling = [], [], {}
        self.vehicle = Autopilot(1, 1, self.beat(), BridgeOrigin(origin))
        self.requests = Requests(self.vehicle)

    def run(self, seconds, *messages):
        coming = list(messages)
        for _ in range(round(seconds / DT)):
            self.t += DT
            if self.beats and self.t >= self.next_beat:
                self.next_beat = self.t + 1.0
                coming += [self.beat(), *self.telling.values()]
            self.vehicle.step(self.t, coming + self.keeper.speak(self.t))
            self.requests.tick()
            out = self.vehicle.wire.take_out()
            self.sent += out
            self.keeper.hear(self.t, out)
            coming = [ack(m.command, self.results.get(m.command, ACCEPTED)) for m in out if "COMMAND_" in m.get_type()]
            self.said += self.vehicle.events
            self.vehicle.events = []

    def tell(self, *messages):
        self.telling |= {m.get_type(): m for m in messages}

    def texts(self):
        return [text for _, text in self.said]

    def ask(self, request, seconds=1.0):
        later = self.requests.ask(request)
        self.run(seconds)
        return later.reply

    def commands(self, number):
        return [m for m in self.sent if "COMMAND_" in m.get_type() and m.command == number]


@pytest.fixture
def plane():
    scripted = Scripted()
    scripted.tell(position(), attitude(), home(), current())
    scripted.run(3.0)
    return scripted


def test_position_velocity_and_attitude_are_in_the_worlds_frame(plane):
    plane.run(0.04, position(2000), attitude(2000))
    nav = plane.vehicle.telemetry.nav(plane.vehicle.chart)
    assert array(nav.position) == pytest.approx((0.0, 0.0, 100.0), abs=0.01)
    assert array(nav.velocity) == pytest.approx((4.0, 3.0, 1.0))
    assert array(nav.angular_velocity) == pytest.approx((0.01, -0.02, -0.03))
    east_of_nose = math.pi / 2 - 0.3
    w, z = nav.orientation.w, nav.orientation.z
    assert 2 * math.atan2(z, w) == pytest.approx(east_of_nose, abs=0.05)
    assert plane.vehicle.telemetry.nav(plane.vehicle.chart) is None, "nothing new"


@pytest.mark.parametrize("bad", [attitude(2000, roll=math.nan), mav.MAVLink_attitude_quaternion_message(2000, 0, 0, 0, 0, 0, 0, 0)])
def test_an_attitude_that_is_none_is_not_told(bad):
    scripted = Scripted()
    scripted.tell(home())
    scripted.run(3.0)
    scripted.run(0.04, position(2000), bad)
    assert scripted.vehicle.telemetry.nav(scripted.vehicle.chart) is None


def test_what_is_not_told_is_not_made_up(plane):
    status = plane.vehicle.status()
    assert status.battery_remaining == -1 and not status.HasField("circle") and status.throttle == 0
    assert plane.vehicle.telemetry.battery() is None and plane.vehicle.telemetry.gnss() is None


def test_before_any_origin_is_known_no_place_is_told_nor_taken():
    scripted = Scripted(origin=None)
    scripted.tell(position(), attitude())
    scripted.run(3.0)
    assert scripted.vehicle.chart is None and not scripted.vehicle.status().HasField("home")
    reply = scripted.ask(GoalRequest(position=Vector3(x=1.0)))
    assert not reply.accepted and "where it is" in reply.reason
    scripted.tell(home())
    scripted.run(1.1)
    assert array(scripted.vehicle.status().home) == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)


def test_reasons_against_arming_are_the_autopilots_own_words(plane):
    bit = mav.MAV_SYS_STATUS_PREARM_CHECK
    unknown = (0, 0xFFFF, -1, -1, 0, 0, 0, 0, 0, 0)
    plane.run(0.1, mav.MAVLink_sys_status_message(bit, bit, 0, *unknown))
    assert plane.vehicle.status().prearm == ["the autopilot's checks before arming fail"]
    plane.run(0.1, text("PreArm: no GNSS"), text("PreArm: no GNSS"), text("PreArm: battery low"))
    assert plane.vehicle.status().prearm == ["PreArm: no GNSS", "PreArm: battery low"]
    plane.run(0.1, mav.MAVLink_sys_status_message(bit, bit, bit, *unknown))
    assert list(plane.vehicle.status().prearm) == []


def test_grave_words_are_grave_events(plane):
    plane.run(0.1, text("engine failure", mav.MAV_SEVERITY_ALERT), text("hello", mav.MAV_SEVERITY_INFO))
    assert (Event.CRITICAL, "engine failure") in plane.said and (Event.INFO, "hello") in plane.said


def test_a_lost_link_refuses_at_once_ends_what_waits_and_comes_back(plane):
    plane.results[mav.MAV_CMD_COMPONENT_ARM_DISARM] = mav.MAV_RESULT_IN_PROGRESS
    waiting = plane.requests.ask(ArmRequest(arm=True))
    plane.beats = False
    plane.run(5.0)
    assert waiting.reply.reason in ("the link was lost", "not done within 4.5 s; it may still be")
    assert any("link lost: no heartbeat for" in words for words in plane.vehicle.status().failsafes)
    assert plane.ask(ArmRequest(arm=True), 0.1).reason == "no link to the autopilot"
    asked = len(plane.commands(mav.MAV_CMD_SET_MESSAGE_INTERVAL))
    plane.beats = True
    plane.run(3.0)
    assert not plane.vehicle.status().failsafes
    assert len(plane.commands(mav.MAV_CMD_SET_MESSAGE_INTERVAL)) >= 2 * asked - 1, "its rates are asked for anew"


def test_a_restart_of_the_autopilot_is_seen_by_its_clock_and_everything_is_asked_anew(plane):
    plane.keeper.plans[0] = [item(0), item(1)]
    plane.tell(position(90_000), attitude(90_000))
    plane.run(2.0)
    plane.tell(position(500), attitude(500))
    plane.run(4.0)
    assert plane.texts().count("the autopilot has started anew") == 1
    assert len(plane.vehicle.plans.mission.items) == 2


def test_somebody_elses_plan_is_read_when_its_id_changes_and_only_then(plane):
    plane.keeper.plans[0] = [item(0), item(1), item(2)]
    plane.tell(current(ids=(77, 0, 0), total=3))
    plane.run(3.0)
    assert len(plane.vehicle.plans.mission.items) == 3
    lists = sum(m.get_type() == "MISSION_REQUEST_LIST" for m in plane.sent)
    plane.run(5.0)
    assert sum(m.get_type() == "MISSION_REQUEST_LIST" for m in plane.sent) == lists


def test_items_that_the_system_has_no_word_for_go_back_unchanged(plane):
    strange = item(1, command=183, p=(5.0, 1500.0, 0.0, 0.0), x=3, y=4)
    plane.keeper.plans[0] = [item(0), strange, item(2, frame=10)]
    plane.tell(current(ids=(5, 0, 0), total=3))
    plane.run(3.0)
    mission = plane.vehicle.plans.mission
    assert [i.kind for i in mission.items] == [MissionItem.WAYPOINT, MissionItem.JUMP, MissionItem.JUMP]
    assert plane.ask(MissionRequest(mission=mission), 3.0).accepted
    back = [(m.command, m.frame, m.param2, m.x) for m in plane.keeper.plans[0]]
    assert back == [(16, 6, 0.0, 407700000), (183, 6, 1500.0, 3), (16, 10, 0.0, 407700000)]


def test_an_item_that_was_moved_goes_where_it_was_moved_to(plane):
    plane.keeper.plans[0] = [item(0)]
    plane.tell(current(ids=(5, 0, 0), total=1))
    plane.run(3.0)
    mission = Mission()
    mission.CopyFrom(plane.vehicle.plans.mission)
    mission.items[0].position.x += 100.0
    assert plane.ask(MissionRequest(mission=mission), 3.0).accepted
    assert plane.keeper.plans[0][0].y > 147900000 + 10000


def test_ardupilot_keeps_home_in_item_0_and_modes_are_numbers():
    scripted = Scripted(ARDUPILOT, mav.MAV_TYPE_GROUND_ROVER, custom=10)
    scripted.keeper.plans[0] = [item(0), item(1, x=407710000), item(2, command=177, p=(1.0, 3.0, 0.0, 0.0), frame=2)]
    scripted.tell(position(), attitude(), home(), current(seq=1, total=2))
    scripted.run(4.0)
    mission = scripted.vehicle.plans.mission
    assert [i.kind for i in mission.items] == [MissionItem.WAYPOINT, MissionItem.JUMP] and mission.items[1].jump_to == 0
    status = scripted.vehicle.status()
    assert (status.mode, status.waypoint, scripted.vehicle.progress().total) == (Mode.MODE_MISSION, 0, 2)
    assert scripted.ask(MissionRequest(mission=mission), 3.0).accepted
    first, second, jump = scripted.keeper.plans[0]
    assert (first.x, first.frame, second.x, jump.param1) == (HOME[0], 0, 407710000, 1.0)
    assert scripted.ask(ModeRequest(mode=Mode.MODE_HOLD)).accepted
    assert scripted.commands(mav.MAV_CMD_DO_SET_MODE)[-1].param2 == 4.0
    refused = scripted.ask(ModeRequest(mode=Mode.MODE_TAKEOFF))
    assert not refused.accepted and refused.reason == "the autopilot has no mode like Takeoff"


def test_an_old_autopilot_is_asked_for_its_streams_by_groups():
    scripted = Scripted()
    scripted.results[mav.MAV_CMD_SET_MESSAGE_INTERVAL] = mav.MAV_RESULT_UNSUPPORTED
    scripted.run(12.0)
    assert any(m.get_type() == "REQUEST_DATA_STREAM" for m in scripted.sent)
    asked = [m.param1 for m in scripted.commands(mav.MAV_CMD_SET_MESSAGE_INTERVAL)]
    assert mav.MAVLINK_MSG_ID_ATTITUDE in asked


def test_a_goal_goes_out_above_sea_level_with_the_direction_of_its_circle(plane):
    assert plane.ask(GoalRequest(position=Vector3(z=50.0), yaw=math.nan, radius=-80.0)).accepted
    sent = plane.commands(mav.MAV_CMD_DO_REPOSITION)[-1]
    assert (sent.frame, sent.z, sent.param3, sent.param4) == (0, pytest.approx(350.0), 80.0, 1.0)
    assert (sent.x, sent.y) == (pytest.approx(407700000, abs=1), pytest.approx(147900000, abs=1))


def test_any_packet_with_any_numbers_breaks_nothing(plane):
    """Every message of the dialect, its fields at random, also not finite ones."""
    rng = np.random.default_rng(5)
    client = mav.MAVLink(None, 1, 1)
    for number, kind in sorted(mav.mavlink_map.items()):
        for _ in range(3):
            payload = rng.bytes(kind.unpacker.size) if rng.random() < 0.7 else b"\xff" * kind.unpacker.size
            head = bytes((0xFD, len(payload), 0, 0, 0, 1, 1)) + number.to_bytes(3, "little")
            crc = mav.x25crc(head[1:] + payload + bytes((kind.crc_extra,))).crc
            for message in client.parse_buffer(head + payload + crc.to_bytes(2, "little")) or ():
                plane.run(DT, message)
        plane.vehicle.status()
        if plane.vehicle.chart is not None:
            plane.vehicle.telemetry.nav(plane.vehicle.chart)
        plane.vehicle.progress(), plane.vehicle.telemetry.gnss(), plane.vehicle.telemetry.battery()
