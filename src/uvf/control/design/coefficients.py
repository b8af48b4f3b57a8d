"""Airframe parameters of the autopilot from an aircraft's derivatives, after Beard & McLain chapters 5 and 6.

To be used once for a new vehicle: the figures go into the ``autopilot_air`` parameters of its vehicle.yaml.
"""

from dataclasses import dataclass

from uvf.maths.atmosphere import RHO0


@dataclass(frozen=True)
class AirframeCoefficients:
    """Mass, geometry, and derivatives of the coefficients per rad; rates are made dimensionless with c / 2V or b / 2V."""

    mass: float  # kg
    wing_area: float  # m^2
    chord: float  # m
    span: float  # m
    lift_0: float
    lift_alpha: float
    lift_elevator: float
    pitch_0: float
    pitch_alpha: float
    pitch_q: float
    pitch_elevator: float
    roll_p: float
    roll_aileron: float
    lift_flap: float = 0.0
    pitch_flap: float = 0.0


def gains(frame: AirframeCoefficients, airspeed: float) -> dict[str, float]:
    """Autopilot parameters by name, for the airframe at ``airspeed`` [m/s].

    The elevator that balances alpha solves C_m = 0, and its lift counts as lift of the wing; the feed-forward of a rate is
    the deflection that holds it against the damping: a_phi1 / a_phi2 (5.23, 5.24) and C_m_q c / 2V / C_m_delta_e.
    """
    elevator_0, elevator_alpha = -frame.pitch_0 / frame.pitch_elevator, -frame.pitch_alpha / frame.pitch_elevator
    lift_0 = frame.lift_0 + frame.lift_elevator * elevator_0
    lift_alpha = frame.lift_alpha + frame.lift_elevator * elevator_alpha
    return {
        "alpha_zero_lift": -lift_0 / lift_alpha,
        "alpha_per_load": 2 * frame.mass / (RHO0 * frame.wing_area * lift_alpha),
        "flap_alpha": (frame.lift_flap - frame.lift_elevator * frame.pitch_flap / frame.pitch_elevator) / lift_alpha,
        "elev_zero_alpha": elevator_0,
        "elev_per_alpha": elevator_alpha,
        "roll_ff": -frame.roll_p / frame.roll_aileron * frame.span / (2 * airspeed),
        "pitch_ff": frame.pitch_q / frame.pitch_elevator * frame.chord / (2 * airspeed),
    }
