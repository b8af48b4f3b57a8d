"""Sensor samples as messages."""

from schemas.convert import quaternion, stamp, vector
from schemas.messages import AirData, Battery, JointState, JointStates, NavState
from services.sim_air import sensors
from services.sim_air.airframe import Air, Controls, Motion
from uvf.maths.rotations import Floats


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
