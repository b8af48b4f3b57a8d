"""QGroundControl's first seconds with a vehicle, with its time limits and its strictness: what would the user be told?

After ``Vehicle/InitialConnectStateMachine.cc``, ``FactSystem/ParameterManager.cc``, ``MissionManager/PlanManager.cc`` and the
setup checks of ``AutoPilotPlugins/PX4`` in QGroundControl's master of May 2026.
"""

import copy

from tests.services.autopilot.mavlink.qgc_parameters import ParameterManager
from tests.services.autopilot.mavlink.rig import GCS, long
from uvf.mavlink import dialect as mav

ACK_WAIT, MESSAGE_WAIT, PLAN_WAIT, ITEM_WAIT = 1.2, 1.0, 1.5, 0.25  # s
TRIES = 3
BUTTON_MODES = {50593792: "Hold", 67371008: "Mission", 84148224: "Return", 33816576: "Takeoff", 100925440: "Land"}
SETUP = "One or more vehicle components require setup prior to flight"
MISSING = "Parameters are missing from firmware"
PLANS = {0: "Mission transfer failed", 1: "GeoFence transfer failed", 2: "Rally Point transfer failed"}
NOT_ALL_ITEMS = "Vehicle did not request all items from ground station"
NO_FINAL_ACK = "Vehicle failed to send final ack"
CAPABILITY = {1: mav.MAV_PROTOCOL_CAPABILITY_MISSION_FENCE, 2: mav.MAV_PROTOCOL_CAPABILITY_MISSION_RALLY}
OLD_FIRMWARE = "supports PX4 Pro firmware Version 1.4.1 and above"
NOT_STABLE = "Vehicle is not running latest stable firmware"
NO_HOME = "Unable to change altitude, home position unknown"
READ_AT_A_CLICK = ("RTL_RETURN_ALT", "COM_FLTMODE1", "GF_ACTION", "BAT_LOW_THR", "NAV_RCL_ACT", "MAV_SYS_ID", "COM_RC_LOSS_T")


STANDARD_NAMES = {
    2024: {1: "Position", 2: "Orbit", 3: "Cruise", 4: "Altitude", 5: "Return", 6: "Safe Recovery", 7: "Mission", 8: "Land", 9: "Takeoff"},
    2026: {1: "Position", 2: "Orbit", 3: "Cruise", 4: "Altitude", 5: "Safe Recovery", 6: "Mission", 7: "Land", 8: "Takeoff"},
}
"""What a station calls a mode with a standard number, by the year of its list (``Vehicle/StandardModes.cc``)."""
_RC = [f"RC_MAP_{name}" for name in ("ROLL", "PITCH", "YAW", "THROTTLE", "FLAPS", "AUX1", "AUX2", "PARAM1", "PARAM2", "PARAM3")]
_SWITCHES = [f"RC_MAP_{name}_SW" for name in ("RETURN", "KILL", "OFFB", "MODE", "POSCTL", "LOITER", "ACRO", "ARM", "GEAR", "TRANS")]
_RATES = [f"FW_{axis}R_{part}" for axis in "RPY" for part in ("P", "I", "D", "FF")]
_BATTERY = ("SOURCE", "N_CELLS", "V_CHARGED", "V_EMPTY", "V_LOAD_DROP", "V_DIV", "A_PER_V")
PAGES = {
    "Summary": ["BAT1_SOURCE", "BAT1_N_CELLS", "BAT1_V_EMPTY", "BAT1_V_CHARGED", "COM_LOW_BAT_ACT", "NAV_RCL_ACT", "RTL_DESCEND_ALT"],
    "Safety": ["SDLOG_MODE", "COM_DISARM_LAND", "CP_DIST", "COM_OBS_AVOID", "GF_ACTION", "COM_LOW_BAT_ACT", "NAV_RCL_ACT", "NAV_DLL_ACT"],
    "Radio": _RC,
    "Flight Modes": ["RC_MAP_FLTMODE", *_SWITCHES, *(f"COM_FLTMODE{n}" for n in range(1, 7))],
    "Power": [f"{battery}_{name}" for battery in ("BAT", "BAT1") for name in _BATTERY],
    "PID Tuning": [*_RATES, "FW_RLL_TO_YAW_FF", "FW_R_TC", "FW_P_TC"],
}
"""Parameters that the pages of vehicle setup read without asking whether they exist (``AutoPilotPlugins/PX4/*.qml``, 2016 to 2026)."""
PLANE_PAGES = ("PID Tuning",)
LISTS = ("_SW", "RC_MAP_", "COM_FLTMODE", "_SOURCE", "_ACT", "GF_ACTION", "SDLOG_MODE", "COM_OBS_AVOID")
"""Of parameters that are shown as one of a list."""


class QGroundControl(ParameterManager):
    """Connects to one vehicle of a rig; ``spoil`` may change or swallow what the vehicle says."""

    def __init__(self, rig, system, spoil=lambda message: message):
        super().__init__()
        self.rig = rig
        self.system = system
        self.complaints = []
        self.modes, self.standards = {}, {}
        self.plans = {}
        self.texts = []
        """Of the vehicle, once its heartbeat has been heard: those before are dropped."""
        self._knows_vehicle = False
        self.capabilities = CAPABILITY[1] | CAPABILITY[2]  # assumed of a PX4 that does not say
        self._spoil = spoil
        self._heard = []
        self._beat_at = -1.0

    def connect(self):
        """The whole sequence; returns the seconds it took."""
        start = self.rig.t
        beat = self._await("HEARTBEAT", 2.0)
        if beat is None:
            self.complaints.append("no vehicle")
            return self.rig.t - start
        self._version()
        self._modes()
        self._download_metadata()
        self._download_parameters()
        self._setup_check(beat)
        self._download_plans()
        self._await("HOME_POSITION", 2.1) or self.complaints.append(NO_HOME)
        return self.rig.t - start

    def _listen(self, seconds):
        """Time passes; QGroundControl's own heartbeat goes out each second."""
        if self.rig.t - self._beat_at >= 1.0:
            self._beat_at = self.rig.t
            self.rig.say(mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3))
        heard = [self._spoil(m) for m in self.rig.run(seconds) if m.get_srcSystem() == self.system]
        self._heard += [m for m in heard if m is not None]
        for m in heard:
            self._knows_vehicle |= m is not None and m.get_type() == "HEARTBEAT"
            if m is not None and m.get_type() == "STATUSTEXT" and self._knows_vehicle:
                self._put_together(m)

    def _put_together(self, m):
        if m.id and m.chunk_seq and self.texts:
            self.texts[-1] += m.text
        else:
            self.texts.append(m.text)

    def shown_modes(self, year):
        """Name on the button -> the mode it sets, for a station with the numbers of a year."""
        names = STANDARD_NAMES[year]
        return {names.get(self.standards[word], name): word for word, name in self.modes.items()}

    def clear(self):
        """Its button Clear: all three plans within a millisecond, and no second try."""
        for kind in PLANS:
            self.rig.say(mav.MAVLink_mission_clear_all_message(self.system, 1, kind))
        for kind, complaint in PLANS.items():
            ack = self._await("MISSION_ACK", PLAN_WAIT, lambda m, kind=kind: m.mission_type == kind)
            if ack is None or ack.type != mav.MAV_MISSION_ACCEPTED:
                self.complaints.append(complaint)

    def open(self, page):
        """A page of vehicle setup: what is missing pops up, and a number without a name is shown as unknown."""
        names = [] if page in PLANE_PAGES and "FW_AIRSPD_TRIM" not in self.parameters else PAGES[page]
        if missing := [name for name in names if name not in self.parameters]:
            self.complaints.append(f"{MISSING}: {missing}")
        for name in names:
            known = [choice["value"] for choice in self.metadata.get(name, {}).get("values", ())]
            if name in self.parameters and any(part in name for part in LISTS) and self.parameters[name] not in known:
                self.complaints.append(f"Unknown: {self.parameters[name]} ({name})")

    def _await(self, kind, seconds, fits=lambda m: True):
        return self._await_any((kind,), seconds, fits)

    def _request(self, number, kind, p2=0.0):
        """REQUEST_MESSAGE: three tries for the acknowledgement, then a second for the message. None = refused or silent."""
        for _ in range(TRIES):
            self.rig.say(long(512, float(number), p2, 0.0, 0.0, 0.0, 0.0, 0.0, system=self.system), peer=GCS)
            ack = self._await("COMMAND_ACK", ACK_WAIT, lambda m: m.command == 512)
            if ack is not None:
                return self._await(kind, MESSAGE_WAIT) if ack.result == 0 and kind else None
        return None

    def _version(self):
        version = self._request(148, "AUTOPILOT_VERSION")
        if version is None:
            return
        major, minor, patch, kind = version.flight_sw_version.to_bytes(4, "big")
        self.capabilities = version.capabilities
        if (major, minor, patch) < (1, 4, 1):
            self.complaints.append(OLD_FIRMWARE)
        if kind == 255:
            self.complaints.append(NOT_STABLE)

    def _modes(self):
        """One at a time, the next only after the one before."""
        index, total = 1, 1
        while index <= total:
            mode = self._request(435, "AVAILABLE_MODES", float(index))
            if mode is None:
                self.modes = dict(BUTTON_MODES)  # its own list of PX4 modes
                return
            self.modes[mode.custom_mode], self.standards[mode.custom_mode] = mode.mode_name, mode.standard_mode
            total, index = mode.number_modes, mode.mode_index + 1
        self.complaints += [f"button {name} sets an empty mode" for word, name in BUTTON_MODES.items() if word not in self.modes]

    def _setup_check(self, beat):
        p = self.parameters
        if not p:
            return
        incomplete = p.get("SYS_AUTOSTART", 0) == 0
        incomplete |= p.get("COM_RC_IN_MODE") != 1 and not all(p.get(f"RC_MAP_{axis}") for axis in ("ROLL", "PITCH", "YAW", "THROTTLE"))
        if not beat.base_mode & mav.MAV_MODE_FLAG_HIL_ENABLED:
            incomplete |= not all(p.get(f"CAL_{sensor}0_ID") for sensor in ("GYRO", "ACC", "MAG"))
        if incomplete:
            self.complaints.append(SETUP)
        if p.get("SYS_HITL"):
            self.complaints.append("Warning: Hardware In The Loop (HITL) simulation is enabled")
        if missing := [name for name in READ_AT_A_CLICK if name not in p]:
            self.complaints.append(f"{MISSING}: {missing}")

    def _download_plans(self):
        """Fence and rally points only of a vehicle that says it has them."""
        for kind, complaint in PLANS.items():
            if kind == 0 or self.capabilities & CAPABILITY[kind]:
                self._download(kind, complaint)

    def _download(self, kind, complaint):
        items = self.plans[kind] = []
        asked = mav.MAVLink_mission_request_list_message(self.system, 1, kind)
        count = self._ask(asked, "MISSION_COUNT", PLAN_WAIT, lambda m: m.mission_type == kind)
        for seq in range(count.count if count is not None else 0):
            request = mav.MAVLink_mission_request_int_message(self.system, 1, seq, kind)
            item = self._ask(request, "MISSION_ITEM_INT", ITEM_WAIT, lambda m, seq=seq: (m.seq, m.mission_type) == (seq, kind))
            if item is None:
                break
            items.append(item)
        if count is None or len(items) < count.count:
            self.complaints.append(complaint)

    def upload(self, items, kind=0):
        """Says each item only when it is asked for, never again on its own; the seconds it took, or None with a complaint."""
        start, sent = self.rig.t, -1
        self.rig.say(mav.MAVLink_mission_count_message(self.system, 1, len(items), kind))
        while True:
            answer = self._await_any(("MISSION_REQUEST_INT", "MISSION_ACK"), PLAN_WAIT, lambda m: m.mission_type == kind)
            if answer is None:
                self.complaints.append(NO_FINAL_ACK if sent == len(items) - 1 else NOT_ALL_ITEMS)
                return None
            if answer.get_type() == "MISSION_ACK":
                if answer.type != mav.MAV_MISSION_ACCEPTED:
                    self.complaints.append(PLANS[kind])
                elif sent < len(items) - 1:
                    self.complaints.append(NOT_ALL_ITEMS)
                return self.rig.t - start
            sent = max(sent, answer.seq)
            item = copy.copy(items[answer.seq])
            item.target_system = self.system
            self.rig.say(item)

    def _await_any(self, kinds, seconds, fits):
        end = self.rig.t + seconds
        while True:
            found = next((m for m in self._heard if m.get_type() in kinds and fits(m)), None)
            if found is not None:
                self._heard.remove(found)
                return found
            if self.rig.t >= end:
                return None
            self._listen(0.02)

    def _ask(self, request, kind, seconds, fits=lambda m: True):
        """With five repetitions, as the plan's managers do."""
        for _ in range(6):
            self.rig.say(request)
            if (answer := self._await(kind, seconds, fits)) is not None:
                return answer
        return None
