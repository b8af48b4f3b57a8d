"""What throws an aircraft into the air: a hand, a catapult, a bungee. A straight push along a line, at the end of which it flies."""

import math
from dataclasses import dataclass

import numpy as np

from services.sim_air.engine.gauges import pitot_share
from services.sim_air.engine.states import Air, AircraftMotion, InitialState
from services.sim_air.engine.trim import TrimAttitude
from services.sim_air.environment.wind import AirRelativeState
from uvf.maths import rotations
from uvf.maths.atmosphere import LAPSE, T0, density, pressure
from uvf.maths.geodesy import GRAVITY, LocalTangent
from uvf.maths.rotations import Floats
from uvf.models.mission.launch import Launch


@dataclass(frozen=True)
class Release:
    """Where and how an aircraft leaves the launcher; start: over the ground, as if in calm air."""

    start: InitialState
    lies: TrimAttitude


def standard_air(tangent: LocalTangent, position: Floats) -> Air:
    """The standard atmosphere at rest at ``position`` (3,) [m, world]."""
    altitude = float(tangent.geodetic(position)[2])
    return Air(pressure(altitude), 0.0, T0 - LAPSE * altitude)


class AircraftLauncher:
    """Holds one aircraft until it is ready, waits for the delay, and pushes it: evenly, or ever weaker, as a bungee does."""

    def __init__(self, launch: Launch, start: Floats, yaw: float, air: Air, rng: np.random.Generator) -> None:
        """start: (3,) m, world, where it is held; yaw: rad, world; air: there."""
        self._launch = launch
        self._start, self._yaw, self._still_air = start, yaw, air
        up, off = launch.elevation, launch.scatter * rng.standard_normal(3)
        self._along = np.array((math.cos(up) * math.cos(yaw), math.cos(up) * math.sin(yaw), math.sin(up)))
        self._off = off.tolist()
        self._waits, self._pushed = 0.0, 0.0  # s

    @property
    def _lasts(self) -> float:
        """s, of the push."""
        share = math.pi / 2 if self._launch.weakens else 2.0
        return share * self._launch.length / self._launch.speed

    def step(self, ready: bool, dt: float) -> Release | None:
        """One step of ``dt`` [s]; how the aircraft flies off when the push has ended. Once it pushes it does not stop."""
        self._waits = self._waits + dt if ready or self._pushed else 0.0
        if self._waits > self._launch.delay:
            self._pushed += dt
        if self._pushed < self._lasts:
            return None
        launch, (roll, pitch, yaw) = self._launch, self._off
        where = self._start + launch.length * self._along
        start = InitialState(where, self._yaw, launch.speed, np.zeros(3), launch.elevation)
        return Release(start, TrimAttitude(roll, launch.elevation + pitch, yaw, (0.0, 0.0, 0.0)))

    def motion(self, wind: Floats) -> AircraftMotion:
        """True motion now, in a wind (3,) [m/s, world]."""
        way, speed, faster = self._way()
        velocity, acceleration = speed * self._along, faster * self._along
        attitude = rotations.from_euler(0.0, -self._launch.elevation, self._yaw)
        force = rotations.matrix(attitude).T @ (acceleration + np.array((0.0, 0.0, GRAVITY)))
        airspeed = float(np.linalg.norm(velocity - wind))
        return AircraftMotion(self._start + way * self._along, velocity, attitude, np.zeros(3), force, airspeed)

    def flight(self, wind: Floats) -> AirRelativeState:
        """The state that the wind model depends on."""
        now = self.motion(wind)
        return AirRelativeState(now.position, self._launch.height + float(now.position[2] - self._start[2]), self._yaw, now.airspeed)

    def air(self, wind: Floats) -> Air:
        """The air about it, and what the pitot tube takes in of it."""
        still, through = self._still_air, self._way()[1] * self._along - wind
        airspeed = float(np.linalg.norm(through))
        share = pitot_share(float(through @ self._along), airspeed) if airspeed > 0 else 0.0
        rho = density(still.static_pressure, still.temperature)
        return Air(still.static_pressure, share * rho / 2 * airspeed**2, still.temperature)

    def _way(self) -> tuple[float, float, float]:
        """m, m/s and m/s^2 along the line."""
        launch, t = self._launch, min(self._pushed, self._lasts)
        if t == 0.0:
            return 0.0, 0.0, 0.0
        if launch.weakens:  # a spring
            rate = launch.speed / launch.length
            return launch.length * (1 - math.cos(rate * t)), launch.speed * math.sin(rate * t), launch.speed * rate * math.cos(rate * t)
        push = launch.speed**2 / (2 * launch.length)
        return push * t**2 / 2, push * t, push
