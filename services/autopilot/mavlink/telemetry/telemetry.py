"""What a vehicle tells unasked: estimated motion, status, battery, mission, as MAVLink messages.

Every builder takes (facts, latest, t [s since the link came up]) and returns None while it knows nothing to say, or a list.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from schemas.messages import Breach, Gnss, MissionItem, Mode
from services.autopilot.mavlink.connection.facts import VehicleInfo, VehicleState
from services.autopilot.mavlink.telemetry import estimate_quality, identity, navigation, sensor_messages, steering
from services.autopilot.mavlink.telemetry.health import health
from services.autopilot.mavlink.telemetry.traffic import traffic
from uvf.mavlink import dialect as mav
from uvf.mavlink.scaling import I32, U16, whole
from uvf.mavlink.scaling import compass as compass_of
from uvf.runtime.messages.convert import array, wxyz
from uvf.runtime.messages.plans.plan_ids import fence_id, rally_id

RANGE_ERROR = 1.0  # m, 1 sigma of the distance to one satellite
Message = mav.MAVLink_message | None
Build = Callable[[VehicleInfo, VehicleState, float], Message | list[mav.MAVLink_message]]


@dataclass(frozen=True)
class TelemetryStream:
    """A message that is sent regularly. hz: default rate [1/s, wall]; 0 = only on request."""

    build: Build
    hz: float

    def messages(self, facts: VehicleInfo, latest: VehicleState, t: float) -> list[mav.MAVLink_message]:
        """The messages to send at ``t`` [s, since the link's start]: none, one, or several."""
        told = self.build(facts, latest, t)
        return told if isinstance(told, list) else [told] if told is not None else []


def _sys_status(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    bits = health(facts, latest)
    battery = latest.battery
    volts = whole(battery.voltage * 1e3, U16, 0xFFFF) if battery else 0xFFFF
    amperes = whole(battery.current * 1e2, (-1, 2**15 - 1), -1) if battery else -1
    left = whole(battery.remaining * 100, (-1, 100), -1) if battery else -1
    return mav.MAVLink_sys_status_message(bits.present, bits.present, bits.healthy, 0, volts, amperes, left, 0, 0, 0, 0, 0, 0)


def _battery_status(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    battery = latest.battery
    if battery is None:
        return None
    cells = (whole(battery.voltage * 1e3, (0, 0xFFFE), 0xFFFF), *(0xFFFF,) * 9)
    return mav.MAVLink_battery_status_message(
        0,
        mav.MAV_BATTERY_FUNCTION_ALL,
        mav.MAV_BATTERY_TYPE_UNKNOWN,
        2**15 - 1,
        cells,
        whole(battery.current * 1e2, (-1, 2**15 - 1), -1),
        -1,
        -1,
        whole(battery.remaining * 100, (-1, 100), -1),
        charge_state=charge_state(battery.remaining, latest.own),
    )


def charge_state(remaining: float, own: Mapping[str, float]) -> int:
    """MAV_BATTERY_CHARGE_STATE of a charge 0..1 [-]; negative or NaN = unknown. own: the autopilot's parameters, with its limits."""
    if not remaining >= 0:
        return int(mav.MAV_BATTERY_CHARGE_STATE_UNDEFINED)
    if remaining < own["emergency_charge"]:
        return int(mav.MAV_BATTERY_CHARGE_STATE_EMERGENCY)
    if remaining < own["battery_critical"]:
        return int(mav.MAV_BATTERY_CHARGE_STATE_CRITICAL)
    return int(mav.MAV_BATTERY_CHARGE_STATE_LOW if remaining < own["battery_low"] else mav.MAV_BATTERY_CHARGE_STATE_OK)


def _gps_raw(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """Only vehicles with a receiver have one to report; one that has fallen silent has no fix.

    Dilutions of precision follow from the accuracy: without them QGroundControl shows no count of satellites either.
    """
    gnss = latest.gnss
    if gnss is None or facts.sensors.gnss is None:
        return None
    velocity = array(gnss.velocity_enu)
    return mav.MAVLink_gps_raw_int_message(
        whole(t * 1e6, (0, 2**63)),
        mav.GPS_FIX_TYPE_3D_FIX if gnss.fix >= Gnss.FIX_3D and latest.fresh(gnss) else mav.GPS_FIX_TYPE_NO_FIX,
        whole(math.degrees(gnss.latitude) * 1e7, I32),
        whole(math.degrees(gnss.longitude) * 1e7, I32),
        whole(gnss.altitude * 1e3, I32),
        _dilution(gnss.horizontal_accuracy),
        _dilution(gnss.vertical_accuracy),
        whole(float(np.hypot(velocity[0], velocity[1])) * 100, U16, 0xFFFF),
        whole(compass_of(velocity) * 100, U16, 0xFFFF),
        min(gnss.satellites, 255),
        h_acc=whole(gnss.horizontal_accuracy * 1e3, (0, 2**32 - 1)),
        v_acc=whole(gnss.vertical_accuracy * 1e3, (0, 2**32 - 1)),
        vel_acc=whole(gnss.speed_accuracy * 1e3, (0, 2**32 - 1)),
    )


def _dilution(accuracy: float) -> int:
    """In hundredths, of an accuracy [m, 1 sigma]."""
    return whole(accuracy / RANGE_ERROR * 100, (0, 0xFFFE), 0xFFFF)


def _home_position(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    home = latest.home
    if home is None or not np.isfinite(home).all():
        return None
    latitude, longitude, altitude = facts.geodetic(home)
    nan = math.nan
    return mav.MAVLink_home_position_message(
        whole(latitude * 1e7, I32),
        whole(longitude * 1e7, I32),
        whole(altitude * 1e3, I32),
        *(home[1], home[0], -home[2]),
        (nan,) * 4,
        *(nan, nan, nan),
        whole(t * 1e6, (0, 2**63)),
    )


def landed_state(facts: VehicleInfo, latest: VehicleState) -> int:
    """MAV_LANDED_STATE. An armed rover counts as in the air, as PX4's does: otherwise no ground station would guide it."""
    status = latest.status
    if status is None:
        return int(mav.MAV_LANDED_STATE_UNDEFINED)
    if facts.is_ground:
        return int(mav.MAV_LANDED_STATE_IN_AIR if status.armed else mav.MAV_LANDED_STATE_ON_GROUND)
    if status.landed:
        return int(mav.MAV_LANDED_STATE_ON_GROUND)
    special = {Mode.MODE_TAKEOFF: mav.MAV_LANDED_STATE_TAKEOFF, Mode.MODE_LAND: mav.MAV_LANDED_STATE_LANDING}
    return int(special.get(status.mode, _of_item(latest) if status.mode == Mode.MODE_MISSION else mav.MAV_LANDED_STATE_IN_AIR))


def _of_item(latest: VehicleState) -> int:
    """A mission takes off and lands by its items; ground stations offer to abort a landing while they see one."""
    status, mission = latest.status, latest.mission
    if status is None or mission is None or status.waypoint >= len(mission.items):
        return int(mav.MAV_LANDED_STATE_IN_AIR)
    special = {MissionItem.TAKEOFF: mav.MAV_LANDED_STATE_TAKEOFF, MissionItem.LAND: mav.MAV_LANDED_STATE_LANDING}
    return int(special.get(mission.items[status.waypoint].kind, mav.MAV_LANDED_STATE_IN_AIR))


def _extended_sys_state(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    return mav.MAVLink_extended_sys_state_message(mav.MAV_VTOL_STATE_UNDEFINED, landed_state(facts, latest))


def mission_current(latest: VehicleState, seq: int | None = None) -> mav.MAVLink_mission_current_message:
    """MISSION_CURRENT; ``seq``: an item just set, ahead of the autopilot's next report."""
    progress = latest.progress
    ids = fence_id(latest.fence), rally_id(latest.rally)
    if progress is None or progress.state == progress.NO_MISSION:
        return mav.MAVLink_mission_current_message(0, 0, mav.MISSION_STATE_NO_MISSION, 0, 0, *ids)
    state = progress.state + 1  # MISSION_STATE counts from UNKNOWN
    flying = latest.status is not None and latest.status.mode == Mode.MODE_MISSION
    item = min(progress.current if seq is None else seq, 0xFFFF)
    return mav.MAVLink_mission_current_message(item, min(progress.total, 0xFFFE), state, 1 if flying else 2, progress.mission_id, *ids)


def _fence_status(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """Only while there is a fence. Breach has the numbers of FENCE_BREACH."""
    status = latest.status
    if status is None or not latest.is_fenced:
        return None
    at = latest.breached_at
    time = 0 if at is None else navigation.boot_ms(at)
    breached = int(status.breach != Breach.BREACH_NONE)
    return mav.MAVLink_fence_status_message(breached, min(status.breaches, 0xFFFF), status.breach, time, mav.FENCE_MITIGATE_UNKNOWN)


def _quaternion(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    if latest.nav is None:
        return None
    w, x, y, z = navigation.ned_from_frd(wxyz(latest.nav.orientation))
    roll, pitch, yaw = navigation.frd_rates(latest.nav)
    return mav.MAVLink_attitude_quaternion_message(navigation.boot_ms(t), w, x, y, z, roll, pitch, yaw)


STREAMS: dict[int, TelemetryStream] = {
    mav.MAVLINK_MSG_ID_HEARTBEAT: TelemetryStream(lambda f, n, t: identity.heartbeat(f, n), 1),
    mav.MAVLINK_MSG_ID_SYS_STATUS: TelemetryStream(_sys_status, 1),
    mav.MAVLINK_MSG_ID_SYSTEM_TIME: TelemetryStream(navigation.system_time, 1),
    mav.MAVLINK_MSG_ID_GPS_RAW_INT: TelemetryStream(_gps_raw, 5),
    mav.MAVLINK_MSG_ID_ATTITUDE: TelemetryStream(navigation.attitude, 20),
    mav.MAVLINK_MSG_ID_ATTITUDE_QUATERNION: TelemetryStream(_quaternion, 20),
    mav.MAVLINK_MSG_ID_LOCAL_POSITION_NED: TelemetryStream(navigation.local_position, 5),
    mav.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: TelemetryStream(navigation.global_position, 10),
    mav.MAVLINK_MSG_ID_FENCE_STATUS: TelemetryStream(_fence_status, 1),
    mav.MAVLINK_MSG_ID_MISSION_CURRENT: TelemetryStream(lambda f, n, t: mission_current(n) if n.progress is not None else None, 1),
    mav.MAVLINK_MSG_ID_NAV_CONTROLLER_OUTPUT: TelemetryStream(steering.controller_output, 3),
    mav.MAVLINK_MSG_ID_VFR_HUD: TelemetryStream(navigation.hud, 10),
    mav.MAVLINK_MSG_ID_ALTITUDE: TelemetryStream(navigation.altitude, 5),
    mav.MAVLINK_MSG_ID_BATTERY_STATUS: TelemetryStream(_battery_status, 1),
    mav.MAVLINK_MSG_ID_ESTIMATOR_STATUS: TelemetryStream(estimate_quality.estimator_status, 1),
    mav.MAVLINK_MSG_ID_WIND_COV: TelemetryStream(estimate_quality.wind, 1),
    mav.MAVLINK_MSG_ID_SERVO_OUTPUT_RAW: TelemetryStream(sensor_messages.servo_output, 4),
    mav.MAVLINK_MSG_ID_HIGHRES_IMU: TelemetryStream(sensor_messages.highres_imu, 5),
    mav.MAVLINK_MSG_ID_SCALED_PRESSURE: TelemetryStream(sensor_messages.scaled_pressure, 1),
    mav.MAVLINK_MSG_ID_VIBRATION: TelemetryStream(sensor_messages.vibration, 1),
    mav.MAVLINK_MSG_ID_ATTITUDE_TARGET: TelemetryStream(steering.attitude_target, 5),
    mav.MAVLINK_MSG_ID_POSITION_TARGET_GLOBAL_INT: TelemetryStream(steering.position_target, 2),
    mav.MAVLINK_MSG_ID_ADSB_VEHICLE: TelemetryStream(traffic, 1),
    mav.MAVLINK_MSG_ID_HOME_POSITION: TelemetryStream(_home_position, 0.5),
    mav.MAVLINK_MSG_ID_EXTENDED_SYS_STATE: TelemetryStream(_extended_sys_state, 1),
    mav.MAVLINK_MSG_ID_CURRENT_MODE: TelemetryStream(lambda f, n, t: identity.current_mode(n), 0.5),
    mav.MAVLINK_MSG_ID_ORBIT_EXECUTION_STATUS: TelemetryStream(steering.orbit_status, 2),
    mav.MAVLINK_MSG_ID_RC_CHANNELS: TelemetryStream(steering.rc_channels, 2),
    mav.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN: TelemetryStream(navigation.global_origin, 0),
    mav.MAVLINK_MSG_ID_AUTOPILOT_VERSION: TelemetryStream(lambda f, n, t: identity.autopilot_version(f), 0),
    mav.MAVLINK_MSG_ID_PROTOCOL_VERSION: TelemetryStream(lambda f, n, t: identity.protocol_version(), 0),
}
