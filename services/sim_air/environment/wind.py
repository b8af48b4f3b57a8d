"""The moving air about one aircraft: mean wind with shear, single gusts and turbulence."""

import math
from typing import NamedTuple

import numpy as np

from uvf.maths.atmosphere import logarithmic, one_minus_cosine, power
from uvf.maths.dryden import Turbulence, strength
from uvf.maths.rotations import Floats
from uvf.models.world.wind import Gust, Shear, Wind

CALM = np.zeros(3)
STILL = 1.0  # m/s through the air, below which turning air is left out: the engine divides by the airspeed of the step before


class AirRelativeState(NamedTuple):
    """The state of the aircraft that the wind model depends on."""

    position: Floats  # (3,) m, world
    height: float  # m above the ground
    yaw: float  # rad, of the nose, world
    airspeed: float  # m/s


class AirMotion(NamedTuple):
    """Motion of the air. velocity: (3,) [m/s, world]; rates: (3,) [rad/s], rotation about the aircraft's forward, right and down axes."""

    velocity: Floats
    rates: Floats


class AirMass:
    """The air about one aircraft; ``step`` is called once a physics step."""

    def __init__(self, wind: Wind, span: float, rng: np.random.Generator) -> None:
        """span: of the wing, m."""
        self._wind = wind
        self._steady = np.array(wind.steady)
        self._changes = list(wind.changes)
        self._begins = wind.begins
        self._t = 0.0
        self._turbulence = Turbulence(span, rng) if wind.turbulence else None
        self._yaw: float | None = None  # rad, of the last step
        self._entered = [0.0] * len(wind.gusts)  # m of air flown since the beginning of each gust that has a time
        self.is_steady = not (wind.shear or wind.begins or wind.changes or wind.gusts or wind.turbulence)

    def blow(self, steady: Floats) -> None:
        """Takes another mean wind (3,) [m/s, world], without shear, which stays."""
        self._steady, self._changes, self._begins = steady, [], None

    def mean(self, height: float) -> Floats:
        """Mean wind (3,) [m/s, world] at ``height`` [m above the ground] in the last step, without gusts."""
        shear, steady = self._wind.shear, self._begun(height) * self._steady_now()
        return steady if shear is None else steady * _growth(shear, height)

    def _begun(self, height: float) -> float:
        """Share of the wind that blows by now at this height, 0 to 1."""
        if (begins := self._begins) is None:
            return 1.0
        return _risen(self._t - begins.time, begins.over) * _risen(height - begins.height, begins.layer)

    def _steady_now(self) -> Floats:
        steady = self._steady
        for change in self._changes:
            steady = steady + _risen(self._t - change.at, change.over) * (np.array(change.steady) - steady)
        return steady

    def step(self, t: float, dt: float, flight: AirRelativeState) -> AirMotion:
        """Motion of the air at the aircraft at ``t`` [s], ``dt`` [s] after the step before."""
        self._t = t
        velocity, rates, begun = self.mean(flight.height), CALM, self._begun(flight.height)
        for i, gust in enumerate(self._wind.gusts):
            velocity = velocity + self._share(i, gust, t, flight.airspeed * dt, flight) * begun * np.array(gust.velocity)
        if self._turbulence is not None and self._wind.turbulence is not None:
            data = self._wind.turbulence
            self._turbulence.turn(flight.yaw - (flight.yaw if self._yaw is None else self._yaw))
            self._yaw = flight.yaw
            g = self._turbulence.step(flight.airspeed * dt, dt, strength(flight.height, data.at_20_feet, data.severity))
            c, s = math.cos(flight.yaw), math.sin(flight.yaw)
            velocity = velocity + begun * np.array((c * g.u + s * g.v, s * g.u - c * g.v, -g.w))
            rates = begun * np.array((g.p, g.q, g.r)) if flight.airspeed > STILL else CALM
        return AirMotion(velocity, rates)

    def _share(self, i: int, gust: Gust, t: float, flown: float, flight: AirRelativeState) -> float:
        if gust.place is not None:
            away = float(np.hypot(flight.position[0] - gust.place[0], flight.position[1] - gust.place[1]))
            return one_minus_cosine(gust.length / 2 - away, gust.length)
        if gust.time is None or t < gust.time:
            return 0.0
        self._entered[i] += flown
        return one_minus_cosine(self._entered[i], gust.length)


def _risen(beyond: float, over: float) -> float:
    """0 up to where something begins, 1 from ``over`` beyond that on, straight between."""
    return min(max(beyond / over, 0.0), 1.0) if over > 0 else float(beyond >= 0)


def _growth(shear: Shear, height: float) -> float:
    if shear.law == "power":
        return power(height, shear.exponent, shear.height)
    return logarithmic(height, shear.roughness, shear.height)
