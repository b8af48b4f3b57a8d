"""An aircraft as a point with the Aerosonde's lift, drag and thrust on paper; pitch and bank follow what is asked with a lag."""

import math
from dataclasses import dataclass

from tests import aerosonde
from tests.services.autopilot.air.states import cruising
from uvf.control.commands import AltitudeAirspeedSetpoint
from uvf.control.cycle import Cycle
from uvf.control.total_energy import EnergyLoops
from uvf.maths.atmosphere import RHO0
from uvf.models.vehicle.flight_params import AirParams

G = 9.80665
DT = 0.02  # s
PITCH_LAG, BANK_LAG = 0.4, 0.4  # s
PARAMS = AirParams(
    trim_throttle=0.78,
    alpha_zero_lift=-0.0442,
    alpha_per_load=6.22,
    throttle_climb=0.036,
    throttle_load=0.011,
    throttle_speed=0.028,
    alpha_max=0.193,
)


@dataclass
class Point:
    """In level cruise; ``engine``: share of the thrust that is left."""

    height: float = 100.0
    speed: float = 25.0  # m/s, inertial, along the path
    path: float = 0.0  # rad
    pitch: float = 0.0537
    bank: float = 0.0
    engine: float = 1.0
    lift: float = G  # m/s^2

    def estimate(self, gust: tuple[float, float] = (0.0, 0.0)):
        climb = self.speed * math.sin(self.path)
        felt = {"roll": self.bank, "pitch": self.pitch, "lift": self.lift}
        return cruising(height=self.height, climb=climb, airspeed=self.speed + gust[0], **felt)

    def step(self, asked: tuple[float, float, float], gust: tuple[float, float] = (0.0, 0.0)) -> None:
        """asked: bank, pitch, throttle; gust: m/s, from ahead and from below."""
        bank, pitch, throttle = asked
        self.bank += DT / BANK_LAG * (bank - self.bank)
        self.pitch += DT / PITCH_LAG * (pitch - self.pitch)
        air = self.speed + gust[0]
        alpha = (self.pitch - self.path) / max(math.cos(self.bank), 0.3) + gust[1] / air
        pressed = 0.5 * RHO0 * air**2 * aerosonde.S / aerosonde.M
        cl, cd, _ = aerosonde.balanced(alpha)
        self.lift = pressed * cl
        pull = self.engine * aerosonde.thrust(air, max(throttle, 0.05), RHO0) / aerosonde.M
        self.height += self.speed * math.sin(self.path) * DT
        self.speed += (pull - pressed * cd - G * math.sin(self.path)) * DT
        self.path += (self.lift * math.cos(self.bank) - G * math.cos(self.path)) / self.speed * DT


def fly(point, wanted_at, seconds, params=PARAMS, gust_at=lambda k: (0.0, 0.0), loops=None):
    """Flies by the energy loops, unless others are given; wanted_at(t): Wanted. The estimate, pitch and throttle of every cycle."""
    loops, seen = loops or EnergyLoops(), []
    for k in range(round(seconds / DT)):
        now = point.estimate(gust_at(k))
        wanted = wanted_at(k * DT)
        pitch, throttle = loops.step(Cycle(now, params, DT), wanted)
        seen.append((now, pitch, throttle))
        point.step((wanted.bank, pitch, throttle), gust_at(k))
    return seen


def cruise(bank=0.0, height=100.0, airspeed=25.0):
    return lambda t: AltitudeAirspeedSetpoint(bank, height, 0.0, airspeed)
