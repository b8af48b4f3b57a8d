"""Estimates to test with: level cruise north over the origin, changed where a test says so."""

import math
from dataclasses import replace

from uvf.estimation.state import Estimate
from uvf.guidance.vector_field import LateralGuidance
from uvf.maths.atmosphere import RHO0
from uvf.models.vehicle.flight_params import AirParams

PARAMS = AirParams()
G = 9.80665

CRUISE = Estimate(
    north=0.0,
    east=0.0,
    height=60.0,
    ground_speed=25.0,
    course=0.0,
    climb=0.0,
    roll=0.0,
    pitch=0.05,
    yaw=0.0,
    p=0.0,
    q=0.0,
    r=0.0,
    airspeed=25.0,
    density=RHO0,
    side_force=0.0,
    wind_north=0.0,
    wind_east=0.0,
    position_sigma=0.3,
    height_known=True,
)


def cruising(**changes):
    return replace(CRUISE, **changes)


class Kinematic:
    """An aircraft that banks with a lag and turns as the bank says, in a steady wind (north, east) [m/s]."""

    LAG = PARAMS.roll_time

    def __init__(self, north=0.0, east=0.0, heading=0.0, wind=(0.0, 0.0), params=PARAMS):
        self.position = [north, east]
        self.heading = heading
        self.wind = wind
        self.roll = 0.0
        self.params = params
        self.steering = LateralGuidance()

    def estimate(self):
        vn = 25.0 * math.cos(self.heading) + self.wind[0]
        ve = 25.0 * math.sin(self.heading) + self.wind[1]
        return cruising(
            north=self.position[0],
            east=self.position[1],
            ground_speed=math.hypot(vn, ve),
            course=math.atan2(ve, vn),
            yaw=self.heading,
            roll=self.roll,
            wind_north=self.wind[0],
            wind_east=self.wind[1],
        )

    def follow(self, aim_of, seconds, dt=0.02):
        """Flies what ``aim_of(estimate)`` aims at; returns the list of estimates."""
        seen = []
        for _ in range(round(seconds / dt)):
            now = self.estimate()
            seen.append(now)
            bank = self.steering.bank(aim_of(now), now, self.params, dt)
            self.roll += dt / self.LAG * (bank - self.roll)
            self.heading += dt * G / 25.0 * math.tan(self.roll)
            self.position[0] += dt * now.ground_speed * math.cos(now.course)
            self.position[1] += dt * now.ground_speed * math.sin(now.course)
        return seen
