"""From messages (ENU, FLU) to the autopilot's own values (NED, FRD)."""

import math
from collections.abc import Sequence
from dataclasses import astuple

from schemas.messages import AirData, Gnss, Imu, Mission, MissionItem, MissionProgress, Mode, NavState, OrbitRequest, Vector3
from services.autopilot.air.mode_table import FlightMode
from uvf.estimation.sensor_inputs import GnssFix, InertialSample, Pressures
from uvf.guidance.flight_plan import PlanProgress
from uvf.guidance.route import Circle
from uvf.maths.geodesy import LocalTangent
from uvf.maths.rotations import enu_flu_from_ned_frd, to_euler
from uvf.runtime.messages.convert import seconds, wxyz
from uvf.runtime.messages.plans.plan_ids import mission_id
from uvf.runtime.messages.plans.plan_items import place_of

OLDEST_FIX, OLDEST_SAMPLE = 1.0, 5.0  # s
AHEAD = 0.1  # s by which a sensor's clock may be before ours
OLDEST_STATE = 30.0  # s
STATIC = (5_000.0, 120_000.0)  # Pa, 20 km up to below the Dead Sea
DIFFERENTIAL = (-50_000.0, 50_000.0)  # Pa, of 285 m/s
TEMPERATURE = (150.0, 350.0)  # K
TURNED_OFF = 5.0  # m/s, of an aircraft that nobody has steered
MODES = {
    Mode.MODE_HOLD: FlightMode.HOLD,
    Mode.MODE_MISSION: FlightMode.MISSION,
    Mode.MODE_RETURN: FlightMode.RETURN,
    Mode.MODE_MANUAL: FlightMode.MANUAL,
    Mode.MODE_STABILIZED: FlightMode.STABILIZED,
    Mode.MODE_ALTITUDE: FlightMode.ALTITUDE,
    Mode.MODE_POSITION: FlightMode.POSITION,
    Mode.MODE_TAKEOFF: FlightMode.TAKEOFF,
    Mode.MODE_LAND: FlightMode.LAND,
    Mode.MODE_FOLLOW: FlightMode.FOLLOW,
    Mode.MODE_ORBIT: FlightMode.ORBIT,
    Mode.MODE_OFFBOARD: FlightMode.OFFBOARD,
}


def frd(v: Vector3) -> tuple[float, float, float]:
    """A vector (3,) of a message from FLU into FRD, in its own unit ([m/s^2], [rad/s], [T])."""
    return v.x, -v.y, -v.z


def inertial(message: Imu, t: float) -> InertialSample | None:
    """A sample as seen at time ``t`` [s]; None when its stamp is of no time near: one ahead would make all after it late."""
    age = t - seconds(message.timestamp)
    if not -AHEAD <= age <= OLDEST_SAMPLE:
        return None
    return InertialSample(frd(message.angular_velocity), frd(message.specific_force), frd(message.magnetic_field), age)


def pressures(message: AirData, t: float) -> Pressures | None:
    """As seen at time ``t`` [s]; None when no air is like that: a sensor that has failed may well say 0 Pa."""
    p = Pressures(message.static_pressure, message.differential_pressure, message.temperature, t - seconds(message.timestamp))
    possible = _is_within(p.static, STATIC) and _is_within(p.differential, DIFFERENTIAL) and _is_within(p.temperature, TEMPERATURE)
    return p if possible and math.isfinite(p.age) else None


def _is_within(value: float, limits: tuple[float, float]) -> bool:
    return limits[0] <= value <= limits[1]


def fix(message: Gnss, tangent: LocalTangent, t: float) -> GnssFix | None:
    """A fix as seen at time ``t`` [s]; its stamp is the moment it is valid for. None if there is none, it is old or a number is none."""
    age = t - seconds(message.timestamp)
    if message.fix != Gnss.FIX_3D or not -AHEAD <= age <= OLDEST_FIX:
        return None
    east, north, _ = tangent.enu(message.latitude, message.longitude, message.altitude).tolist()
    v = message.velocity_enu
    found = GnssFix(
        north=north,
        east=east,
        height=message.altitude - tangent.altitude,
        v_north=v.y,
        v_east=v.x,
        v_up=v.z,
        age=age,
        position_sigma=message.horizontal_accuracy,
        height_sigma=message.vertical_accuracy,
        speed_sigma=message.speed_accuracy,
    )
    return found if all(map(math.isfinite, astuple(found))) else None


def left_fix(state: NavState, t: float) -> GnssFix | None:
    """The state that another instance has left, flown straight on to ``t`` [s]; None if that is long ago."""
    p, v, age = state.position, state.velocity, t - seconds(state.timestamp)
    if age > OLDEST_STATE:
        return None
    sigma = state.position_sigma + age * TURNED_OFF
    return GnssFix(p.y + age * v.y, p.x + age * v.x, p.z, v.y, v.x, 0.0, 0.0, sigma, sigma, TURNED_OFF)


def circle(request: OrbitRequest) -> Circle:
    """A radius of 0 is left to the pilot."""
    return Circle(place_of(request.centre), request.radius)


def attitude(state: NavState) -> tuple[float, float, float]:
    """Roll, pitch and yaw [rad], FRD against NED."""
    return to_euler(enu_flu_from_ned_frd(wxyz(state.orientation)))


def stand(progress: MissionProgress | None) -> PlanProgress:
    """Where in the mission another instance has been."""
    if progress is None or progress.state in (MissionProgress.NO_MISSION, MissionProgress.NOT_STARTED):
        return PlanProgress(None, -1, 0, False)
    return PlanProgress(progress.current, progress.reached, progress.laps, progress.state == MissionProgress.COMPLETE)


def with_id(messages: Sequence[MissionItem]) -> Mission:
    """The items unchanged, ``origin`` included."""
    return Mission(items=messages, id=mission_id(messages))
