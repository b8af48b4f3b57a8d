"""Trim: the attitude and controls for which steady flight, level, climbing or turning, does not accelerate."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares, root

from services.sim_air.engine.wiring import Controls
from uvf.maths import rotations

Floats = NDArray[np.float64]

G = 9.80665  # m/s^2
IDLE = 1e-6  # weight at which what has no effect is drawn to zero
STEP = 1e-3
TOLERANCE = 1e-4  # m/s^2 and rad/s^2
NEARLY = 1e-3  # of the same, with an engine that is never quite steady
THROTTLES = (0.5, 0.9, 0.75)
"""Tried one after the other: below the rise of its power a propeller at fixed speed brakes the more the wider the throttle, and of a
piston engine with a fixed mixture the power may be the same at two throttles, one of them beyond the stop."""
GLIDES = (0.05,)  # rad
MOST_TRIES = 60
FARTHEST = 1.6  # rad


@dataclass(frozen=True)
class Trim:
    """Angles [rad], deflections [rad], throttle 0..1, and what acceleration is left over.

    slip: the nose left of the course; glide: the course below the path asked for.
    """

    alpha: float
    roll: float
    aileron: float
    elevator: float
    rudder: float
    throttle: float
    residual: float = np.inf
    slip: float = 0.0
    glide: float = 0.0

    @property
    def converged(self) -> bool:
        """Whether nothing accelerates, nearly, and the throttle is within 0..1."""
        return self.residual < NEARLY and 0 <= self.throttle <= 1

    @property
    def lacks(self) -> str:
        """Why it is no trim."""
        if self.residual >= NEARLY:
            return f"{self.residual:.2g} m/s^2 or rad/s^2 are left"
        return f"that needs {self.throttle:.2f} of the throttle; try another speed"

    @property
    def controls(self) -> Controls:
        """The controls of the trim."""
        return Controls(self.aileron, self.elevator, self.rudder, self.throttle)


@dataclass(frozen=True)
class FlightPath:
    """Steady flight: airspeed [m/s], climb [rad] up from the horizon, turn [rad/s] to the right; through air at rest."""

    airspeed: float
    climb: float = 0.0
    turn: float = 0.0

    @property
    def bank(self) -> float:
        """Bank [rad] of a coordinated turn: tan(phi) = V cos(gamma) chi_dot / g (Beard & McLain, equation 9.11)."""
        return float(np.arctan(self.airspeed * np.cos(self.climb) * self.turn / G))


@dataclass(frozen=True)
class TrimAttitude:
    """Angles [rad] from axes of which x is the course over the air and z down, and the rates [rad/s] of the body, FRD."""

    roll: float
    pitch: float
    yaw: float
    rates: tuple[float, float, float]


def attitude(path: FlightPath, trim: Trim) -> TrimAttitude:
    """Attitude of the body on the path. In straight flight the nose is on the course; in a turn there is no side slip."""
    climb = path.climb - trim.glide
    if path.turn == 0:
        return TrimAttitude(trim.roll, trim.alpha + climb, -trim.slip, (0.0, 0.0, 0.0))
    pitch = _pitch(climb, trim.alpha, trim.roll)
    forward = np.array((np.cos(trim.alpha), 0.0, np.sin(trim.alpha)))
    north, east, _ = rotations.matrix(rotations.from_euler(trim.roll, pitch, 0.0)) @ forward
    rates = path.turn * np.array((-np.sin(pitch), np.sin(trim.roll) * np.cos(pitch), np.cos(trim.roll) * np.cos(pitch)))
    return TrimAttitude(trim.roll, pitch, -float(np.arctan2(east, north)) - trim.slip, tuple(rates.tolist()))


def _pitch(climb: float, alpha: float, roll: float) -> float:
    """Rate-of-climb constraint without side slip (Stevens, Lewis and Johnson, Aircraft Control and Simulation, equation 3.6-2)."""
    a, b, up = np.cos(alpha), np.cos(roll) * np.sin(alpha), np.sin(climb)
    return float(np.arctan2(a * b + up * np.sqrt(a**2 - up**2 + b**2), a**2 - up**2))


def solve(accelerations: Callable[[Trim], Floats], bank: float = 0.0, powered: bool = True) -> Trim:
    """Finds the six unknowns for which the six body accelerations (6,) [m/s^2, rad/s^2] vanish, starting at ``bank`` [rad].

    Without an engine an angle below the path asked for takes the throttle's place. An aircraft without one of the surfaces flies with
    side slip, and controls without effect stay where they are.
    """
    last = THROTTLES if powered else GLIDES
    beyond: Trim | None = None
    for first in last:
        trim = _direct(accelerations, np.array((0.05, bank, 0.0, -0.1, 0.0, first)), powered)
        if trim.residual < TOLERANCE:
            if 0 <= trim.throttle <= 1:
                return trim
            beyond = beyond or trim
    return beyond or _with_slip(accelerations, np.array((0.05, bank, 0.0, 0.0, 0.0, last[0], 0.0)), powered)


def _direct(accelerations: Callable[[Trim], Floats], guess: Floats, powered: bool) -> Trim:
    """Without side slip."""
    options = {"eps": 1e-6, "xtol": 1e-10, "maxfev": MOST_TRIES}
    found = root(lambda x: accelerations(_trim(x, powered)), guess, method="hybr", options=options)
    sane = np.abs(found.x[:5]).max() < FARTHEST  # what has no effect may have gone anywhere
    return replace(_trim(found.x, powered), residual=float(np.abs(found.fun).max()) if sane else np.inf)


def _with_slip(accelerations: Callable[[Trim], Floats], guess: Floats, powered: bool) -> Trim:
    """Seven unknowns within what they can be, the slopes over steps wide enough for an engine that is not quite steady."""
    bounds = ([-0.6, -1.4, -1.5, -1.5, -1.5, 0.0, -0.5], [0.6, 1.4, 1.5, 1.5, 1.5, 1.0, 0.5])

    def left(x: Floats) -> Floats:
        return np.concatenate((accelerations(replace(_trim(x[:6], powered), slip=float(x[6]))), IDLE * x))

    def slopes(x: Floats) -> Floats:
        return np.column_stack([(left(x + step) - left(x - step)) / (2 * STEP) for step in STEP * np.eye(len(x))])

    found = least_squares(left, guess, slopes, bounds=bounds, xtol=1e-12, ftol=1e-14, gtol=1e-14, max_nfev=30)
    return replace(_trim(found.x[:6], powered), residual=float(np.abs(found.fun[:6]).max()), slip=float(found.x[6]))


def _trim(unknowns: Floats, powered: bool) -> Trim:
    alpha, roll, aileron, elevator, rudder, last = unknowns.tolist()
    return Trim(alpha, roll, aileron, elevator, rudder, last if powered else 0.0, glide=0.0 if powered else last)
