"""The loops of the air autopilot about an aircraft's linear model, as frequency responses."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import sici

from services.sim_air.analysis.linear import LinearModels
from uvf.control.design.margins import Margins, margins
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.air import AirBody

OMEGA: NDArray[np.float64] = np.geomspace(0.01, 150.0, 6000)  # rad/s
S = 1j * OMEGA
DEAD_TIME = 0.035  # s: a sample of the IMU, its filter in part, a cycle of the autopilot and half of one that the servos hold
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Loop:
    """One control loop, opened where ``opened`` says."""

    axis: str
    opened: str
    response: Complex  # (k,) at OMEGA: the loop
    closed: Complex  # (k,) at OMEGA: what is controlled over what is asked for

    @property
    def margins(self) -> Margins:
        """Gain, phase and delay margins of the open loop."""
        return margins(OMEGA, self.response)

    def step(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Response (k,) of the controlled variable at times ``t`` (k,) [s] after a unit step of its command.

        Computed from the closed loop's frequency response.
        """
        kernel = self.closed.real * np.sin(np.outer(t, OMEGA)) / OMEGA
        slower = self.closed.real[0] * sici(OMEGA[0] * t)[0]  # what lies below the lowest frequency
        return np.asarray(2 / np.pi * (np.trapezoid(kernel, OMEGA, axis=1) + slower))


def loops(models: LinearModels, gains: Mapping[str, float], body: AirBody) -> Iterator[Loop]:
    """Loops of roll, pitch, height and airspeed (``uvf.control``: attitude_loops, energy) at the trim speed.

    gains: autopilot parameters by name, each in its own unit (s, 1/s, [-]).
    """
    yield _attitude("roll", models, gains, body)
    pitch = _attitude("pitch", models, gains, body)
    yield pitch
    yield _height(pitch, models, gains)
    yield _airspeed(models, gains)


def _attitude(axis: str, models: LinearModels, gains: Mapping[str, float], body: AirBody) -> Loop:
    sides = {"roll": (models.lateral, "phi", "delta_a", 1.0), "pitch": (models.longitudinal, "theta", "delta_e", -1.0)}
    side, angle, surface, sign = sides[axis]
    ahead, p, i, time = (gains[f"{axis}_{name}"] for name in ("ff", "p", "i", "time"))
    plant = sign * _servo(body) * side.transfer(angle, surface, OMEGA)
    asked = (ahead + p + i / S) / time
    response = (asked + p * S + i) * plant
    return Loop(axis, "at the servo", response, asked * plant / (1 + response))


def _servo(body: AirBody) -> Complex:
    return np.asarray(np.exp(-DEAD_TIME * S) / (1 + body.servo_lag * S), dtype=np.complex128)


def _height(pitch: Loop, models: LinearModels, gains: Mapping[str, float]) -> Loop:
    """Through the closed loop of pitch: the climb asked for by the height's error, pitch by the climb's error and ahead of it."""
    side, speed = models.longitudinal, models.trim.airspeed
    height = pitch.closed * side.transfer("h", "delta_e", OMEGA) / side.transfer("theta", "delta_e", OMEGA)
    on_error = (gains["climb_p"] + gains["climb_i"] / S) / speed
    asked = gains["altitude_p"] * (1 / speed + on_error)
    response = (asked + on_error * S) * height
    return Loop("height", "at the pitch asked for", response, asked * height / (1 + response))


def _airspeed(models: LinearModels, gains: Mapping[str, float]) -> Loop:
    """With the height held by pitch: V = a_V2 / (s + a_V1) of the throttle, and the observer of power in place of an integrator."""
    design, speed = models.design, models.trim.airspeed
    plant = design.a_V2 / (S + design.a_V1)
    energy, drag = speed / GRAVITY, gains["throttle_speed"] / gains["throttle_climb"]  # s and 1, of power per speed
    learns = gains["power_pole"] ** 2 / (S * (S + 2 * gains["power_pole"]))
    given = gains["airspeed_p"] * energy * (1 + learns)
    response = gains["throttle_climb"] * (given + learns * (S * energy + drag)) * plant
    asked = gains["throttle_climb"] * (given + drag * (1 + learns))
    return Loop("airspeed", "at the throttle", response, asked * plant / (1 + response))
