"""Sensor samples as messages."""

from schemas.convert import quaternion, stamp, vector
from schemas.messages import AirData, Battery, Gnss, Imu, JointState, JointStates, NavState
from services.sim_air import sensors
from services.sim_air.airframe import Air, Controls, Motion
from uvf.maths.instruments import Fix, ImuReading
from uvf.maths.rotations import Floats
from uvf.runtime.vehicle_file import GnssSensor

SATELLITES = 14  # seen under an open sky


def imu(frame: str, sample: ImuReading) -> Imu:
    return Imu(
        timestamp=stamp(sample.t),
        frame_id=frame,
        angular_velocity=vector(sample.angular_velocity),
        specific_force=vector(sample.specific_force),
        magnetic_field=vector(sample.magnetic_field),
    )


def gnss(fix: Fix, data: GnssSensor) -> Gnss:
    """Its timestamp is the moment the fix is valid for."""
    horizontal, vertical = data.accuracy
    return Gnss(
        timestamp=stamp(fix.t),
        fix=Gnss.FIX_3D,
        latitude=fix.latitude,
        longitude=fix.longitude,
        altitude=fix.altitude,
        velocity_enu=vector(fix.velocity),
        horizontal_accuracy=horizontal,
        vertical_accuracy=vertical,
        speed_accuracy=data.speed_noise,
        satellites=SATELLITES,
    )


def air_data(t: float, air: Air) -> AirData:
    return AirData(
        timestamp=stamp(t),
        static_pressure=air.static_pressure,
        differential_pressure=air.differential_pressure,
        temperature=air.temperature,
    )


def battery(t: float, charge: sensors.Charge) -> Battery:
    return Battery(timestamp=stamp(t), voltage=charge.voltage, current=charge.current, remaining=charge.remaining)


def joints(t: float, controls: Controls, propeller_speed: float) -> JointStates:
    """Surfaces [rad] and the propeller [rad/s]."""
    return JointStates(
        timestamp=stamp(t),
        joints=[
            JointState(name="aileron", position=controls.aileron),
            JointState(name="elevator", position=controls.elevator),
            JointState(name="rudder", position=controls.rudder),
            JointState(name="propeller", velocity=propeller_speed, effort=controls.throttle),
        ],
    )


def nav_state(t: float, motion: Motion, wind: Floats) -> NavState:
    return NavState(
        timestamp=stamp(t),
        position=vector(motion.position),
        velocity=vector(motion.velocity),
        orientation=quaternion(motion.world_from_body),
        angular_velocity=vector(motion.angular_velocity),
        airspeed=motion.airspeed,
        wind=vector(wind),
    )
