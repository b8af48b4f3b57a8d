"""The book's coefficients from state-space slopes equal the book's own formulas from aerodynamic coefficients."""

import pytest

from tests import aerosonde as a
from uvf.control.design.design_models import design_models

RHO, G, V = 1.2, 9.81, 25.0
TRIM = a.trimmed(V, RHO, G)
FOUND = design_models(a.longitudinal(TRIM, RHO, G), a.lateral(TRIM, RHO, G), V, TRIM.alpha)
Q_S = 0.5 * RHO * V**2 * a.S
GAMMA = a.JX * a.JZ - a.JXZ**2


def rolling(name):
    """C_p of equation 5.21 and following: Gamma_3 C_l + Gamma_4 C_n."""
    return (a.JZ * a.ROLL[name] + a.JXZ * a.YAW[name]) / GAMMA


def test_roll():
    assert FOUND.a_phi1 == pytest.approx(-Q_S * a.B * rolling("p") * a.B / (2 * V))
    assert FOUND.a_phi2 == pytest.approx(Q_S * a.B * rolling("delta_a"))


def test_side_slip():
    assert FOUND.a_beta1 == pytest.approx(-RHO * V * a.S / (2 * a.M) * a.SIDE["beta"])
    assert FOUND.a_beta2 == pytest.approx(RHO * V * a.S / (2 * a.M) * a.SIDE["delta_r"])


def test_pitch():
    assert FOUND.a_theta1 == pytest.approx(-Q_S * a.C / a.JY * a.CMQ * a.C / (2 * V))
    assert FOUND.a_theta2 == pytest.approx(-Q_S * a.C / a.JY * a.CMA)
    assert FOUND.a_theta3 == pytest.approx(Q_S * a.C / a.JY * a.CME)


def test_airspeed():
    drag = a.drag(TRIM.alpha) + a.CDE * abs(TRIM.elevator)
    slower = a.slope(lambda v: a.thrust(v, TRIM.throttle, RHO), V)
    assert FOUND.a_V1 == pytest.approx(RHO * V * a.S * drag / a.M - slower / a.M, rel=2e-2)  # the book takes thrust along the path
    assert FOUND.a_V2 == pytest.approx(a.slope(lambda t: a.thrust(V, t, RHO), TRIM.throttle) / a.M, rel=2e-3)  # cos alpha
    assert FOUND.a_V3 == pytest.approx(G)
