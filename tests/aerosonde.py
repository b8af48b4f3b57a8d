"""The Aerosonde on paper: coefficients of the published set and its linear models by the book's formulas, not by differences.

R. Beard and T. McLain, "Small Unmanned Aircraft: Theory and Practice", supplement of 2020, tables E.1 and E.2;
matrices after tables 5.1 and 5.2.
"""

from dataclasses import dataclass
from math import cos, exp, pi, sin, sqrt

import numpy as np
from scipy.optimize import fsolve

from uvf.control.design.coefficients import AirframeCoefficients
from uvf.maths.state_space import StateSpace

M, JX, JY, JZ, JXZ = 11.0, 0.8244, 1.135, 1.759, 0.1204
S, B, C = 0.55, 2.8956, 0.18994
CL0, CLA, CLQ, CLE = 0.23, 5.61, 7.95, 0.13
CDP, CDE = 0.043, 0.0135
K = S / (pi * 0.9 * B**2)  # induced drag
CM0, CMA, CMQ, CME = 0.0135, -2.74, -38.21, -0.99
SIDE = {"beta": -0.98, "p": 0.0, "r": 0.0, "delta_a": 0.075, "delta_r": 0.19}
ROLL = {"beta": -0.13, "p": -0.51, "r": 0.25, "delta_a": 0.17, "delta_r": 0.0024}
YAW = {"beta": 0.073, "p": 0.069, "r": -0.095, "delta_a": -0.011, "delta_r": -0.069}
DIAMETER, VOLTS, OHM, NO_LOAD = 0.508, 44.4, 0.042, 1.5
KQ = 60 / (2 * pi * 145)  # N m / A and V s / rad
CT = (0.09357, -0.06044, -0.1079)
CQ = (0.005230, 0.004970, -0.01664)
STALL_ALPHA, BLEND = 0.47, 50.0

DESIGN = AirframeCoefficients(
    mass=M,
    wing_area=S,
    chord=C,
    span=B,
    lift_0=CL0,
    lift_alpha=CLA,
    lift_elevator=CLE,
    pitch_0=CM0,
    pitch_alpha=CMA,
    pitch_q=CMQ,
    pitch_elevator=CME,
    roll_p=ROLL["p"],
    roll_aileron=ROLL["delta_a"],
)


def lift(alpha):
    """Equations 4.9 and 4.10."""
    a, b = exp(-BLEND * (alpha - STALL_ALPHA)), exp(BLEND * (alpha + STALL_ALPHA))
    stalled = (1 + a + b) / ((1 + a) * (1 + b))
    return (1 - stalled) * (CL0 + CLA * alpha) + stalled * 2 * np.sign(alpha) * sin(alpha) ** 2 * cos(alpha)


def drag(alpha):
    """Equation 4.11."""
    return CDP + K * (CL0 + CLA * alpha) ** 2


def turning(airspeed, throttle, rho):
    """rad/s at which motor's and propeller's torque are equal (equations 4.15 to 4.20)."""
    a = CQ[0] * rho * DIAMETER**5 / (2 * pi) ** 2
    b = CQ[1] * rho * DIAMETER**4 * airspeed / (2 * pi) + KQ**2 / OHM
    c = CQ[2] * rho * DIAMETER**3 * airspeed**2 - KQ * VOLTS * throttle / OHM + KQ * NO_LOAD
    return (-b + sqrt(b * b - 4 * a * c)) / (2 * a)


def thrust(airspeed, throttle, rho):
    """N."""
    turns = turning(airspeed, throttle, rho) / (2 * pi)
    advance = airspeed / (turns * DIAMETER)
    return rho * turns**2 * DIAMETER**4 * (CT[0] + CT[1] * advance + CT[2] * advance**2)


def motor_power(airspeed, throttle, rho):
    """W from the battery: voltage times current."""
    volts = VOLTS * throttle
    return volts * (volts - KQ * turning(airspeed, throttle, rho)) / OHM


def slope(function, at, h=1e-5):
    return (function(at + h) - function(at - h)) / (2 * h)


def body_forces(alpha, elevator):
    """C_X, C_Z, their slopes in alpha; C_X, C_Z in q and in the elevator, whose drag grows with its size."""

    def in_body(d, lifted):
        return -d * cos(alpha) + lifted * sin(alpha), -d * sin(alpha) - lifted * cos(alpha)

    d, lifted = drag(alpha) + CDE * abs(elevator), lift(alpha) + CLE * elevator
    x, z = in_body(d, lifted)
    dx, dz = in_body(slope(drag, alpha), slope(lift, alpha))
    return (x, z), (dx - z, dz + x), in_body(0.0, CLQ), in_body(CDE * np.sign(elevator), CLE)


def longitudinal(trim, rho, g):
    """Table 5.2."""
    v, alpha, elevator, throttle = trim.airspeed, trim.alpha, trim.elevator, trim.throttle
    u, w = v * cos(alpha), v * sin(alpha)
    force, by_alpha, by_q, by_elevator = body_forces(alpha, elevator)
    pushed = slope(lambda s: thrust(s, throttle, rho), v) / v / M
    moment = CM0 + CMA * alpha + CME * elevator
    n, q = rho * S / M, rho * S * C / JY
    x, z = (
        [
            n * (u * f - w * a / 2) + (u * pushed if axis == 0 else 0.0),
            n * (w * f + u * a / 2) + (w * pushed if axis == 0 else 0.0),
            n * v * C * r / 4 + (-w if axis == 0 else u),
            -g * (cos(alpha) if axis == 0 else sin(alpha)),
            0.0,
        ]
        for axis, (f, a, r) in enumerate(zip(force, by_alpha, by_q, strict=True))
    )
    pitching = [q * (u * moment - w * CMA / 2), q * (w * moment + u * CMA / 2), q * v * C * CMQ / 4, 0.0, 0.0]
    a = np.array([x, z, pitching, [0, 0, 1, 0, 0], [sin(alpha), -cos(alpha), 0, v, 0]])
    b = np.zeros((5, 2))
    b[:3, 0] = n * v**2 * by_elevator[0] / 2, n * v**2 * by_elevator[1] / 2, q * v**2 * CME / 2
    b[0, 1] = slope(lambda t: thrust(v, t, rho), throttle) / M
    return StateSpace(a, b, ("u", "w", "q", "theta", "h"), ("delta_e", "delta_t"))


def lateral(trim, rho, g):
    """Table 5.1."""
    v, theta = trim.airspeed, trim.alpha
    inverse = np.linalg.inv(np.array(((JX, -JXZ), (-JXZ, JZ))))

    def accelerations(name):
        """Of v, p, r per unit."""
        reach = {"beta": 1 / v, "p": B / (2 * v), "r": B / (2 * v)}.get(name, 1.0)
        roll, yaw = inverse @ (ROLL[name], YAW[name]) * B
        return 0.5 * rho * v**2 * S * reach * np.array((SIDE[name] / M, roll, yaw))

    a = np.zeros((5, 5))
    a[:3, :3] = np.column_stack([accelerations(name) for name in ("beta", "p", "r")])
    a[0] += (0.0, v * sin(theta), -v * cos(theta), g * cos(theta), 0.0)
    a[3], a[4] = (0, 1, np.tan(theta), 0, 0), (0, 0, 1 / cos(theta), 0, 0)
    b = np.zeros((5, 2))
    b[:3] = np.column_stack([accelerations(name) for name in ("delta_a", "delta_r")])
    return StateSpace(a, b, ("v", "p", "r", "phi", "psi"), ("delta_a", "delta_r"))


@dataclass(frozen=True)
class Level:
    """Level flight: m/s, rad, throttle 0..1."""

    airspeed: float
    alpha: float
    elevator: float
    throttle: float


def trimmed(airspeed, rho, g):
    """Forces along body x and z and the pitching moment vanish."""
    q_s = 0.5 * rho * airspeed**2 * S

    def left(unknown):
        alpha, elevator, throttle = unknown
        (x, z), *_ = body_forces(alpha, elevator)
        moment = CM0 + CMA * alpha + CME * elevator
        return q_s * x + thrust(airspeed, throttle, rho) - M * g * sin(alpha), q_s * z + M * g * cos(alpha), q_s * C * moment

    return Level(airspeed, *fsolve(left, (0.05, -0.1, 0.7), xtol=1e-12))


def balanced(alpha):
    """C_L and C_D with the elevator that balances the pitching moment, and that elevator."""
    elevator = -(CM0 + CMA * alpha) / CME
    return lift(alpha) + CLE * elevator, drag(alpha) + CDE * abs(elevator), elevator


def climbing(alpha, rho, g):
    """Airspeed and climb angle with full throttle: the forces along and across the path vanish."""
    cl, cd, _ = balanced(alpha)

    def left(unknown):
        airspeed, climb = unknown
        q_s, pull = 0.5 * rho * airspeed**2 * S, thrust(airspeed, 1.0, rho)
        return pull * cos(alpha) - q_s * cd - M * g * sin(climb), pull * sin(alpha) + q_s * cl - M * g * cos(climb)

    return fsolve(left, (20.0, 0.3))
