"""What an aircraft does, begins with or is held at, in SI units."""

from dataclasses import dataclass, field

import numpy as np

from services.sim_air.engine.trim import FlightPath
from uvf.maths.rotations import Floats


class Runaway(Exception):
    """The engine's numbers grow beyond all bounds."""


@dataclass(frozen=True)
class AircraftMotion:
    """True motion. World frame ENU, body frame FLU."""

    position: Floats  # (3,) m
    velocity: Floats  # (3,) m/s over ground
    world_from_body: Floats  # (4,) wxyz
    angular_velocity: Floats  # (3,) rad/s, body
    specific_force: Floats  # (3,) m/s^2, body, of the centre of gravity
    airspeed: float  # m/s
    angular_acceleration: Floats = field(default_factory=lambda: np.zeros(3))  # (3,) rad/s^2, body


@dataclass(frozen=True)
class Air:
    """The air about the aircraft."""

    static_pressure: float  # Pa
    differential_pressure: float  # Pa, of the pitot tube
    temperature: float  # K


@dataclass(frozen=True)
class InitialState:
    """Steady flight at ``airspeed`` [m/s] from ``position`` [m, world] towards ``yaw`` [rad, world] in a steady ``wind`` [m/s, world].

    climb: rad, up from the horizon, through the air; turn_rate: rad/s, to the left.
    """

    position: Floats
    yaw: float
    airspeed: float
    wind: Floats
    climb: float = 0.0
    turn_rate: float = 0.0

    @property
    def path(self) -> FlightPath:
        """The steady flight path through the air."""
        return FlightPath(self.airspeed, self.climb, -self.turn_rate)

    @property
    def velocity(self) -> Floats:
        """Velocity over ground (3,) [m/s, world]."""
        level = np.cos(self.climb)
        return self.airspeed * np.array((level * np.cos(self.yaw), level * np.sin(self.yaw), np.sin(self.climb))) + self.wind


@dataclass(frozen=True)
class Held:
    """A state in calm air, in the axes of Beard & McLain: body FRD, angles from NED."""

    velocity: Floats  # (3,) u, v, w m/s
    rates: Floats  # (3,) p, q, r rad/s
    angles: Floats  # (3,) roll, pitch, heading rad
    altitude: float  # m AMSL
