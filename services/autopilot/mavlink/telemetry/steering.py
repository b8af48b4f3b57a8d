"""What is steered at: the place, the attitude that is held, and how far off both are."""

import math

import numpy as np

from schemas.messages import Mode, NavStatus
from services.autopilot.mavlink.connection.facts import VehicleInfo, VehicleState
from services.autopilot.mavlink.telemetry.navigation import boot_ms
from uvf.maths.geodesy import Floats
from uvf.maths.rotations import from_euler
from uvf.mavlink import dialect as mav
from uvf.mavlink.scaling import I16, I32, U16, compass, whole
from uvf.runtime.messages.convert import array, yaw_of

Message = mav.MAVLink_message | None
UNUSED, UNKNOWN_STRENGTH = 0xFFFF, 255

_ONLY_PLACE = 0xFFF & ~0x7 & ~mav.POSITION_TARGET_TYPEMASK_FORCE_SET
_NO_RATES = (
    mav.ATTITUDE_TARGET_TYPEMASK_BODY_ROLL_RATE_IGNORE
    | mav.ATTITUDE_TARGET_TYPEMASK_BODY_PITCH_RATE_IGNORE
    | mav.ATTITUDE_TARGET_TYPEMASK_BODY_YAW_RATE_IGNORE
)
UNDER_WAY = (NavStatus.PLANNING, NavStatus.DRIVING, NavStatus.RECOVERING)


def place(latest: VehicleState) -> Floats | None:
    """Position (3,) [m, world] of the target: the autopilot's, the planner's goal, or the mission item; None without one."""
    targets, planning = latest.fresh(latest.targets), latest.fresh(latest.planning)
    if targets is not None:
        return array(targets.place) if targets.HasField("place") else None
    if planning is not None and planning.state in UNDER_WAY and planning.HasField("goal"):
        return array(planning.goal)
    status, mission = latest.status, latest.mission
    if status is None or mission is None or status.mode != Mode.MODE_MISSION or status.waypoint >= len(mission.items):
        return None
    return array(mission.items[status.waypoint].position)


def position_target(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """POSITION_TARGET_GLOBAL_INT at ``t`` [s]: the target position [deg, m AMSL], at the altitude held now where that differs."""
    to, targets = place(latest), latest.fresh(latest.targets)
    if to is None or not np.isfinite(to).all():
        return None
    latitude, longitude, amsl = facts.geodetic(to)
    if targets is not None and targets.HasField("altitude"):
        amsl = targets.altitude + facts.origin.altitude
    where = whole(latitude * 1e7, I32), whole(longitude * 1e7, I32), amsl
    return mav.MAVLink_position_target_global_int_message(boot_ms(t), mav.MAV_FRAME_GLOBAL_INT, _ONLY_PLACE, *where, *(0.0,) * 8)


def attitude_target(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """ATTITUDE_TARGET at ``t`` [s]: the bank and pitch held, with the present heading, which is not held."""
    targets, nav, status = latest.fresh(latest.targets), latest.nav, latest.status
    if targets is None or nav is None or status is None or not targets.HasField("bank"):
        return None
    q = from_euler(targets.bank, targets.pitch, math.pi / 2 - yaw_of(nav.orientation))
    return mav.MAVLink_attitude_target_message(boot_ms(t), _NO_RATES, q.tolist(), 0.0, 0.0, 0.0, status.throttle)


def controller_output(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """NAV_CONTROLLER_OUTPUT: attitude held [deg], bearing [deg] and distance [m] of the target, errors of altitude [m] and airspeed
    [m/s] (too low and too slow is positive), cross-track error [m]; ``t`` [s] is not used.
    """
    status, nav, to = latest.status, latest.nav, place(latest)
    if status is None or nav is None or to is None:
        return None
    targets = latest.fresh(latest.targets)
    held = targets is not None and targets.HasField("bank")
    roll, pitch = (math.degrees(targets.bank), math.degrees(targets.pitch)) if targets is not None and held else (math.nan, math.nan)
    faster = targets.airspeed - nav.airspeed if targets is not None and targets.HasField("airspeed") else math.nan
    away = to - array(nav.position)
    bearing = whole(compass(away), I16)
    distance = whole(math.hypot(away[0], away[1]), U16)
    errors = -status.altitude_error, faster, status.cross_track
    return mav.MAVLink_nav_controller_output_message(roll, pitch, bearing, bearing, distance, *errors)


def rc_channels(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """RC_CHANNELS [us] at ``t`` [s]; released channels are marked unused. None while no channel is overridden."""
    if not latest.rc_channels:
        return None
    raw = [us or UNUSED for us in latest.rc_channels]
    count = max(i + 1 for i, us in enumerate(latest.rc_channels) if us) if any(latest.rc_channels) else 0
    fields = [boot_ms(t), count, *raw, UNKNOWN_STRENGTH]
    return mav.MAVLink_rc_channels_message(*fields)


def orbit_status(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """ORBIT_EXECUTION_STATUS at ``t`` [s]: radius [m] positive clockwise, centre [deg, m AMSL]; None in other modes than Orbit."""
    status = latest.status
    if status is None or status.mode != Mode.MODE_ORBIT or not status.HasField("circle"):
        return None
    latitude, longitude, altitude = facts.geodetic(array(status.circle.centre))
    place = whole(latitude * 1e7, I32), whole(longitude * 1e7, I32), altitude
    return mav.MAVLink_orbit_execution_status_message(whole(t * 1e6, (0, 2**63)), status.circle.radius, mav.MAV_FRAME_GLOBAL_INT, *place)
