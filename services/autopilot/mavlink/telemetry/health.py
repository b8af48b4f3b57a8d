"""Which sensors and controllers a vehicle has, whether they work, and why it should not arm."""

from dataclasses import dataclass

from schemas.messages import Gnss
from services.autopilot.mavlink.connection.facts import VehicleInfo, VehicleState
from uvf.mavlink import dialect as mav
from uvf.runtime.state.stop_all import told

_IMU = mav.MAV_SYS_STATUS_SENSOR_3D_GYRO | mav.MAV_SYS_STATUS_SENSOR_3D_ACCEL | mav.MAV_SYS_STATUS_SENSOR_3D_MAG
_AIR_DATA = mav.MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE | mav.MAV_SYS_STATUS_SENSOR_DIFFERENTIAL_PRESSURE
_CONTROL = (
    mav.MAV_SYS_STATUS_SENSOR_ANGULAR_RATE_CONTROL
    | mav.MAV_SYS_STATUS_SENSOR_YAW_POSITION
    | mav.MAV_SYS_STATUS_SENSOR_XY_POSITION_CONTROL
    | mav.MAV_SYS_STATUS_SENSOR_MOTOR_OUTPUTS
    | mav.MAV_SYS_STATUS_AHRS
)
_FLIGHT_CONTROL = mav.MAV_SYS_STATUS_SENSOR_ATTITUDE_STABILIZATION | mav.MAV_SYS_STATUS_SENSOR_Z_ALTITUDE_CONTROL


@dataclass(frozen=True)
class Health:
    """Bits of MAV_SYS_STATUS_SENSOR; all sensors present are enabled."""

    present: int
    healthy: int
    complaints: tuple[str, ...]


def health(facts: VehicleInfo, latest: VehicleState) -> Health:
    """Sensors present as the vehicle's file has them, and healthy as the newest messages show."""
    present = mav.MAV_SYS_STATUS_PREARM_CHECK | _CONTROL | (0 if facts.is_ground else _FLIGHT_CONTROL)
    present |= _IMU if facts.sensors.imu else 0
    present |= _AIR_DATA if facts.sensors.air_data else 0
    present |= mav.MAV_SYS_STATUS_SENSOR_GPS
    present |= mav.MAV_SYS_STATUS_SENSOR_BATTERY if latest.battery is not None else 0
    present |= mav.MAV_SYS_STATUS_GEOFENCE if latest.is_fenced else 0
    complaints = _complaints(facts, latest)
    # The fence's bit also without a fence, and of a vehicle that is silent: MAVProxy says "fence breach" as soon as it is missing.
    healthy = (0 if latest.is_silent else present) | mav.MAV_SYS_STATUS_GEOFENCE
    if complaints:
        healthy &= ~mav.MAV_SYS_STATUS_PREARM_CHECK
    if latest.status is not None and latest.status.breach:
        healthy &= ~mav.MAV_SYS_STATUS_GEOFENCE
    if not _knows_where_it_is(facts, latest):
        healthy &= ~mav.MAV_SYS_STATUS_SENSOR_GPS
    return Health(present, healthy, complaints)


def _knows_where_it_is(facts: VehicleInfo, latest: VehicleState) -> bool:
    """What ground stations take the GPS bit for. A vehicle without a receiver knows it from its map, which lies in the world.

    Without the bit MAVSDK's ``health_all_ok``, for which every script waits, is never true; GPS_RAW_INT is not sent for it.
    """
    return facts.sensors.gnss is None or _has_fix(latest)


def _has_fix(latest: VehicleState) -> bool:
    gnss = latest.fresh(latest.gnss)
    return gnss is not None and gnss.fix >= Gnss.FIX_3D


def _complaints(facts: VehicleInfo, latest: VehicleState) -> tuple[str, ...]:
    said = []
    if latest.nav is None:
        said.append("no position estimate yet")
    if latest.status is None:
        said.append("the autopilot has not reported yet")
    if not said and latest.is_silent:
        said.append("estimator or autopilot has gone silent")
    if latest.status is not None and latest.status.stopped:
        said.append(f"STOP ALL is engaged by {told(latest.status.stops) or 'somebody'}")
    if latest.is_gliding:
        said.append("it glides, the motor is off")
    if facts.sensors.gnss and not _has_fix(latest):
        said.append("no satellite fix")
    # What speaks against arming an aircraft that stands is no complaint about one that is armed and rolls.
    disarmed = latest.status is not None and not latest.status.armed
    said += [why for why in (latest.status.prearm if latest.status is not None and disarmed else ()) if why not in said]
    return tuple(said)
