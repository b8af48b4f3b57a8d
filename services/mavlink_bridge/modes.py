"""What an autopilot's ``custom_mode`` means: by its own list where it has one (AVAILABLE_MODES), else by PX4's or ArduPilot's numbers."""

from schemas.messages import Mode
from uvf.mavlink import dialect as mav
from uvf.runtime.mavlink.modes import TABLE
from uvf.runtime.messages.validation import legible

PLANE: dict[int, tuple[str, Mode]] = {
    0: ("MANUAL", Mode.MODE_MANUAL),
    1: ("CIRCLE", Mode.MODE_ORBIT),
    2: ("STABILIZE", Mode.MODE_STABILIZED),
    3: ("TRAINING", Mode.MODE_UNSPECIFIED),
    4: ("ACRO", Mode.MODE_UNSPECIFIED),
    5: ("FBWA", Mode.MODE_STABILIZED),
    6: ("FBWB", Mode.MODE_ALTITUDE),
    7: ("CRUISE", Mode.MODE_POSITION),
    8: ("AUTOTUNE", Mode.MODE_UNSPECIFIED),
    10: ("AUTO", Mode.MODE_MISSION),
    11: ("RTL", Mode.MODE_RETURN),
    12: ("LOITER", Mode.MODE_HOLD),
    13: ("TAKEOFF", Mode.MODE_TAKEOFF),
    14: ("AVOID_ADSB", Mode.MODE_UNSPECIFIED),
    15: ("GUIDED", Mode.MODE_HOLD),
    16: ("INITIALISING", Mode.MODE_UNSPECIFIED),
    17: ("QSTABILIZE", Mode.MODE_STABILIZED),
    18: ("QHOVER", Mode.MODE_ALTITUDE),
    19: ("QLOITER", Mode.MODE_POSITION),
    20: ("QLAND", Mode.MODE_LAND),
    21: ("QRTL", Mode.MODE_RETURN),
    22: ("QAUTOTUNE", Mode.MODE_UNSPECIFIED),
    23: ("QACRO", Mode.MODE_UNSPECIFIED),
    24: ("THERMAL", Mode.MODE_UNSPECIFIED),
    25: ("LOITER_ALT_QLAND", Mode.MODE_LAND),
    26: ("AUTOLAND", Mode.MODE_LAND),
}
"""ArduPlane/mode.h. GUIDED circles over where it was sent: that is what Hold does after a goal."""
ROVER: dict[int, tuple[str, Mode]] = {
    0: ("MANUAL", Mode.MODE_MANUAL),
    1: ("ACRO", Mode.MODE_UNSPECIFIED),
    3: ("STEERING", Mode.MODE_STABILIZED),
    4: ("HOLD", Mode.MODE_HOLD),
    5: ("LOITER", Mode.MODE_POSITION),
    6: ("FOLLOW", Mode.MODE_FOLLOW),
    7: ("SIMPLE", Mode.MODE_UNSPECIFIED),
    8: ("DOCK", Mode.MODE_UNSPECIFIED),
    9: ("CIRCLE", Mode.MODE_ORBIT),
    10: ("AUTO", Mode.MODE_MISSION),
    11: ("RTL", Mode.MODE_RETURN),
    12: ("SMART_RTL", Mode.MODE_RETURN),
    15: ("GUIDED", Mode.MODE_HOLD),
    16: ("INITIALISING", Mode.MODE_UNSPECIFIED),
}
"""Rover/mode.h."""
ASKED_FOR: dict[int, dict[Mode, int]] = {
    mav.MAV_TYPE_FIXED_WING: {Mode.MODE_HOLD: 12, Mode.MODE_STABILIZED: 2, Mode.MODE_LAND: 26, Mode.MODE_POSITION: 7, Mode.MODE_RETURN: 11},
    mav.MAV_TYPE_GROUND_ROVER: {Mode.MODE_HOLD: 4, Mode.MODE_RETURN: 11},
}
"""Which of several modes is meant, where more than one reads as the same."""
ARDUPILOT = {mav.MAV_TYPE_FIXED_WING: PLANE, mav.MAV_TYPE_GROUND_ROVER: ROVER}
STANDARD = {
    mav.MAV_STANDARD_MODE_POSITION_HOLD: Mode.MODE_POSITION,
    mav.MAV_STANDARD_MODE_ORBIT: Mode.MODE_ORBIT,
    mav.MAV_STANDARD_MODE_CRUISE: Mode.MODE_POSITION,
    mav.MAV_STANDARD_MODE_ALTITUDE_HOLD: Mode.MODE_ALTITUDE,
    mav.MAV_STANDARD_MODE_SAFE_RECOVERY: Mode.MODE_RETURN,
    mav.MAV_STANDARD_MODE_MISSION: Mode.MODE_MISSION,
    mav.MAV_STANDARD_MODE_LAND: Mode.MODE_LAND,
    mav.MAV_STANDARD_MODE_TAKEOFF: Mode.MODE_TAKEOFF,
}
NAMES = {
    **{row.name.lower(): row.mode for row in TABLE},
    "auto": Mode.MODE_MISSION,
    "rtl": Mode.MODE_RETURN,
    "loiter": Mode.MODE_HOLD,
    "stabilize": Mode.MODE_STABILIZED,
    "position control": Mode.MODE_POSITION,
    "altitude control": Mode.MODE_ALTITUDE,
}
"""As autopilots call their modes, where no standard mode is told."""
LARGEST_LIST = 255
MODES_MOST = 2 * LARGEST_LIST
"""That are remembered: those of the tables, and those that an autopilot tells."""
NAME_LETTERS = 35


class Modes:
    """The modes of one autopilot, by the known tables and its own list."""

    def __init__(self, autopilot: int, type_: int) -> None:
        is_ardupilot = autopilot == mav.MAV_AUTOPILOT_ARDUPILOTMEGA
        known = ARDUPILOT.get(type_, {}) if is_ardupilot else {row.custom: (row.name, row.mode) for row in TABLE}
        self._by_custom: dict[int, tuple[str, Mode]] = dict(known)
        self._asked_for = dict(ASKED_FOR.get(type_, {})) if is_ardupilot else {}
        self._splits = not is_ardupilot

    def hear(self, message: mav.MAVLink_available_modes_message) -> None:
        """Takes a line of the autopilot's own list: its name, and its meaning where it can be told."""
        raw = message.mode_name
        text = (raw if isinstance(raw, str) else bytes(raw).decode("utf-8", "replace")).rstrip("\0")
        name = legible(text, NAME_LETTERS)
        if message.custom_mode not in self._by_custom and len(self._by_custom) >= MODES_MOST:
            return
        known = self._by_custom.get(message.custom_mode, ("", Mode.MODE_UNSPECIFIED))[1]
        mode = STANDARD.get(message.standard_mode) or NAMES.get(name.lower()) or known
        self._by_custom[message.custom_mode] = (name, mode)
        if mode != Mode.MODE_UNSPECIFIED and not message.properties & mav.MAV_MODE_PROPERTY_NOT_USER_SELECTABLE:
            self._asked_for.setdefault(mode, message.custom_mode)

    def mode_of(self, custom: int) -> Mode:
        """The mode that a ``custom_mode`` means; MODE_UNSPECIFIED for an unknown one."""
        return self._by_custom.get(custom, ("", Mode.MODE_UNSPECIFIED))[1]

    def name_of(self, custom: int) -> str:
        """The autopilot's own name of a ``custom_mode``."""
        return self._by_custom.get(custom, ("", Mode.MODE_UNSPECIFIED))[0] or f"{custom:#x}"

    def custom_of(self, mode: Mode) -> int | None:
        """The ``custom_mode`` to request for a mode; None where the autopilot has none like it."""
        if mode == Mode.MODE_UNSPECIFIED:
            return None
        if mode in self._asked_for:
            return self._asked_for[mode]
        return next((custom for custom, (_, meant) in self._by_custom.items() if meant == mode), None)

    def command_parameters(self, custom: int) -> tuple[float, float, float]:
        """Parameters 1 to 3 [-] of DO_SET_MODE: PX4 takes main and sub mode apart, ArduPilot the number whole."""
        if self._splits:
            return float(mav.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED), float(custom >> 16 & 0xFF), float(custom >> 24 & 0xFF)
        return float(mav.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED), float(custom), 0.0
