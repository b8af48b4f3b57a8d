"""What the bus may ask that no autopilot can be told: refused in a line that says what, and how to mend it; nothing is sent."""

import json
import math

import pytest

from schemas.messages import (
    ArmRequest,
    Fence,
    FenceRequest,
    FenceZone,
    GoalRequest,
    Mission,
    MissionItem,
    MissionRequest,
    Mode,
    ModeRequest,
    OrbitRequest,
    ParamRequest,
    RallyPoints,
    RallyRequest,
    SetCurrentRequest,
    SpeedCommand,
    TakeoffCommand,
    Vector3,
    VehicleCommandRequest,
)
from services.mavlink_bridge.commands import ANSWER_WITHIN, WAITING_MOST, CommandSender, command
from services.mavlink_bridge.connection import Wire
from services.mavlink_bridge.parameters import WAITING_MOST as PARAMETERS_MOST
from services.mavlink_bridge.transfers import LARGEST
from tests.services.mavlink_bridge.far_end import ARDUPILOT, ack, item
from tests.services.mavlink_bridge.test_parameters import INT, Shelf
from tests.services.mavlink_bridge.test_vehicle import Scripted, attitude, current, home, position
from uvf.mavlink import dialect as mav
from uvf.runtime.mavlink.mission_items import ORIGIN

FAR, HIGH = Vector3(x=9e11), Vector3(z=-9e11)
PLACE = Vector3(x=100.0, y=50.0, z=60.0)


@pytest.fixture
def plane():
    scripted = Scripted()
    scripted.tell(position(), attitude(), home(), current())
    scripted.keeper.plans[0] = [item(0), item(1)]
    scripted.run(3.0)
    return scripted


def waypoint(**fields):
    return MissionItem(**{"position": PLACE, **fields})


def mission(*items):
    return MissionRequest(mission=Mission(items=items))


def fence(*zones, **fields):
    return FenceRequest(fence=Fence(zones=zones, **fields))


@pytest.mark.parametrize(
    ("request_", "why"),
    [
        (ModeRequest(mode=99), "there is no mode 99: name one of MANUAL"),
        (ModeRequest(mode=-1), "there is no mode -1"),
        (ModeRequest(), "no mode like Unspecified"),
        (GoalRequest(position=FAR, yaw=math.nan), "9e+08 km from the world's origin: name one within 200 km"),
        (GoalRequest(position=HIGH, yaw=math.inf), "-9e+11 m high: name one within"),
        (GoalRequest(position=PLACE, radius=9e11), "a radius of 9e+11 m: name one from"),
        (GoalRequest(position=PLACE, speed=9e11), "a speed of 9e+11 m/s"),
        (OrbitRequest(centre=FAR), "from the world's origin"),
        (OrbitRequest(centre=PLACE, speed=-5.0), "a speed of -5 m/s"),
        (VehicleCommandRequest(), "the order is empty"),
        (VehicleCommandRequest(takeoff=TakeoffCommand(altitude=9e11)), "above sea level: name one within"),
        (VehicleCommandRequest(speed=SpeedCommand(speed=9e11)), "a speed of"),
        (SetCurrentRequest(index=2), "there is no mission item 2: the last one is 1"),
        (SetCurrentRequest(index=2**32 - 1), "there is no mission item 4294967295"),
        (mission(waypoint(), waypoint(kind=99)), "item 1: there is no kind 99 of mission item"),
        (mission(waypoint(origin=b"short")), "item 0: an origin of 5 bytes, not 32: leave origin out"),
        (mission(MissionItem(kind=MissionItem.LAND)), "item 0: a LAND needs a position"),
        (
            mission(waypoint(), MissionItem(kind=MissionItem.JUMP, jump_to=2**32 - 1)),
            "a jump to item 4294967295: the last one is 1",
        ),
        (mission(waypoint(position=FAR)), "item 0: that place is 9e+08 km"),
        (mission(*[waypoint()] * 70_000), "a plan of 70000 items: at most 5000"),
        (fence(origin=[b"x" * 28]), "an origin of 28 bytes, not 32"),
        (fence(FenceZone(centre=PLACE)), "radius 0 is out of range"),
        (fence(FenceZone(centre=PLACE, radius=9e11)), "radius 9e+11 is out of range"),
        (fence(FenceZone(centre=FAR, radius=50.0)), "from the world's origin"),
        (fence(FenceZone(vertices=[PLACE, PLACE])), "a polygon of 2 corners"),
        (fence(FenceZone(vertices=[PLACE] * 200)), "a polygon of 200 corners"),
        (fence(FenceZone(centre=PLACE, radius=50.0, group=2**32 - 1)), "is out of range"),
        (RallyRequest(rally=RallyPoints(points=[PLACE], origin=[b""])), "an origin of 0 bytes"),
        (RallyRequest(rally=RallyPoints(points=[FAR])), "from the world's origin"),
        (ParamRequest(name="RTL_ALT", value="9" * 400), "is no number"),
        (ParamRequest(name="RTL_ALT", value="[" * 20_000), "is no number"),
        (ParamRequest(name="A\nB"), "at most 16 letters"),
    ],
    ids=lambda value: type(value).__name__ if not isinstance(value, str) else value[:40],
)
def test_what_no_autopilot_can_be_told_is_refused_and_not_sent(plane, request_, why):
    sent = len(plane.sent)
    reply = plane.ask(request_, 0.1)
    assert not reply.accepted and why in reply.reason and len(reply.reason) < 400
    assert [m.get_type() for m in plane.sent[sent:] if "REQUEST" not in m.get_type()] == []


def strange(**fields):
    values = {"frame": 3, "command": 16, "autocontinue": 1, "p": (0.0,) * 4, "x": 407700000, "y": 147900000, "z": 60.0} | fields
    p = values.pop("p")
    return ORIGIN.pack(values["frame"], values["command"], values["autocontinue"], *p, values["x"], values["y"], values["z"])


@pytest.mark.parametrize(
    ("sent", "flown"),
    [
        (MissionItem(kind=MissionItem.SPEED, speed=20.0, origin=strange(command=21)), (178, 20.0)),
        (MissionItem(kind=MissionItem.RETURN, origin=strange(frame=255, command=65535, p=(math.nan,) * 4)), (20, 0.0)),
        (MissionItem(kind=MissionItem.SPEED, speed=25.0, origin=strange(command=178, p=(0.0, 20.0, -1.0, 0.0))), (178, 25.0)),
    ],
    ids=["another kind", "no item at all", "changed since"],
)
def test_an_item_flies_as_the_bus_sees_it_whatever_bytes_it_claims_to_come_from(plane, sent, flown):
    assert plane.ask(mission(waypoint(), sent), 3.0).accepted
    got = plane.keeper.plans[0][1]
    assert (got.command, got.param2) == flown


def test_a_fence_and_rally_points_that_were_changed_go_out_changed(plane):
    circle = FenceZone(centre=PLACE, radius=300.0)
    assert plane.ask(fence(circle), 3.0).accepted
    read = plane.vehicle.plans.news["fence"]
    read.zones[0].radius = 200.0
    assert plane.ask(FenceRequest(fence=read), 3.0).accepted
    assert [m.param1 for m in plane.keeper.plans[1]] == [200.0]
    assert plane.ask(RallyRequest(rally=RallyPoints(points=[PLACE])), 3.0).accepted
    rally, before = plane.vehicle.plans.news["rally"], plane.keeper.plans[2][0].y
    rally.points[0].x += 1000.0
    assert plane.ask(RallyRequest(rally=rally), 3.0).accepted
    assert plane.keeper.plans[2][0].y > before + 100_000


@pytest.mark.parametrize("bytewise", [True, False], ids=["PX4", "ArduPilot"])
@pytest.mark.parametrize(
    ("kind", "value", "why"),
    [
        (mav.MAV_PARAM_TYPE_INT8, "300", "300 is not within -128 and 127"),
        (mav.MAV_PARAM_TYPE_UINT8, "-1", "-1 is not within 0 and 255"),
        (INT, "1e300", "is not within"),
        (INT, "9" * 39, "is not within"),
        (mav.MAV_PARAM_TYPE_REAL32, "1e39", "is not within"),
        (mav.MAV_PARAM_TYPE_INT64, "3", "of type 8, which the bridge does not know"),
        (200, "3", "of type 200, which the bridge does not know"),
    ],
)
def test_a_value_that_does_not_fit_the_parameters_type_is_refused(bytewise, kind, value, why):
    shelf = Shelf(bytewise)
    shelf.values["X"] = (0, kind)
    shelf.coded = lambda value, kind: 0.0
    reply = shelf.ask("X", value, 1.0)
    assert not reply.accepted and why in reply.reason


def test_a_whole_number_that_a_float_cannot_hold_is_refused_where_integers_travel_as_floats():
    shelf = Shelf(bytewise=False)
    assert "as 32-bit floats" in shelf.ask("NAV_DLL_ACT", str(2**24 + 1), 1.0).reason
    assert shelf.ask("NAV_DLL_ACT", str(2**24 + 2), 1.0).accepted


@pytest.mark.parametrize("told", [math.nan, math.inf, -math.inf, 3e38])
@pytest.mark.parametrize("kind", [INT, mav.MAV_PARAM_TYPE_INT8])
def test_an_ardupilot_that_tells_no_number_for_an_integer_is_said_to(kind, told):
    shelf = Shelf(bytewise=False)
    shelf.values["X"], shelf.coded = (0, kind), lambda value, kind: told
    assert "which is no number of its type" in shelf.ask("X", "", 1.0).reason


def test_what_is_read_is_always_json_that_others_read(plane):
    shelf = Shelf()
    shelf.values["X"] = (math.nan, mav.MAV_PARAM_TYPE_REAL32)
    reply = shelf.ask("X", "", 1.0)
    assert not reply.accepted and not [json.loads(p.value) for p in reply.params]


def test_a_flood_of_requests_is_refused_and_not_obeyed_minutes_later():
    wire, ended = Wire(1, 1), []
    commands = CommandSender(wire)
    for n in range(10 * WAITING_MOST):
        commands.ask(command(176, (1.0, float(n)), lambda good, why: ended.append((good, why))))
    assert len(ended) == 9 * WAITING_MOST and "ask again later, and less often" in ended[0][1]
    sent = []
    while wire.t < 60.0:
        wire.t += 0.02
        commands.tick()
        sent += [(wire.t, m) for m in wire.take_out()]
    assert len(ended) == 10 * WAITING_MOST and max(t for t, m in sent if m.confirmation == 0) < ANSWER_WITHIN + 4.0


def test_hold_and_disarm_come_before_what_waits(plane):
    silent = plane.results
    silent[176] = silent[400] = mav.MAV_RESULT_IN_PROGRESS
    waiting = [plane.requests.ask(ModeRequest(mode=Mode.MODE_RETURN)) for _ in range(40)]
    waiting += [plane.requests.ask(ArmRequest(arm=True)) for _ in range(40)]
    plane.run(0.1)
    silent[176] = silent[400] = mav.MAV_RESULT_ACCEPTED
    sent = len(plane.sent)
    plane.requests.ask(ModeRequest(mode=Mode.MODE_HOLD))
    plane.requests.ask(ArmRequest(arm=False))
    plane.run(0.04)
    assert [(m.command, m.param1, m.param3) for m in plane.sent[sent:]][:2] == [(176, 1.0, 3.0), (400, 0.0, 0.0)]
    plane.run(1.0)
    assert {later.reply.reason for later in waiting if later.reply and "came first" in later.reply.reason}
    assert plane.commands(176)[-1].param3 == 3.0 and plane.commands(400)[-1].param1 == 0.0


def test_floods_of_parameters_and_plans_are_refused_in_a_line():
    plane = Scripted(ARDUPILOT, mav.MAV_TYPE_FIXED_WING)
    plane.tell(position(), attitude(), home(), current())
    plane.run(3.0)
    plane.keeper.silent = True
    replies = [plane.requests.ask(ParamRequest(name=f"P{n}")) for n in range(2 * PARAMETERS_MOST)]
    replies += [plane.requests.ask(mission(waypoint())) for _ in range(20)]
    assert "parameters are being asked for already" in replies[2 * PARAMETERS_MOST - 1].reply.reason
    assert "plans are being read or written already" in replies[-1].reply.reason


def test_in_progress_for_ever_ends():
    wire, ended = Wire(1, 1), []
    commands = CommandSender(wire)
    commands.ask(command(400, (1.0,), lambda good, why: ended.append(why)))
    while wire.t < 70.0 and not ended:
        wire.t += 1.0
        commands.on_ack(ack(400, mav.MAV_RESULT_IN_PROGRESS))
    assert ended == ["the autopilot says that it is in progress, for more than 60 s"]


def test_who_hears_of_an_end_may_ask_for_something_else():
    wire, ended = Wire(1, 1), []
    commands = CommandSender(wire)
    commands.ask(command(511, (1.0,), lambda good, why: commands.ask(command(512, (1.0,), lambda good, why: ended.append(why)))))
    commands.ask(command(400, (1.0,), lambda good, why: ended.append(why)))
    while wire.t < 20.0:
        wire.t += 1.0
        commands.tick()
    assert len(ended) == 2


def test_the_longest_plan_is_within_what_the_wire_counts():
    assert LARGEST < 2**16
