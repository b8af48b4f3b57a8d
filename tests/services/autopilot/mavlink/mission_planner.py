"""Mission Planner's packets in the order and the repetitions in which it sends them (``ExtLibs/ArduPilot/Mavlink/MAVLinkInterface.cs``,
``MAVFtp.cs``, ``GCSViews/FlightData.cs`` of a2fcd74), and how long it waits for each answer.
"""

import struct

from services.autopilot.mavlink.telemetry.data_streams import GROUPS
from tests.services.autopilot.mavlink.file_reader import HEAD
from tests.services.autopilot.mavlink.rig import PLANE, of
from uvf.mavlink import dialect as mav

OPEN, NAK, NOT_FOUND = 4, 129, 10
PACKED = b"@PARAM/param.pck?withdefaults=1"
COMMAND_WAIT, PARAMETER_WAIT, GUIDED_WAIT = 2.0, 0.7, 2.0  # s
TRIES = 3


class MissionPlanner:
    """Flies one vehicle of a rig."""

    def __init__(self, rig, system=PLANE):
        self.rig, self.system = rig, system
        self.heard = []

    def connect(self, rate=4):
        """Heartbeat, streams (each asked for twice), parameters packed in a file, or else as a list; their values."""
        self.rig.say(mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3))
        for group in GROUPS:
            for _ in range(2):
                self.rig.say(mav.MAVLink_request_data_stream_message(self.system, 1, group, rate, 1))
        if self.packed_parameters() == (NAK, NOT_FOUND):
            self.rig.say(mav.MAVLink_param_request_list_message(self.system, 1))
        values = self._listen("PARAM_VALUE", 3.0)
        return {m.param_id: m.param_value for m in values}

    def packed_parameters(self):
        """(opcode, error) of the answer, which must come at once: MAVFtp asks again and again before it goes on."""
        head = HEAD.pack(0, 0, OPEN, len(PACKED), 0, 0, 0, 0)
        self.rig.say(mav.MAVLink_file_transfer_protocol_message(0, self.system, 1, (head + PACKED).ljust(251, b"\0")))
        (answer,) = self._listen("FILE_TRANSFER_PROTOCOL", 0.2)
        payload = bytes(answer.payload)
        return payload[3], payload[HEAD.size]

    def set_mode(self, custom):
        """SET_MODE twice, then DO_SET_MODE with the whole word; the results of the command, the modes in heartbeats meanwhile."""
        base = mav.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
        for _ in range(2):
            self.rig.say(mav.MAVLink_set_mode_message(self.system, base, custom))
        command = (mav.MAV_CMD_DO_SET_MODE, 0, float(base), float(custom), 0.0, 0.0, 0.0, 0.0, 0.0)
        self.rig.say(mav.MAVLink_command_long_message(self.system, 1, *command))
        acks = self._listen("COMMAND_ACK", 0.5)
        return [m.result for m in acks], [m.custom_mode for m in of(self.heard, "HEARTBEAT", self.system)]

    def guided_item(self, latitude, longitude, above_home, whole=True):
        """ "Fly to here" as an item that belongs to no mission (current = 2); the results of its acknowledgements."""
        place = (latitude * 1e7, longitude * 1e7) if whole else (latitude, longitude)
        kind = mav.MAVLink_mission_item_int_message if whole else mav.MAVLink_mission_item_message
        x, y = map(round, place) if whole else place
        head = (self.system, 1, 0, mav.MAV_FRAME_GLOBAL_RELATIVE_ALT, mav.MAV_CMD_NAV_WAYPOINT, 2, 1)
        self.rig.say(kind(*head, 0, 0, 0, 0, x, y, above_home))
        return [m.type for m in self._listen("MISSION_ACK", 0.5)]

    def fly_to_here(self, latitude, longitude, above_home):
        """The same as a target: nothing answers but the vehicle, by going there."""
        only_place = 0b0000_1111_1111_1000
        frame = mav.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT
        place = (round(latitude * 1e7), round(longitude * 1e7), above_home)
        self.rig.say(mav.MAVLink_set_position_target_global_int_message(0, self.system, 1, frame, only_place, *place, *(0.0,) * 8))
        self._listen("COMMAND_ACK", 1.5)

    def set_parameter(self, name, value):
        """What it does with WP_RADIUS and LOITER_RAD after each upload: (PARAM_ERROR codes, values that came)."""
        self.rig.say(mav.MAVLink_param_set_message(self.system, 1, name.encode(), value, mav.MAV_PARAM_TYPE_REAL32))
        values = self._listen("PARAM_VALUE", PARAMETER_WAIT)
        return [m.error for m in of(self.heard, "PARAM_ERROR", self.system)], [m.param_value for m in values]

    def _listen(self, kind, seconds):
        self.heard = self.rig.run(seconds)
        return of(self.heard, kind, self.system)


def integer(value):
    """The whole number in a value that came bytewise."""
    return struct.unpack("<i", struct.pack("<f", value))[0]
