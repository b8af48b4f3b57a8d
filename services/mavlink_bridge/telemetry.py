"""What an autopilot tells of itself, as the system's messages; what it has not told is left out."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from schemas.messages import Battery, Circle, Gnss, NavState, Vector3
from services.mavlink_bridge.frame import Chart
from services.mavlink_bridge.limits import is_on_earth, is_sound
from uvf.maths.geodesy import Floats
from uvf.maths.rotations import enu_flu_from_ned_frd, from_euler
from uvf.mavlink import dialect as mav
from uvf.runtime.mavlink.limits import HIGHEST
from uvf.runtime.messages.convert import array, quaternion

FRESH = 2.0  # s: what is told at least each second
UNKNOWN_U16 = 0xFFFF
Message = Any


@dataclass
class Heard:
    """A received message and when it came [s, wall]."""

    message: Message
    at: float  # s, wall


class Telemetry:
    """The newest message of each kind, and what follows from them. Times are wall time [s]."""

    KINDS = (
        mav.MAVLINK_MSG_ID_ATTITUDE,
        mav.MAVLINK_MSG_ID_ATTITUDE_QUATERNION,
        mav.MAVLINK_MSG_ID_GLOBAL_POSITION_INT,
        mav.MAVLINK_MSG_ID_VFR_HUD,
        mav.MAVLINK_MSG_ID_SYS_STATUS,
        mav.MAVLINK_MSG_ID_BATTERY_STATUS,
        mav.MAVLINK_MSG_ID_GPS_RAW_INT,
        mav.MAVLINK_MSG_ID_WIND_COV,
        mav.MAVLINK_MSG_ID_ESTIMATOR_STATUS,
        mav.MAVLINK_MSG_ID_HOME_POSITION,
        mav.MAVLINK_MSG_ID_EXTENDED_SYS_STATE,
        mav.MAVLINK_MSG_ID_NAV_CONTROLLER_OUTPUT,
        mav.MAVLINK_MSG_ID_ORBIT_EXECUTION_STATUS,
        mav.MAVLINK_MSG_ID_FENCE_STATUS,
        mav.MAVLINK_MSG_ID_MISSION_CURRENT,
    )

    def __init__(self, refuse: Callable[[str, str], None]) -> None:
        """refuse: called with what of a message is left out, and why."""
        self.t = 0.0
        self._refuse = refuse
        self._heard: dict[int, Heard] = {}
        self._news: set[int] = set()
        """Kinds heard since the last look."""

    def handlers(self) -> dict[int, Callable[[Message], None]]:
        """Handlers of the telemetry messages, by message id."""
        return dict.fromkeys(self.KINDS, self._hear)

    def _hear(self, message: Message) -> None:
        """What cannot be true is not kept: what was told before it counts on."""
        kind = message.get_msgId()
        if why := nonsense(message):
            self._refuse(message.get_type(), why)
            return
        self._heard[kind] = Heard(message, self.t)
        self._news.add(kind)

    def forget(self) -> None:
        """Drops all messages, after a restart of the autopilot."""
        self._heard.clear()
        self._news.clear()

    def newest(self, kind: int, within: float = math.inf) -> Message | None:
        """The newest message of a kind, if it came within ``within`` [s]; else None."""
        heard = self._heard.get(kind)
        return heard.message if heard is not None and self.t - heard.at <= within else None

    def is_new(self, *kinds: int) -> bool:
        """Whether a message of one of these kinds has come since the last call."""
        found = bool(self._news & set(kinds))
        self._news -= set(kinds)
        return found

    @property
    def home(self) -> tuple[float, float, float] | None:
        """Home (latitude [deg], longitude [deg], altitude [m AMSL]); None while unknown."""
        home = self.newest(mav.MAVLINK_MSG_ID_HOME_POSITION)
        return (home.latitude * 1e-7, home.longitude * 1e-7, home.altitude * 1e-3) if home is not None else None

    def nav(self, chart: Chart) -> NavState | None:
        """The estimated motion in the world frame; None until position and attitude are known, and while neither is new."""
        kinds = (mav.MAVLINK_MSG_ID_GLOBAL_POSITION_INT, mav.MAVLINK_MSG_ID_ATTITUDE_QUATERNION, mav.MAVLINK_MSG_ID_ATTITUDE)
        if not self.is_new(*kinds):
            return None
        here = self.newest(mav.MAVLINK_MSG_ID_GLOBAL_POSITION_INT, FRESH)
        turned = self._orientation()
        if here is None or turned is None or (here.lat == 0 and here.lon == 0):
            return None
        turn, rates = turned
        nav = NavState(
            position=chart.world(here.lat * 1e-7, here.lon * 1e-7, here.alt * 1e-3),
            velocity=Vector3(x=here.vy * 0.01, y=here.vx * 0.01, z=-here.vz * 0.01),
            orientation=quaternion(turn),
            angular_velocity=Vector3(x=rates[0], y=-rates[1], z=-rates[2]),
        )
        return self._filled(nav, chart) if is_sound(*array(nav.position), *rates) else None

    def _orientation(self) -> tuple[Floats, tuple[float, float, float]] | None:
        """World (ENU) from body (FLU), and the rates [rad/s, FRD]."""
        exact = self.newest(mav.MAVLINK_MSG_ID_ATTITUDE_QUATERNION, FRESH)
        if exact is not None:
            wire = np.array((exact.q1, exact.q2, exact.q3, exact.q4))
            length = float(np.linalg.norm(wire))
            if 0.9 < length < 1.1:
                return enu_flu_from_ned_frd(wire / length), (exact.rollspeed, exact.pitchspeed, exact.yawspeed)
        angles = self.newest(mav.MAVLINK_MSG_ID_ATTITUDE, FRESH)
        if angles is None or not is_sound(angles.roll, angles.pitch, angles.yaw):
            return None
        turn = enu_flu_from_ned_frd(from_euler(angles.roll, angles.pitch, angles.yaw))
        return turn, (angles.rollspeed, angles.pitchspeed, angles.yawspeed)

    def _filled(self, nav: NavState, chart: Chart) -> NavState:
        """Airspeed, wind and accuracy, where they are told."""
        hud = self.newest(mav.MAVLINK_MSG_ID_VFR_HUD, FRESH)
        if hud is not None and is_sound(hud.airspeed) and not chart.is_ground:
            nav.airspeed = hud.airspeed
        wind = self.newest(mav.MAVLINK_MSG_ID_WIND_COV, 3 * FRESH)
        if wind is not None and is_sound(wind.wind_x, wind.wind_y):
            up = -wind.wind_z if is_sound(wind.wind_z) else 0.0
            nav.wind.CopyFrom(Vector3(x=wind.wind_y, y=wind.wind_x, z=up))
        quality = self.newest(mav.MAVLINK_MSG_ID_ESTIMATOR_STATUS, 3 * FRESH)
        gps = self.newest(mav.MAVLINK_MSG_ID_GPS_RAW_INT, FRESH)
        if quality is not None and is_sound(quality.pos_horiz_accuracy) and quality.pos_horiz_accuracy >= 0:
            nav.position_sigma = quality.pos_horiz_accuracy
        elif gps is not None and gps.h_acc:
            nav.position_sigma = gps.h_acc * 1e-3
        return nav

    def gnss(self) -> Gnss | None:
        """The newest reading of the GNSS receiver; None while there is no new one."""
        gps = self.newest(mav.MAVLINK_MSG_ID_GPS_RAW_INT)
        if gps is None or not self.is_new(mav.MAVLINK_MSG_ID_GPS_RAW_INT):
            return None
        told = Gnss(fix=Gnss.FIX_3D if gps.fix_type >= mav.GPS_FIX_TYPE_3D_FIX else Gnss.NONE)
        told.latitude, told.longitude, told.altitude = math.radians(gps.lat * 1e-7), math.radians(gps.lon * 1e-7), gps.alt * 1e-3
        told.horizontal_accuracy, told.vertical_accuracy, told.speed_accuracy = gps.h_acc * 1e-3, gps.v_acc * 1e-3, gps.vel_acc * 1e-3
        told.satellites = gps.satellites_visible if gps.satellites_visible != 255 else 0
        if UNKNOWN_U16 not in (gps.vel, gps.cog):
            course = math.radians(gps.cog * 0.01)
            told.velocity_enu.CopyFrom(Vector3(x=gps.vel * 0.01 * math.sin(course), y=gps.vel * 0.01 * math.cos(course)))
        return told

    def battery(self) -> Battery | None:
        """The newest reading of the first battery; None while there is no complete new one."""
        if not self.is_new(mav.MAVLINK_MSG_ID_BATTERY_STATUS, mav.MAVLINK_MSG_ID_SYS_STATUS):
            return None
        volts, amperes, remaining = self.charge()
        if math.isnan(volts + amperes) or remaining < 0:
            return None
        return Battery(voltage=volts, current=amperes, remaining=remaining)

    def charge(self) -> tuple[float, float, float]:
        """Voltage [V] and current [A], both NaN when unknown, and remaining charge (0..1, negative = unknown)."""
        pack, status = self.newest(mav.MAVLINK_MSG_ID_BATTERY_STATUS, 5 * FRESH), self.newest(mav.MAVLINK_MSG_ID_SYS_STATUS, 5 * FRESH)
        volts = amperes = math.nan
        left = -1
        if status is not None:
            volts = status.voltage_battery * 1e-3 if status.voltage_battery != UNKNOWN_U16 else math.nan
            amperes = status.current_battery * 0.01 if status.current_battery >= 0 else math.nan
            left = status.battery_remaining
        if pack is not None and pack.id == 0:
            cells = [v for v in pack.voltages if v != UNKNOWN_U16]
            volts = sum(cells) * 1e-3 if cells else volts
            amperes = pack.current_battery * 0.01 if pack.current_battery >= 0 else amperes
            left = pack.battery_remaining if pack.battery_remaining >= 0 else left
        return volts, amperes, left * 0.01 if 0 <= left <= 100 else -1.0

    def circle(self, chart: Chart) -> Circle | None:
        """The circle being flown, in the world frame; None while none is reported."""
        told = self.newest(mav.MAVLINK_MSG_ID_ORBIT_EXECUTION_STATUS, FRESH)
        if told is None or told.frame not in (mav.MAV_FRAME_GLOBAL, mav.MAV_FRAME_GLOBAL_INT) or not is_sound(told.radius, told.z):
            return None
        return Circle(centre=chart.world(told.x * 1e-7, told.y * 1e-7, told.z), radius=told.radius)


PLACES = {
    mav.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: ("lat", "lon", "alt"),
    mav.MAVLINK_MSG_ID_GPS_RAW_INT: ("lat", "lon", "alt"),
    mav.MAVLINK_MSG_ID_HOME_POSITION: ("latitude", "longitude", "altitude"),
}
"""Fields in 1e-7 deg and mm."""


def nonsense(message: Message) -> str:
    """Why a message cannot be true; "" if it may be."""
    kind = message.get_msgId()
    if kind == mav.MAVLINK_MSG_ID_ORBIT_EXECUTION_STATUS:
        return "" if is_on_earth(message.x * 1e-7, message.y * 1e-7) else "its centre is nowhere on earth"
    if kind not in PLACES:
        return ""
    latitude, longitude, altitude = (getattr(message, name) for name in PLACES[kind])
    if not is_on_earth(latitude * 1e-7, longitude * 1e-7):
        return f"latitude {latitude * 1e-7:.6f}, longitude {longitude * 1e-7:.6f} are nowhere on earth"
    if kind == mav.MAVLINK_MSG_ID_HOME_POSITION and latitude == 0 and longitude == 0:
        return "latitude and longitude are 0"
    if abs(altitude * 1e-3) > HIGHEST:
        return f"an altitude of {altitude * 1e-3:.0f} m"
    return ""
