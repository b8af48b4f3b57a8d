"""Coefficients of the transfer functions that autopilots are designed with: Beard and McLain, sections 5.4 and 5.5."""

import math
from dataclasses import dataclass

import numpy as np

from uvf.maths.state_space import StateSpace


@dataclass(frozen=True)
class DesignModels:
    """Coefficients of the design transfer functions, named as in the book.

    phi / delta_a = a_phi2 / (s (s + a_phi1)), equation 5.26; beta / delta_r = a_beta2 / (s + a_beta1), 5.28;
    theta / delta_e = a_theta3 / (s^2 + a_theta1 s + a_theta2), 5.30;
    V = (a_V2 delta_t - a_V3 theta) / (s + a_V1), 5.36. Equation numbers of the first edition's second printing.
    """

    a_phi1: float  # 1/s
    a_phi2: float  # 1/s^2
    a_beta1: float  # 1/s
    a_beta2: float  # 1/s
    a_theta1: float  # 1/s
    a_theta2: float  # 1/s^2
    a_theta3: float  # 1/s^2
    a_V1: float  # 1/s
    a_V2: float  # m/s^2
    a_V3: float  # m/s^2


def design_models(longitudinal: StateSpace, lateral: StateSpace, airspeed: float, alpha: float) -> DesignModels:
    """Coefficients from the derivatives in u, w, q, theta and v, p of wings-level flight at ``airspeed`` [m/s] and ``alpha`` [rad].

    The book takes the angles' slopes at constant airspeed and the airspeed's at constant angles:
    d/d alpha = u d/dw - w d/du, V' = u' cos alpha + w' sin alpha, beta = v / V.
    """
    along = np.array((math.cos(alpha), math.sin(alpha)))
    faster = longitudinal.part("uw", ("delta_t",))
    return DesignModels(
        a_phi1=-lateral.slope("p", "p"),
        a_phi2=lateral.slope("p", "delta_a"),
        a_beta1=-lateral.slope("v", "v"),
        a_beta2=lateral.slope("v", "delta_r") / airspeed,
        a_theta1=-longitudinal.slope("q", "q"),
        a_theta2=-airspeed * (longitudinal.slope("q", "w") * along[0] - longitudinal.slope("q", "u") * along[1]),
        a_theta3=longitudinal.slope("q", "delta_e"),
        a_V1=float(-along @ faster.a @ along),
        a_V2=float(along @ faster.b[:, 0]),
        a_V3=float(-along @ (longitudinal.slope("u", "theta"), longitudinal.slope("w", "theta"))),
    )
