"""When a touch of the ground is a crash, and what is left then."""

import itertools
import math
from dataclasses import replace
from typing import Self

import numpy as np

from services.sim_air.engine.contacts import GroundTouch
from services.sim_air.engine.states import Air, AircraftMotion
from services.sim_air.engine.wiring import JointAngle
from services.sim_air.environment.ground import GroundSurface
from uvf.maths import rotations
from uvf.maths.bvh import Bvh
from uvf.maths.geodesy import GRAVITY
from uvf.maths.rotations import Floats

UP = np.array((0.0, 0.0, 1.0))
DOWN = -UP
FALLING = 25.0  # m/s, that wreckage comes to: 10 kg with 0.25 m^2 of drag area
TUMBLING = 2.0  # s, in which it loses 63 % of its turning
DENSITY = 1.2  # kg/m^3, of the air it falls through
SCRAPE = 1.0  # m/s over the ground, below which a part of the structure may rest on it
STEEPEST = math.radians(45.0)  # of the wings or the nose while a wheel is on the ground


def crash_of(touches: list[GroundTouch], motion: AircraftMotion, max_sink: float) -> str:
    """What touched the ground and how fast, when that was more than a landing; "" = no crash.

    A part of the structure moving over the ground, a wheel or skid sinking faster than ``max_sink`` [m/s], or an attitude on the ground in
    which nobody lands.
    """
    speed = float(np.linalg.norm(motion.velocity))
    moving = speed + float(np.linalg.norm(motion.angular_velocity))  # of a point within a metre
    for touch in touches:
        if not touch.carries and speed > SCRAPE:
            return f"{touch.name} touched the ground at {speed:.1f} m/s"
        if touch.speed > max_sink and moving > SCRAPE:  # in its first step the engine may tell of a wheel's speed that is none
            return f"{touch.name} hit the ground sinking at {touch.speed:.1f} m/s; it bears {max_sink:g} m/s"
    roll, pitch, _ = rotations.to_euler(motion.world_from_body)
    if touches and max(abs(roll), abs(pitch)) > STEEPEST:
        banked, pitched = math.degrees(roll), -math.degrees(pitch)
        return f"{touches[0].name} on the ground at {speed:.1f} m/s, banked {banked:.0f} and pitched {pitched:.0f} deg"
    return ""


class Resting:
    """How a wreck comes to rest: a corner of its bounding box on the ground."""

    def __init__(self, ground: GroundSurface, shape: Bvh) -> None:
        self._ground = ground
        low, high = shape.bounds[0, :3], shape.bounds[0, 3:]
        self._corners = np.array([np.where(side, high, low) for side in itertools.product((False, True), repeat=3)])

    def above(self, position: Floats, world_from_body: Floats) -> float:
        """Distance [m] between the lowest corner at ``position`` (3,) [m, world], ``world_from_body`` (4,) wxyz, and the ground below.

        Negative when the corner is in the ground.
        """
        lowest = float((self._corners @ rotations.matrix(world_from_body).T)[:, 2].min())
        return float(position[2]) + lowest - self._ground.under(position)

    def __deepcopy__(self, memo: dict[int, object]) -> Self:
        return self


class Wreck:
    """A wreck, motor off: it falls tumbling, with drag, until it lies."""

    def __init__(self, motion: AircraftMotion, air: Air, joints: list[JointAngle], rests: Resting | None = None) -> None:
        """rests: without one it stays where it is."""
        self._rests = rests
        self._ground_level = air.static_pressure + DENSITY * GRAVITY * float(motion.position[2])
        self.motion = replace(motion, airspeed=float(np.linalg.norm(motion.velocity)))
        self.air = replace(air, differential_pressure=0.0)
        self.joints = [joint._replace(speed=0.0) for joint in joints]
        if rests is None:
            self._lie(motion.position)

    def fall(self, dt: float) -> None:
        """One step of ``dt`` [s]: quadratic drag, which balances the weight at FALLING."""
        if self._rests is None:
            return
        was = self.motion
        pull = -GRAVITY / FALLING**2 * float(np.linalg.norm(was.velocity)) * was.velocity
        velocity = was.velocity + (pull + DOWN * GRAVITY) * dt
        position = was.position + velocity * dt
        turned = rotations.multiply(was.world_from_body, _turn(was.angular_velocity * dt))
        force = rotations.matrix(turned).T @ pull
        speed, turning = float(np.linalg.norm(velocity)), was.angular_velocity * math.exp(-dt / TUMBLING)
        self.motion = replace(was, position=position, velocity=velocity, world_from_body=turned, airspeed=speed, specific_force=force)
        self.motion = replace(self.motion, angular_velocity=turning)
        self.air = replace(self.air, static_pressure=self._ground_level - DENSITY * GRAVITY * float(position[2]))
        if (above := self._rests.above(position, turned)) <= 0.0:
            self._lie(position - above * UP)
            self._rests = None

    def _lie(self, position: Floats) -> None:
        still = np.zeros(3)
        weight = rotations.matrix(self.motion.world_from_body).T @ UP * GRAVITY
        self.motion = replace(self.motion, position=position, velocity=still, angular_velocity=still, specific_force=weight, airspeed=0.0)


def _turn(angles: Floats) -> Floats:
    """wxyz of a small turn by (3,) rad."""
    angle = float(np.linalg.norm(angles))
    return rotations.from_axis(angles / angle, angle) if angle > 0 else rotations.IDENTITY
