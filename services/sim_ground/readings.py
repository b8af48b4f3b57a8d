"""Readings as messages."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.messages import Contact, JointState, JointStates, NavState, WheelTicks
from services.sim_ground.body import BodyState, Touch
from services.sim_ground.encoders import radians_per_tick, ticks
from uvf.models.vehicle.file import GroundBody
from uvf.models.vehicle.sensors import Bumper, Encoders
from uvf.runtime.messages.convert import quaternion, stamp, vector
from uvf.runtime.messages.wheels import wheel_ticks

Floats = NDArray[np.float64]


def wheels_message(t: float, encoders: Encoders, channels: Sequence[int], body: BodyState) -> WheelTicks:
    """Encoder ticks as a message stamped ``t`` [s]."""
    return wheel_ticks(t, ticks(encoders, body.wheel_angles, channels), radians_per_tick(encoders))


def contact_message(t: float, bumpers: Sequence[Bumper], touches: Sequence[Touch]) -> Contact:
    """All contacts since the message before, stamped ``t`` [s]; the first one gives its name."""
    sectors = [b.name for b in bumpers if any(b.feels(touch.bearing) for touch in touches)]
    return Contact(timestamp=stamp(t), touching=bool(touches), other=touches[0].other if touches else "", sectors=sectors)


def joints_message(t: float, ground: GroundBody, body: BodyState) -> JointStates:
    """Positions and speeds of the joints that are measured, of those that steer positions alone, as a message stamped ``t`` [s]."""
    rows = zip(ground.drive.joints, body.wheel_angles, body.wheel_speeds, strict=True)
    joints = [JointState(name=name, position=angle, velocity=speed) for name, angle, speed in rows]
    joints += [JointState(name=name, position=angle) for name, angle in zip(ground.drive.steered_wheels, body.steered_to, strict=True)]
    others = zip((*ground.joints, *ground.springs), body.joints, strict=True)
    joints += [JointState(name=name, position=position, velocity=speed) for name, (position, speed) in others]
    return JointStates(timestamp=stamp(t), joints=joints)


def truth_message(t: float, body: BodyState) -> NavState:
    """True motion of base_link in the world frame as a message stamped ``t`` [s]."""
    return NavState(
        timestamp=stamp(t),
        position=vector(body.position),
        velocity=vector(body.velocity),
        orientation=quaternion(body.world_from_body),
        angular_velocity=vector(body.angular_velocity),
    )
