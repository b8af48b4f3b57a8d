"""Who is heard at an address: autopilots and nobody else, each by its id, from one place at a time."""

import random

import pytest

from schemas.messages import ExternalVehicle, Link, Mode, ModeRequest, StopEngagement
from services.mavlink_bridge.discovery import Discovery, Names, names_from
from services.mavlink_bridge.frame import BridgeOrigin
from services.mavlink_bridge.service import BridgedVehicle
from services.mavlink_bridge.station import COMPONENT, LOST_AFTER, SYSTEM, Station
from tests.runtime.stepping import stepped
from tests.services.autopilot.mavlink.rig import ORIGIN, MemoryLink
from tests.services.mavlink_bridge.far_end import ARDUPILOT, DT, PX4, ack, heartbeat, text
from uvf.mavlink import dialect as mav
from uvf.models.yaml_data import BadInput
from uvf.runtime.state.stop_all import StopStatus

NOBODY = StopStatus()
HERE, THERE = ("127.0.0.1", 5001), ("127.0.0.1", 5002)


class Air:
    def __init__(self):
        self.link = MemoryLink()
        self.link.listening = []
        self.station = Station(self.link)

    def say(self, message, system=1, component=1, peer=HERE):
        self.link.incoming.append((message.pack(mav.MAVLink(None, system, component)), peer))

    def sent(self, to):
        client = mav.MAVLink(None)
        return [m for data, peer in self.link.outgoing if peer == to for m in client.parse_buffer(data) or ()]


@pytest.fixture
def air():
    return Air()


def test_a_heartbeat_of_an_autopilot_makes_it_known_and_it_is_answered_where_it_speaks_from(air):
    air.say(heartbeat())
    air.say(text("hello"))
    assert air.station.poll(0.0) == []
    assert [m.get_type() for m in air.station.fetch(1)] == ["HEARTBEAT", "STATUSTEXT"]
    assert air.station.fetch(1) == []
    air.station.send(1, [mav.MAVLink_mission_request_list_message(1, 1, 0)])
    assert [(m.get_type(), m.get_srcSystem(), m.get_srcComponent()) for m in air.sent(HERE)][-1] == (
        "MISSION_REQUEST_LIST",
        SYSTEM,
        COMPONENT,
    )


@pytest.mark.parametrize(
    ("message", "system", "component"),
    [
        (heartbeat(mav.MAV_AUTOPILOT_INVALID, mav.MAV_TYPE_GCS), 255, 190),
        (heartbeat(mav.MAV_AUTOPILOT_INVALID, mav.MAV_TYPE_CAMERA), 1, 100),
        (heartbeat(mav.MAV_AUTOPILOT_INVALID, mav.MAV_TYPE_ONBOARD_CONTROLLER), 1, 191),
        (heartbeat(), 0, 1),
        (text("no heartbeat yet"), 1, 1),
    ],
)
def test_ground_stations_cameras_and_the_nameless_are_no_vehicles(air, message, system, component):
    air.say(message, system, component)
    air.station.poll(0.0)
    assert air.station.autopilots == {}


def test_other_components_of_a_vehicle_do_not_speak_for_it(air):
    air.say(heartbeat())
    air.say(text("from the camera"), component=100)
    air.station.poll(0.0)
    assert [m.get_type() for m in air.station.fetch(1)] == ["HEARTBEAT"]


def test_whoever_is_heard_hears_once_a_second_that_a_station_is_there(air):
    for t in range(50):
        air.say(heartbeat())
        air.station.poll(t * 0.1)
    beats = air.sent(HERE)
    assert 4 <= len(beats) <= 6 and {m.type for m in beats} == {mav.MAV_TYPE_GCS}


def test_two_of_one_id_at_a_time_only_the_first_counts_and_it_is_told_once(air):
    air.say(heartbeat())
    air.station.poll(0.0)
    told = []
    for t in (0.1, 1.0, 2.0):
        air.say(heartbeat(custom=65536), peer=THERE)
        air.say(heartbeat())
        told += air.station.poll(t)
    assert told == ["system 1 speaks from 127.0.0.1:5002 too; only 127.0.0.1:5001 counts: give one another id"]
    assert air.station.autopilots[1].peer == HERE and air.station.autopilots[1].heartbeat.custom_mode == 50593792


def test_one_that_comes_back_from_another_port_after_a_silence_is_the_same(air):
    air.say(heartbeat())
    air.station.poll(0.0)
    air.say(heartbeat(), peer=THERE)
    assert air.station.poll(LOST_AFTER + 1) == []
    assert air.station.autopilots[1].peer == THERE
    assert len(air.station.fetch(1)) == 2


def test_garbage_and_broken_packets_hurt_nobody_and_make_no_peers(air):
    rng = random.Random(3)
    whole = heartbeat().pack(mav.MAVLink(None, 9, 1))
    for n in range(3000):
        data = bytearray(whole if n % 2 else rng.randbytes(rng.randrange(1, 60)))
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
        air.link.incoming.append((bytes(data), HERE))
    air.station.poll(0.0)
    assert set(air.station.autopilots) <= {9} and air.link.peers(0.0) in ([], [HERE])


def test_nobody_who_reads_costs_no_memory(air):
    air.say(heartbeat())
    for _ in range(5000):
        air.say(text("again"))
    air.station.poll(0.0)
    assert len(air.station.fetch(1)) == 2000


def test_each_new_system_is_found_once_under_its_name_and_silence_is_told_of(air):
    found, said = [], []
    discovery = Discovery(air.station, Names("plane2", {7: "rover2"}), lambda name, system: found.append((name, system)), said.append)
    stepped(discovery, 5.5, links={})
    assert said == ["no autopilot heard for 5 s; listening on"]
    for t, system in enumerate((3, 7, 4, 3), 6):
        air.say(heartbeat(), system)
        stepped(discovery, float(t), links={})
    assert found == [("plane2", 3), ("rover2", 7)]
    stepped(discovery, 12.0, links={})
    assert found[2:] == [("plane2_4", 4)]


def test_a_vehicle_of_the_own_bus_is_left_alone_and_keeps_its_number_from_nobody(air):
    found = []
    discovery = Discovery(air.station, Names("plane2", {}), lambda *who: found.append(who), lambda line: None)
    for t in range(30):
        air.say(heartbeat())
        stepped(discovery, t * 0.1, links={"milvus": Link(port=HERE[1])} if t > 5 else {})
    assert found == [] and air.station.autopilots == {}
    for t in range(30, 50):
        air.say(heartbeat())
        air.say(heartbeat(), peer=THERE)
        stepped(discovery, t * 0.1, links={"milvus": Link(port=HERE[1])})
    assert found == [("plane2", 1)] and air.station.autopilots[1].peer == THERE


@pytest.mark.parametrize(
    ("texts", "why"),
    [
        (["plane 2"], "write NAME"),
        (["sys"], "write NAME"),
        (["a=0"], "1 to 254"),
        (["a=x"], "1 to 254"),
        (["a="], "1 to 254"),
        (["a=1", "b=1"], "system 1 is called a already"),
        (["a=1", "a=2"], "two vehicles of one name"),
        (["a", "b"], "write b=SYSTEM"),
    ],
)
def test_names_that_cannot_be_are_refused(texts, why):
    with pytest.raises(BadInput, match=why):
        names_from(texts)


def test_a_companion_computer_that_beats_first_is_no_vehicle_and_keeps_none_away(air):
    companion = heartbeat(mav.MAV_AUTOPILOT_GENERIC, mav.MAV_TYPE_ONBOARD_CONTROLLER)
    air.say(companion, component=191)
    air.say(heartbeat())
    air.say(companion, component=191)
    air.station.poll(0.0)
    assert air.station.autopilots[1].component == 1


def test_component_1_takes_the_place_of_another_and_anybody_that_of_one_who_is_silent(air):
    air.say(heartbeat(mav.MAV_AUTOPILOT_GENERIC), component=50)
    air.station.poll(0.0)
    air.say(heartbeat())
    air.say(heartbeat(), component=50)
    air.station.poll(0.1)
    assert air.station.autopilots[1].identity == (1, PX4, mav.MAV_TYPE_FIXED_WING)
    air.say(heartbeat(), component=50)
    air.station.poll(LOST_AFTER + 1.0)
    assert air.station.autopilots[1].component == 50


class Bridged:
    """A bridged vehicle on a station, step by step."""

    def __init__(self, air):
        self.air, self.t, self.events = air, 0.0, []
        air.say(heartbeat(base=129))
        air.station.poll(0.0)
        self.vehicle = BridgedVehicle("plane", 1, air.station, BridgeOrigin(ORIGIN), ExternalVehicle())

    def run(self, seconds, beat=None, peer=HERE, stop=NOBODY, **asked):
        nothing = dict.fromkeys(BridgedVehicle.requests, ())
        for n in range(round(seconds / DT)):
            self.t += DT
            if beat is not None and n % 50 == 0:
                self.air.say(beat, peer=peer)
            self.air.station.poll(self.t)
            told = stepped(self.vehicle, self.t, clock=None, stop=stop, **nothing | (asked if n == 0 else {}))
            self.events += [event.text for event in told.get("events", ())]
        return self

    def modes(self, peer=HERE):
        return [(m.param1, m.param2, m.param3) for m in self.air.sent(peer) if getattr(m, "command", 0) == mav.MAV_CMD_DO_SET_MODE]


def test_another_firmware_with_the_same_id_is_never_told_the_numbers_of_the_one_before(air):
    bridged = Bridged(air).run(2.0, heartbeat(base=129))
    bridged.run(0.1, heartbeat(base=129), set_mode=[ModeRequest(mode=Mode.MODE_MISSION)])
    ardu = heartbeat(ARDUPILOT, mav.MAV_TYPE_FIXED_WING, custom=10, base=129)
    bridged.run(LOST_AFTER + 1.0).run(2.0, ardu, THERE)
    assert "system 1 is another autopilot now: ARDUPILOTMEGA, FIXED_WING, component 1" in bridged.events
    bridged.run(0.5, ardu, THERE, set_mode=[ModeRequest(mode=Mode.MODE_HOLD)])
    assert bridged.modes(THERE)[0][:2] == (1.0, 12.0)  # LOITER of ArduPlane; PX4's 4 would be ACRO there


ENGAGED = StopStatus((StopEngagement(source="gcs", id=1),))


def test_stop_all_is_asked_for_again_until_it_holds(air):
    bridged = Bridged(air).run(1.0, heartbeat(base=129)).run(20.0, heartbeat(base=129), stop=ENGAGED)
    assert len(bridged.modes()) > 8
    assert len([text for text in bridged.events if text.startswith("STOP ALL: the autopilot does not hold: no answer")]) == 1


def test_who_arms_while_stop_all_is_engaged_is_made_to_hold(air):
    bridged = Bridged(air).run(1.0, heartbeat(base=1)).run(5.0, heartbeat(base=1), stop=ENGAGED)
    assert bridged.modes() == []
    bridged.run(1.5, heartbeat(base=129), stop=ENGAGED)
    assert bridged.modes()


def test_who_is_taken_out_of_hold_while_stop_all_is_engaged_is_let_and_it_is_told(air):
    hold, manual = heartbeat(base=129), heartbeat(base=129, custom=0x00010000)
    bridged = Bridged(air).run(1.0, manual).run(0.1, manual, stop=ENGAGED)
    air.say(ack(mav.MAV_CMD_DO_SET_MODE, mav.MAV_RESULT_ACCEPTED))
    bridged.run(2.0, hold, stop=ENGAGED)
    asked = len(bridged.modes())
    bridged.run(12.0, manual, stop=ENGAGED)
    assert len(bridged.modes()) == asked
    assert len([text for text in bridged.events if "taken the vehicle out of hold: mode Manual" in text]) == 1
