"""Modes of the vehicles as PX4 ``custom_mode`` words: main mode << 16 | sub mode << 24 (px4_custom_mode.h)."""

import math
from dataclasses import dataclass

from schemas.messages import Mode
from uvf.mavlink import dialect as mav

_MANUAL = mav.MAV_MODE_FLAG_MANUAL_INPUT_ENABLED
_STABLE = mav.MAV_MODE_FLAG_STABILIZE_ENABLED
_AUTO = mav.MAV_MODE_FLAG_AUTO_ENABLED | mav.MAV_MODE_FLAG_GUIDED_ENABLED | _STABLE


@dataclass(frozen=True)
class ModeRow:
    """One mode on the wire; ``standard`` only where every ground station's name for that number is ours.

    The numbers from 5 on were moved in 2024: 6, 7, 8 are Mission, Land, Takeoff now, and were Safe Recovery, Mission, Land. A station
    of before would show our Land as "Mission".
    """

    mode: Mode
    name: str
    main: int
    sub: int
    flags: int
    standard: int = mav.MAV_STANDARD_MODE_NON_STANDARD
    properties: int = 0
    on_ground: bool = False
    """Rovers have it, too."""

    @property
    def custom(self) -> int:
        """The ``custom_mode`` word of the mode."""
        return self.main << 16 | self.sub << 24


TABLE = (
    ModeRow(Mode.MODE_MANUAL, "Manual", 1, 0, _MANUAL, on_ground=True),
    ModeRow(Mode.MODE_STABILIZED, "Stabilized", 7, 0, _MANUAL | _STABLE),
    ModeRow(Mode.MODE_ALTITUDE, "Altitude", 2, 0, _MANUAL | _STABLE, mav.MAV_STANDARD_MODE_ALTITUDE_HOLD),
    ModeRow(Mode.MODE_POSITION, "Position", 3, 0, _MANUAL | _STABLE),
    ModeRow(Mode.MODE_TAKEOFF, "Takeoff", 4, 2, _AUTO),
    ModeRow(Mode.MODE_HOLD, "Hold", 4, 3, _AUTO, on_ground=True),
    ModeRow(Mode.MODE_MISSION, "Mission", 4, 4, _AUTO, on_ground=True),
    ModeRow(Mode.MODE_RETURN, "Return", 4, 5, _AUTO, on_ground=True),
    ModeRow(Mode.MODE_LAND, "Land", 4, 6, _AUTO),
    ModeRow(Mode.MODE_ORBIT, "Orbit", 3, 1, _AUTO, properties=mav.MAV_MODE_PROPERTY_NOT_USER_SELECTABLE),
    ModeRow(Mode.MODE_FOLLOW, "Follow", 4, 8, _AUTO),
    ModeRow(Mode.MODE_OFFBOARD, "Offboard", 6, 0, _AUTO, properties=mav.MAV_MODE_PROPERTY_ADVANCED, on_ground=True),
)
"""The same for aircraft and rovers: QGroundControl keeps one list for all PX4-like vehicles. Each refuses what it cannot do."""

_BY_MODE = {row.mode: row for row in TABLE}
_BY_CUSTOM = {row.custom: row for row in TABLE}
_BY_STANDARD = {row.standard: row for row in TABLE if row.standard != mav.MAV_STANDARD_MODE_NON_STANDARD} | {
    mav.MAV_STANDARD_MODE_ORBIT: _BY_MODE[Mode.MODE_ORBIT],
    mav.MAV_STANDARD_MODE_CRUISE: _BY_MODE[Mode.MODE_POSITION],
    mav.MAV_STANDARD_MODE_SAFE_RECOVERY: _BY_MODE[Mode.MODE_RETURN],
    mav.MAV_STANDARD_MODE_MISSION: _BY_MODE[Mode.MODE_MISSION],
    mav.MAV_STANDARD_MODE_LAND: _BY_MODE[Mode.MODE_LAND],
    mav.MAV_STANDARD_MODE_TAKEOFF: _BY_MODE[Mode.MODE_TAKEOFF],
}
"""Asked for by these numbers; told as non-standard where some ground station's name for them is another than ours."""


def row_of(mode: Mode) -> ModeRow | None:
    """Row of a mode; None for one that has none on the wire."""
    return _BY_MODE.get(mode)


def from_custom(custom: int) -> ModeRow | None:
    """Mode of a custom_mode word; None when there is no such mode."""
    return _BY_CUSTOM.get(custom)


def from_standard(standard: int) -> ModeRow | None:
    """Mode of a MAV_STANDARD_MODE; None when there is no such mode."""
    return _BY_STANDARD.get(standard)


def from_command(param2: float, param3: float) -> ModeRow | None:
    """Mode of DO_SET_MODE, by its param2 and param3 [-]; None when there is no such mode.

    Main and sub mode (MAVSDK; sub may be NaN), or the whole word in param2 (Mission Planner).
    """
    if not math.isfinite(param2):
        return None
    if param2 > 255:
        return from_custom(int(param2))
    sub = int(param3) if math.isfinite(param3) else 0
    return from_custom(int(param2) << 16 | sub << 24) if param2 >= 0 and 0 <= sub <= 255 else None


def there_are(is_ground: bool) -> str:
    """The modes of a rover or of an aircraft, in words."""
    return f"There are {', '.join(row.name for row in TABLE if row.on_ground or not is_ground)}"


def unknown(custom: int, is_ground: bool) -> str:
    """Why there is no mode of a custom_mode word, and which there are."""
    main, sub = custom >> 16 & 0xFF, custom >> 24 & 0xFF
    return f"There is no mode {main}.{sub} (custom_mode {custom:#x}). {there_are(is_ground)}"


def available(index: int) -> mav.MAVLink_available_modes_message | None:
    """AVAILABLE_MODES number ``index`` (from 1); None beyond the list."""
    if not 1 <= index <= len(TABLE):
        return None
    row = TABLE[index - 1]
    return mav.MAVLink_available_modes_message(len(TABLE), index, row.standard, row.custom, row.properties, row.name.encode())
