"""Steady straight flight with any two of its figures given, and the derivatives about it: after Beard and McLain, section 5.3.

Servos stand where they are commanded and engine and propeller turn as they would after a while (quasi-steady).
"""

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from scipy.optimize import root

from services.sim_air.engine.states import Held
from services.sim_air.engine.trim import Trim, solve
from services.sim_air.engine.wiring import Controls
from uvf.maths import rotations
from uvf.maths.rotations import Floats

STATES = ("u", "v", "w", "p", "q", "r", "phi", "theta", "psi", "h")
INPUTS = ("delta_a", "delta_e", "delta_r", "delta_t")
TOLERANCE = 1e-4  # m/s^2 and rad/s^2
UNKNOWN = ("airspeed", "alpha", "climb", "roll", "aileron", "elevator", "rudder", "throttle")


class FlightModel(Protocol):
    """What is held in a state: ``airframe.Airframe`` or a test's own."""

    def accelerations_held(self, held: Held, controls: Controls) -> Floats: ...

    @property
    def powered(self) -> bool: ...


@dataclass(frozen=True)
class Condition:
    """Straight flight; angles [rad], ``climb`` up from the horizon, ``alpha`` of the path in the plane of symmetry."""

    airspeed: float  # m/s
    altitude: float  # m AMSL
    climb: float = 0.0
    alpha: float = 0.05
    roll: float = 0.0
    aileron: float = 0.0
    elevator: float = -0.1
    rudder: float = 0.0
    throttle: float = 0.5
    slip: float = 0.0  # the nose left of the path

    @property
    def state(self) -> Floats:
        """(10,) in the order of STATES, northward."""
        angles = (self.roll, self.alpha + self.climb, -self.slip)
        path = self.airspeed * np.array((np.cos(self.climb), 0.0, -np.sin(self.climb)))  # NED
        u, v, w = rotations.matrix(rotations.from_euler(*angles)).T @ path
        return np.array((u, v, w, 0.0, 0.0, 0.0, *angles, self.altitude))

    @property
    def inputs(self) -> Floats:
        """(4,) in the order of INPUTS."""
        return np.array((self.aileron, self.elevator, self.rudder, self.throttle))


def derivatives(body: FlightModel, state: Floats, inputs: Floats) -> Floats:
    """(10,) d/dt of the state: the body's own accelerations and the kinematics (equations 3.14 to 3.16 of the book)."""
    velocity, rates, (phi, theta, _) = state[:3], state[3:6], state[6:9]
    accelerations = body.accelerations_held(Held(velocity, rates, state[6:9], float(state[9])), Controls(*inputs.tolist()))
    p, q, r = rates
    sideways = q * np.sin(phi) + r * np.cos(phi)
    turning = (p + sideways * np.tan(theta), q * np.cos(phi) - r * np.sin(phi), sideways / np.cos(theta))
    up = -(rotations.matrix(rotations.from_euler(*state[6:9])) @ velocity)[2]
    return np.array((*accelerations, *turning, up))


def level(body: FlightModel, airspeed: float, altitude: float) -> Condition | None:
    """Level flight by the simulator's own trim, of a glider its glide; with side slip where a surface is missing; None: there is none."""

    def flown(trim: Trim) -> Condition:
        c = trim.controls
        return Condition(airspeed, altitude, -trim.glide, trim.alpha, trim.roll, c.aileron, c.elevator, c.rudder, c.throttle, trim.slip)

    trim = solve(lambda guess: derivatives(body, flown(guess).state, flown(guess).inputs)[:6], powered=body.powered)
    return flown(trim) if trim.converged else None


def find(body: FlightModel, given: Condition, fixed: tuple[str, str]) -> Condition | None:
    """The six other figures of UNKNOWN for which nothing accelerates, beginning at ``given``; None when there are none."""
    free = [name for name in UNKNOWN if name not in fixed]

    def left(values: Floats) -> Floats:
        tried = replace(given, **dict(zip(free, values.tolist(), strict=True)))
        return derivatives(body, tried.state, tried.inputs)[:6]

    found = root(left, [getattr(given, name) for name in free], method="hybr", options={"eps": 1e-6, "xtol": 1e-10})
    if np.abs(found.fun).max() > TOLERANCE:
        return None
    return replace(given, **dict(zip(free, found.x.tolist(), strict=True)))
