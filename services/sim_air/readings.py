"""Sensor samples as messages."""

from schemas.messages import AirData, Event, JointState, JointStates, NavState
from services.sim_air.engine.states import Air, AircraftMotion
from services.sim_air.engine.wiring import JointAngle
from uvf.maths.rotations import Floats
from uvf.runtime.messages.convert import quaternion, stamp, vector


def air_data(t: float, air: Air) -> AirData:
    """Pressures [Pa] and temperature [K] as a message stamped ``t`` [s]."""
    return AirData(
        timestamp=stamp(t),
        static_pressure=air.static_pressure,
        differential_pressure=air.differential_pressure,
        temperature=air.temperature,
    )


def joints(t: float, angles: list[JointAngle], throttle: float) -> JointStates:
    """Angles of the surfaces [rad] and speeds [rad/s] as a message stamped ``t`` [s], with the throttle [0..1] as effort."""
    states = [JointState(name=a.name, position=a.position, velocity=a.speed, effort=throttle if a.speed else 0.0) for a in angles]
    return JointStates(timestamp=stamp(t), joints=states)


def crashed(t: float, reason: str) -> Event:
    """The event at ``t`` [s] that reports a crash."""
    return Event(timestamp=stamp(t), severity=Event.CRITICAL, text="crashed", cause=reason, source="sim_air")


def nav_state(t: float, motion: AircraftMotion, wind: Floats) -> NavState:
    """True motion and ``wind`` (3,) [m/s, world] as a message stamped ``t`` [s]."""
    return NavState(
        timestamp=stamp(t),
        position=vector(motion.position),
        velocity=vector(motion.velocity),
        orientation=quaternion(motion.world_from_body),
        angular_velocity=vector(motion.angular_velocity),
        airspeed=motion.airspeed,
        wind=vector(wind),
    )
