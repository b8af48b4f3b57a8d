"""What the sensors read and the actuators are told, as MAVLink has it: FRD, hPa, gauss, microseconds of pulse."""

import math

from schemas.messages import AirData, SurfaceCommand, WheelCommand
from services.autopilot.mavlink.connection.facts import VehicleInfo, VehicleState
from services.autopilot.mavlink.telemetry.navigation import boot_ms
from uvf.maths import atmosphere
from uvf.maths.geodesy import Floats
from uvf.maths.rotations import FLU_FROM_FRD, from_euler, rotate
from uvf.mavlink import dialect as mav
from uvf.mavlink.scaling import I16, whole
from uvf.models.vehicle.drive import AckermannFile
from uvf.runtime.messages.convert import array
from uvf.runtime.messages.wheels import speeds_of

Message = mav.MAVLink_message | None

ZERO_CELSIUS = 273.15  # K
GAUSS = 1e-4  # T
HECTOPASCAL = 100.0  # Pa
CENTRE, HALF = 1500.0, 500.0  # us of a servo's pulse
UNUSED, OUTPUTS = 0, 8
FRD: Floats = FLU_FROM_FRD.diagonal()  # signs of a vector's components, whatever they are

_INERTIAL = sum(1 << bit for bit in range(6))
_MAGNETIC = mav.HIGHRES_IMU_UPDATED_XMAG | mav.HIGHRES_IMU_UPDATED_YMAG | mav.HIGHRES_IMU_UPDATED_ZMAG
_PRESSURES = (
    mav.HIGHRES_IMU_UPDATED_ABS_PRESSURE
    | mav.HIGHRES_IMU_UPDATED_DIFF_PRESSURE
    | mav.HIGHRES_IMU_UPDATED_PRESSURE_ALT
    | mav.HIGHRES_IMU_UPDATED_TEMPERATURE
)


def body_frd(facts: VehicleInfo, sensed: Floats) -> Floats:
    """A vector (3,) of the IMU's axes (FLU, mounted as the vehicle's file says) in the body frame (FRD)."""
    imu = facts.sensors.imu
    if imu is not None and any(imu.mount.rpy):
        sensed = rotate(from_euler(*imu.mount.rpy), sensed)
    return sensed * FRD


def highres_imu(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """HIGHRES_IMU at ``t`` [s]: body FRD [m/s^2, rad/s, gauss], pressures [hPa]; ``fields_updated`` names what is measured."""
    imu, air = latest.fresh(latest.imu), latest.fresh(latest.air_data)
    if imu is None:
        return None
    mx, my, mz = body_frd(facts, array(imu.magnetic_field)) / GAUSS
    ax, ay, az = body_frd(facts, array(imu.specific_force))
    p, q, r = body_frd(facts, array(imu.angular_velocity))
    static, differential, height, celsius = _air(air) if air is not None else (0.0, 0.0, 0.0, 0.0)
    flags = _INERTIAL | (_MAGNETIC if mx or my or mz else 0) | (_PRESSURES if air is not None else 0)
    usec = whole(t * 1e6, (0, 2**63))
    return mav.MAVLink_highres_imu_message(usec, ax, ay, az, p, q, r, mx, my, mz, static, differential, height, celsius, flags)


def _air(air: AirData) -> tuple[float, float, float, float]:
    """Pressures [hPa], their altitude in the standard atmosphere [m], temperature [deg C]."""
    height = atmosphere.altitude(air.static_pressure) if air.static_pressure > 0 else math.nan
    return air.static_pressure / HECTOPASCAL, air.differential_pressure / HECTOPASCAL, height, air.temperature - ZERO_CELSIUS


def scaled_pressure(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """SCALED_PRESSURE at ``t`` [s]: static and differential pressure [hPa], temperature [0.01 deg C]; None without air data."""
    air = latest.fresh(latest.air_data)
    if air is None:
        return None
    static, differential, _, celsius = _air(air)
    return mav.MAVLink_scaled_pressure_message(boot_ms(t), static, differential, whole(celsius * 100, I16))


def vibration(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """VIBRATION at ``t`` [s] of aircraft: RMS of the specific force's vibration [m/s^2, sensor axes]; see ``vibration.py``."""
    if facts.is_ground or latest.fresh(latest.imu) is None:
        return None
    x, y, z = latest.vibration.level.tolist()
    return mav.MAVLink_vibration_message(whole(t * 1e6, (0, 2**63)), x, y, z, latest.vibration.clipped, 0, 0)


def servo_output(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """SERVO_OUTPUT_RAW [us] at ``t`` [s]: aileron, elevator, throttle, rudder, flap, brake; else wheels, then steering."""
    pulses: list[int] = []
    if (surfaces := latest.fresh(latest.surface_command)) is not None:
        pulses = _surfaces(facts, surfaces)
    elif (wheels := latest.fresh(latest.wheel_command)) is not None:
        pulses = _wheels(facts, wheels)
    if not pulses:
        return None
    return mav.MAVLink_servo_output_raw_message(round(t * 1e6) % 2**32, 0, *pulses, *(UNUSED,) * (OUTPUTS - len(pulses)))


def _surfaces(facts: VehicleInfo, asked: SurfaceCommand) -> list[int]:
    if facts.file.air is None:
        return []
    limits = facts.file.air.controls
    around = {name: getattr(limits, name).norm(getattr(asked, name)) for name in ("aileron", "elevator", "rudder")}
    up = {"throttle": asked.throttle, "flap": limits.flap.norm(asked.flap), "brake": asked.brake}
    parts = {**around, **{name: 2 * part - 1 for name, part in up.items()}}
    return [_pulse(parts[name]) for name in ("aileron", "elevator", "throttle", "rudder", "flap", "brake")]


def _wheels(facts: VehicleInfo, asked: WheelCommand) -> list[int]:
    if facts.file.ground is None:
        return []
    drive = facts.file.ground.drive
    parts = [speed * drive.wheel_radius / facts.file.ground.max_linear for speed in speeds_of(asked)]
    if isinstance(drive, AckermannFile):
        parts.append(-asked.steering / drive.max_steering)
    return [_pulse(part) for part in parts[:OUTPUTS]]


def _pulse(part: float) -> int:
    """us; part: -1..1."""
    return whole(CENTRE + HALF * part, (1000, 2000), round(CENTRE))
