"""The estimated motion as MAVLink sees it: NED and FRD, degrees times 1e7, altitudes above mean sea level and home."""

import math

import numpy as np

from schemas.messages import NavState
from services.autopilot.mavlink.connection.facts import VehicleInfo, VehicleState
from uvf.maths.geodesy import Floats
from uvf.maths.rotations import enu_flu_from_ned_frd, to_euler
from uvf.mavlink import dialect as mav
from uvf.mavlink.scaling import I16, I32, U16, heading_degrees, whole
from uvf.runtime.messages.convert import array, wxyz, yaw_of

Message = mav.MAVLink_message | None


def boot_ms(t: float) -> int:
    """Time [ms] since the link came up at ``t`` [s]."""
    return whole(t * 1e3, (0, 2**32 - 1))


def system_time(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """SYSTEM_TIME at ``t`` [s, since the link's start]: wall time, as in all messages of the link."""
    unix = whole((facts.started + t) * 1e6, (0, 2**63)) if facts.started else 0
    return mav.MAVLink_system_time_message(unix, boot_ms(t))


def ned_from_frd(enu_from_flu: Floats) -> Floats:
    """Attitude NED from FRD (4,) wxyz of an attitude ENU from FLU (4,) wxyz; the change of conventions is its own inverse."""
    return enu_flu_from_ned_frd(enu_from_flu)


def frd_rates(nav: NavState) -> tuple[float, float, float]:
    """Body rates (roll, pitch, yaw) [rad/s, FRD]."""
    return nav.angular_velocity.x, -nav.angular_velocity.y, -nav.angular_velocity.z


def attitude(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """ATTITUDE at ``t`` [s]: Euler angles [rad, NED] and body rates [rad/s, FRD]; None without an estimate."""
    if latest.nav is None:
        return None
    roll, pitch, yaw = to_euler(ned_from_frd(wxyz(latest.nav.orientation)))
    return mav.MAVLink_attitude_message(boot_ms(t), roll, pitch, yaw, *frd_rates(latest.nav))


def local_position(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """LOCAL_POSITION_NED at ``t`` [s]: position [m] and velocity [m/s] of the world frame, turned to NED."""
    if latest.nav is None:
        return None
    p, v = latest.nav.position, latest.nav.velocity
    return mav.MAVLink_local_position_ned_message(boot_ms(t), p.y, p.x, -p.z, v.y, v.x, -v.z)


def relative_altitude(latest: VehicleState) -> float:
    """Altitude [m] above home; above the world's origin while home is unknown."""
    assert latest.nav is not None
    home = latest.home
    return latest.nav.position.z - (float(home[2]) if home is not None else 0.0)


def global_position(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """GLOBAL_POSITION_INT at ``t`` [s]: degrees times 1e7, mm, cm/s NED, heading in 0.01 degrees; None without a finite position."""
    nav = latest.nav
    if nav is None or not np.isfinite(array(nav.position)).all():
        return None
    latitude, longitude, amsl = facts.geodetic(array(nav.position))
    v = nav.velocity
    return mav.MAVLink_global_position_int_message(
        boot_ms(t),
        whole(latitude * 1e7, I32),
        whole(longitude * 1e7, I32),
        whole(amsl * 1e3, I32),
        whole(relative_altitude(latest) * 1e3, I32),
        whole(v.y * 100, I16),
        whole(v.x * 100, I16),
        whole(-v.z * 100, I16),
        whole(heading_degrees(yaw_of(nav.orientation)) * 100, U16, 0xFFFF) % 36000,
    )


def altitude(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """ALTITUDE [m] at ``t`` [s]: the estimate itself as the monotonic one, for no other altitude is measured."""
    if latest.nav is None:
        return None
    z = latest.nav.position.z
    amsl = z + facts.origin.altitude
    nan = math.nan
    return mav.MAVLink_altitude_message(whole(t * 1e6, (0, 2**63)), amsl, amsl, z, relative_altitude(latest), nan, nan)


def hud(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """VFR_HUD: airspeed, ground speed and climb [m/s], heading [deg], throttle [%], altitude [m AMSL]; ``t`` [s] is not used."""
    nav = latest.nav
    if nav is None:
        return None
    ground_speed = math.hypot(nav.velocity.x, nav.velocity.y)
    heading = whole(heading_degrees(yaw_of(nav.orientation)), (0, 360)) % 360
    throttle = whole(latest.status.throttle * 100, (0, 100)) if latest.status is not None else 0
    amsl = nav.position.z + facts.origin.altitude
    return mav.MAVLink_vfr_hud_message(nav.airspeed, ground_speed, heading, throttle, amsl, nav.velocity.z)


def global_origin(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """GPS_GLOBAL_ORIGIN: that of the world, degrees times 1e7 and mm AMSL; ``t`` [s] is not used."""
    latitude, longitude, amsl = facts.geodetic(np.zeros(3))
    return mav.MAVLink_gps_global_origin_message(whole(latitude * 1e7, I32), whole(longitude * 1e7, I32), whole(amsl * 1e3, I32))
