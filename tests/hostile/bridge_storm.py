"""What a hostile bus may ask of the bridge and a hostile autopilot may tell it, as strategies; and a bridge to put between them."""

import re
from struct import pack

from hypothesis import strategies as st

from schemas import topics
from schemas.messages import ExternalVehicle
from services.mavlink_bridge.discovery import Discovery, Names
from services.mavlink_bridge.frame import BridgeOrigin
from services.mavlink_bridge.service import BridgedVehicle
from services.mavlink_bridge.station import COMPONENT, SYSTEM, Station
from tests.services.autopilot.mavlink.rig import MemoryLink
from uvf.mavlink import dialect as mav
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.bus.wire import decode_sample
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.mavlink.mission_items import ORIGIN

HERE, THERE = ("127.0.0.1", 5001), ("127.0.0.1", 5002)
STEP = 0.1  # s
NS = 1_000_000_000
SCRIPT = "<script>alert(1)</script>\x1b[2J"

NUMBERS = st.sampled_from((0.0, 1.0, -1.0, 0.5, 300.0, 1e6, -1e9, 3e9, 9e11, 1e300, float("nan"), float("inf"), float("-inf")))
NAMES = st.sampled_from(("RTL_ALT", "NAV_DLL_ACT", "", "A" * 16, "A" * 17, "A\0B", "\u202eALT", SCRIPT))
VALUES = ("", "3", "300", "-129", "1.5", "9" * 400, "9" * 5000, "NaN", "Infinity", "1e300", "true", '"high"', "[" * 20_000, "{}", "1e39")
TEXTS = NAMES | st.sampled_from(VALUES) | st.text(max_size=8)
WIRE_ITEMS = st.builds(
    lambda frame, command, p, x, y, z: ORIGIN.pack(frame, command, 1, *p, x, y, z),
    st.sampled_from((0, 2, 3, 6, 10, 255)),
    st.sampled_from((16, 17, 20, 93, 177, 178, 179, 5000, 5001, 5003, 5100, 65535)),
    st.tuples(*[st.sampled_from((0.0, 3.0, 1e6, 3e38, float("nan"), float("inf")))] * 4),
    st.sampled_from((0, 407700000, 2**31 - 1, -(2**31))),
    st.sampled_from((0, 147900000, 2**31 - 1, -(2**31))),
    st.sampled_from((0.0, 50.0, 3e38, float("nan"), float("-inf"))),
)
BLOBS = WIRE_ITEMS | st.binary(max_size=40)


def whole(low, high):
    return st.sampled_from([n for n in (0, 1, 2, 5, 99, 255, 300, 65535, 65536, -1, low, high) if low <= n <= high])


SIZES = {"int32": (-(2**31), 2**31 - 1), "uint32": (0, 2**32 - 1), "int64": (-(2**63), 2**63 - 1), "uint64": (0, 2**64 - 1)}
KINDS = {1: NUMBERS, 2: NUMBERS, 3: whole(*SIZES["int64"]), 4: whole(*SIZES["uint64"]), 5: whole(*SIZES["int32"]), 8: st.booleans()}
KINDS |= {9: TEXTS, 12: BLOBS, 13: whole(*SIZES["uint32"]), 14: whole(*SIZES["int32"])}
"""By the type of a protobuf field."""


def protobuf(type_):
    """Any message of a type: any of its fields, each with anything that fits into it."""
    optional = {}
    for field in type_.DESCRIPTOR.fields:
        one = protobuf(field.message_type._concrete_class) if field.message_type else KINDS[field.type]
        optional[field.name] = st.lists(one, max_size=4) if field.label == field.LABEL_REPEATED else one
    if len(optional) <= 4:
        return st.builds(lambda fields: type_(**fields), st.fixed_dictionaries(optional))
    return st.builds(lambda fields: type_(**fields), st.fixed_dictionaries({}, optional=optional))


REQUESTS = tuple(BridgedVehicle.requests.values())
ASKED = st.sampled_from(REQUESTS).flatmap(lambda request: st.tuples(st.just(request), protobuf(request.message)))

INTEGERS = {"b": (-128, 127), "B": (0, 255), "h": (-(2**15), 2**15 - 1), "H": (0, 2**16 - 1), "i": SIZES["int32"], "I": SIZES["uint32"]}
INTEGERS |= {"q": SIZES["int64"], "Q": SIZES["uint64"]}
LIKELY = (0, 1, 2, 3, 12, SYSTEM, COMPONENT, 300, 5000, 65535, 407700000, 147900000)
FLOATS = st.sampled_from((0.0, 1.0, -0.5, 60.0, 1e6, 3e38, -3e38, float("nan"), float("inf"), float("-inf")))
WORDS = st.sampled_from((b"", b"RTL_ALT", b"NAV_DLL_ACT", SCRIPT.encode(), "\u202eevil\u2066".encode(), b"\xff\xfe\x80", b"x" * 50))
HEARD = [
    *(0, 1, 22, 24, 30, 31, 33, 42, 44, 46, 47, 51, 40, 62, 73, 74, 77, 147, 148, 162, 230, 231, 242, 245, 253, 345, 360, 435),
]
"""Numbers of the messages that the bridge listens to."""


def field_bytes(count, code):
    if code == "s":
        return st.builds(lambda words: words[:count].ljust(count, b"\0"), WORDS | st.binary(max_size=count))
    if code in "fd":
        one = st.builds(lambda v: pack(f"<{code}", v), FLOATS)
    else:
        low, high = INTEGERS[code]
        one = st.builds(lambda v: pack(f"<{code}", v), st.sampled_from([n for n in (*LIKELY, low, high) if low <= n <= high]))
    return st.lists(one, min_size=count, max_size=count).map(b"".join)


def payload(kind):
    tokens = re.findall(r"(\d*)([a-zA-Z])", kind.unpacker.format)
    return st.tuples(*(field_bytes(int(count or 1), code) for count, code in tokens)).map(b"".join)


def framed(number, data, system=1, component=1):
    """A sound MAVLink 2 packet."""
    head = bytes((0xFD, len(data), 0, 0, 0, system, component)) + number.to_bytes(3, "little")
    crc = mav.x25crc(head[1:] + data + bytes((mav.mavlink_map[number].crc_extra,))).crc
    return head + data + crc.to_bytes(2, "little")


ANY_NUMBER = st.sampled_from(HEARD) | st.sampled_from(HEARD) | st.sampled_from(sorted(mav.mavlink_map))
SYSTEMS = st.sampled_from((1, 1, 1, 1, 2, 0, 254, 255)) | st.integers(0, 255)
PEERS = st.sampled_from((HERE, HERE, HERE, THERE)) | st.builds(lambda port: ("127.0.0.1", port), st.integers(1024, 65535))
PACKETS = ANY_NUMBER.flatmap(
    lambda number: st.builds(lambda data, system: framed(number, data, system), payload(mav.mavlink_map[number]), SYSTEMS)
)
TOLD = st.tuples(PACKETS | st.binary(max_size=60), PEERS)
ANSWERS = st.integers(0, 2**32 - 1)
"""The seed of what the autopilot answers while it is at it."""
BEAT = mav.MAVLink_heartbeat_message(1, 12, 129, 50593792, 4, 3)
NAN = float("nan")


class Liar:
    """An autopilot's answers to what it is asked: by the protocols, and with numbers that make no sense."""

    NUMBERS = (0.0, 1.0, 60.0, 1e6, 3e38, NAN, float("inf"))
    PLACES = (0, 407700000, 147900000, 2**31 - 1, -(2**31))

    def __init__(self, rng):
        self._rng = rng

    def __call__(self, message):
        pick, kind, us = self._rng.choice, message.get_type(), (SYSTEM, COMPONENT)
        if kind.startswith("PARAM_"):
            type_, index = pick((0, 1, 2, 3, 4, 5, 6, 9, 9, 10, 200)), pick((0, 65535))
            return [mav.MAVLink_param_value_message(message.param_id.encode(), pick(self.NUMBERS), type_, 65535, index)]
        if kind.startswith("COMMAND_"):
            result, system = pick((0, 0, 1, 2, 3, 5, 5, 9, 200)), pick((0, SYSTEM, 7))
            return [mav.MAVLink_command_ack_message(message.command, result, target_system=system)]
        if kind == "MISSION_REQUEST_LIST":
            count, opaque = pick((0, 1, 3, 12, 5000, 65535)), pick((0, 9))
            return [mav.MAVLink_mission_count_message(*us, count, message.mission_type, opaque)]
        if kind == "MISSION_REQUEST_INT":
            return [self._item(message.seq, message.mission_type)]
        if kind in ("MISSION_COUNT", "MISSION_ITEM_INT"):
            asks = mav.MAVLink_mission_request_int_message(*us, pick((0, 1, 2, 65535)), message.mission_type)
            ends = mav.MAVLink_mission_ack_message(*us, pick((0, 0, 3, 200)), message.mission_type)
            return [asks, ends][: pick((0, 1, 1, 2))]
        return []

    def _item(self, seq, kind):
        pick = self._rng.choice
        numbers = [pick(self.NUMBERS) for _ in range(4)]
        head = (SYSTEM, COMPONENT, seq, pick((0, 2, 3, 6, 10, 255)), pick((16, 17, 20, 93, 177, 178, 179, 5000, 5001, 5003, 5100, 9)), 0, 1)
        return mav.MAVLink_mission_item_int_message(*head, *numbers, pick(self.PLACES), pick(self.PLACES), pick(self.NUMBERS), kind)


class Besieged:
    """A bridge with one autopilot that is sound, at HERE, on a bus on which everything that it publishes is read."""

    def __init__(self, is_ardupilot=False):
        self.link, self.bus, self.t = MemoryLink(), LocalBus(), 0.0
        self.link.listening = []
        self.station, self.origin = Station(self.link), BridgeOrigin()
        self.said, self.replies, self.asked = [], [], 0
        self.heard, self.vehicles = {}, []
        self.beat = mav.MAVLink_heartbeat_message(1, 3, 129, 10, 4, 3) if is_ardupilot else BEAT
        for topic in BridgedVehicle.outputs.values():
            self.bus.subscribe(topic.at("*"), topic.qos, lambda sample, topic=topic: self._read(topic, sample))
        discovery = Discovery(self.station, Names("mav", {}), self._found, self.said.append)
        self.shells = [ServiceRunner(ServiceInstance(Discovery, lambda: discovery), self.bus, self.said.append)]
        self.run(3.0)

    def _read(self, topic, sample):
        """As any reader does; raises Malformed."""
        self.heard[sample.key] = (self.t, decode_sample(sample, topic.message))

    def _found(self, name, system):
        def make():
            self.vehicles.append(BridgedVehicle(name, system, self.station, self.origin, ExternalVehicle(model="x")))
            return self.vehicles[-1]

        self.shells.append(ServiceRunner(ServiceInstance(BridgedVehicle, make, name), self.bus, self.said.append))

    def run(self, seconds, liar=None):
        """liar: answers for the autopilot, which otherwise says nothing but how it is."""
        for _ in range(round(seconds / STEP)):
            self.t = round(self.t + STEP, 6)
            self._speak()
            sent, self.link.outgoing = self.link.outgoing, []
            if liar is not None:
                self._lie(liar, sent)
            for shell in list(self.shells):
                shell.skip_to(round(self.t * NS))
                shell.advance()

    def _speak(self):
        sender, ms = mav.MAVLink(None, 1, 1), round(self.t * 1000) + 1
        home = (407700000, 147900000, 320000)
        for message in (
            self.beat,
            mav.MAVLink_home_position_message(*home, 0, 0, 0, (NAN,) * 4, NAN, NAN, NAN),
            mav.MAVLink_global_position_int_message(ms, home[0], home[1], 400000, 80000, 300, 400, -100, 9000),
            mav.MAVLink_attitude_quaternion_message(ms, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        ):
            self.link.incoming.append((message.pack(sender), HERE))

    def _lie(self, liar, sent):
        sender = mav.MAVLink(None, 1, 1)
        for message in (m for packet, _ in sent for m in mav.MAVLink(None).parse_buffer(packet) or ()):
            self.link.incoming += [(answer.pack(sender), HERE) for answer in liar(message)]

    def say(self, packet, peer):
        self.link.incoming.append((packet, peer))

    def ask(self, request, message):
        self.asked += 1
        self.bus.call(request.at("mav"), message.SerializeToString(), 0, lambda reply, why, at: self.replies.append((request, reply, why)))

    def newest(self, topic):
        """(when [s], what) of the sound vehicle."""
        return self.heard[topics.PREFIX + "/" + topic.key.replace("<owner>", "mav")]
