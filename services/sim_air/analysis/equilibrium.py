"""Steady straight flight with any two of its figures given, and the derivatives about it: after Beard and McLain, section 5.3.

Servos stand where they are commanded and engine and propeller turn as they would after a while (quasi-steady).
"""

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from scipy.optimize import root

from services.sim_air.engine.states import Held
from services.sim_air.engine.trim import NEARLY, Trim, solve
from services.sim_air.engine.wiring import Controls
from uvf.maths import rotations
from uvf.maths.rotations import Floats

STATES = ("u", "v", "w", "p", "q", "r", "phi", "theta", "psi", "h")
INPUTS = ("delta_a", "delta_e", "delta_r", "delta_t")
UNKNOWN = ("airspeed", "alpha", "climb", "roll", "aileron", "elevator", "rudder", "throttle")


class FlightModel(Protocol):
    """Flight dynamics held in a state: ``airframe.Airframe`` or a test's own."""

    def accelerations_held(self, held: Held, controls: Controls) -> Floats:
        """Derivatives (6,) of u, v, w [m/s^2] and p, q, r [rad/s^2], FRD, in the held state."""
        ...

    @property
    def powered(self) -> bool:
        """Whether it has an engine."""
        ...


@dataclass(frozen=True)
class Condition:
    """Steady straight flight; angles and deflections [rad], throttle 0..1.

    ``climb`` is up from the horizon, ``alpha`` the angle of attack in the plane of symmetry.
    """

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
        """State (10,) in the order of STATES [m/s, rad/s, rad, m AMSL], heading north but for the slip."""
        angles = (self.roll, self.alpha + self.climb, -self.slip)
        path = self.airspeed * np.array((np.cos(self.climb), 0.0, -np.sin(self.climb)))  # NED
        u, v, w = rotations.matrix(rotations.from_euler(*angles)).T @ path
        return np.array((u, v, w, 0.0, 0.0, 0.0, *angles, self.altitude))

    @property
    def inputs(self) -> Floats:
        """Inputs (4,) in the order of INPUTS [rad, throttle 0..1]."""
        return np.array((self.aileron, self.elevator, self.rudder, self.throttle))


def derivatives(body: FlightModel, state: Floats, inputs: Floats) -> Floats:
    """Time derivatives (10,) of the state (10,), in its units per second, at inputs (4,) [rad, 0..1].

    The body's own accelerations and the kinematics (Beard & McLain, equations 3.14 to 3.16).
    """
    velocity, rates, (phi, theta, _) = state[:3], state[3:6], state[6:9]
    accelerations = body.accelerations_held(Held(velocity, rates, state[6:9], float(state[9])), Controls(*inputs.tolist()))
    p, q, r = rates
    sideways = q * np.sin(phi) + r * np.cos(phi)
    turning = (p + sideways * np.tan(theta), q * np.cos(phi) - r * np.sin(phi), sideways / np.cos(theta))
    up = -(rotations.matrix(rotations.from_euler(*state[6:9])) @ velocity)[2]
    return np.array((*accelerations, *turning, up))


def level(body: FlightModel, airspeed: float, altitude: float) -> Condition | None:
    """Level flight at ``airspeed`` [m/s] and ``altitude`` [m AMSL] by the simulator's own trim; None when there is none.

    A glider's is its glide; where a surface is missing it has side slip.
    """

    def flown(trim: Trim) -> Condition:
        c = trim.controls
        return Condition(airspeed, altitude, -trim.glide, trim.alpha, trim.roll, c.aileron, c.elevator, c.rudder, c.throttle, trim.slip)

    trim = solve(lambda guess: derivatives(body, flown(guess).state, flown(guess).inputs)[:6], powered=body.powered)
    return flown(trim) if trim.converged else None


def find(body: FlightModel, given: Condition, fixed: tuple[str, str]) -> Condition | None:
    """The equilibrium near ``given`` with two of the figures of UNKNOWN fixed; None when none is found."""
    free = [name for name in UNKNOWN if name not in fixed]

    def left(values: Floats) -> Floats:
        tried = replace(given, **dict(zip(free, values.tolist(), strict=True)))
        return derivatives(body, tried.state, tried.inputs)[:6]

    found = root(left, [getattr(given, name) for name in free], method="hybr", options={"eps": 1e-6, "xtol": 1e-10})
    if np.abs(found.fun).max() > NEARLY:
        return None
    return replace(given, **dict(zip(free, found.x.tolist(), strict=True)))
