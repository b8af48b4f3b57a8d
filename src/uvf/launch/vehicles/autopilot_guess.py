"""The figures of an airframe that the air autopilot needs, from steady flights and linear models of the running model."""

from pathlib import Path

import numpy as np

from services.sim_air.airframe import Airframe
from services.sim_air.linear import linearize
from services.sim_air.trim import Trim
from uvf.launch.vehicles.aircraft_rules import HEIGHT
from uvf.launch.vehicles.aircraft_trial import level
from uvf.maths.geodesy import GRAVITY
from uvf.runtime.air_file import AirBody
from uvf.runtime.params import BadInput

OTHERS, CLIMB = (1.15, 1.07, 0.93), 0.02  # of the trim speed, the first at which it flies; rad
SLOWEST, FASTEST = 0.8, 1.25  # of the trim speed
STEEPEST = 0.12  # climb and sink over the speed
SHARE = 0.7  # of what the throttle reaches
BANK = 0.7  # tangent of the bank of a holding circle
RESPONSE = 3.0  # time constants of the free motion within which a commanded angle is reached
PROPORTIONAL, INTEGRAL = {"roll": 0.29, "pitch": 1.02}, {"roll": 0.86, "pitch": 2.7}  # of the feed-forward; 1/s; as for Milvus
SPEED = 25.0  # m/s, for which the defaults of the autopilot are


def autopilot_figures(airframe: Airframe, body: AirBody) -> dict[str, float]:
    """Parameter name -> value, of an aircraft with an engine. Raises BadInput where it does not fly so."""
    found = {**_balance(airframe, body.trim_speed), **_rates(airframe, body), **_measures(body.trim_speed)}
    reserve = {"climb_max": 1 - found["trim_throttle"], "sink_max": found["trim_throttle"]}
    for name, left in reserve.items():
        reach = SHARE * left / max(found["throttle_climb"], 1e-3)
        found[name] = min(max(min(reach, STEEPEST * body.trim_speed), 0.5), 15.0)
    return {name: float(f"{value:.3g}") for name, value in found.items()}


def _balance(airframe: Airframe, speed: float) -> dict[str, float]:
    """Lift, elevator and throttle from three steady flights: cruise, at another speed, climbing."""
    cruise, climbing = airframe.start(level(speed)), airframe.start(level(speed, CLIMB))
    factor, other = _other(airframe, speed)
    per_load = (cruise.alpha - other.alpha) / (GRAVITY * (1 - factor**-2)) * speed**2
    per_alpha = (cruise.elevator - other.elevator) / (cruise.alpha - other.alpha)
    return {
        "trim_throttle": cruise.throttle,
        "alpha_zero_lift": _within(cruise.alpha - per_load * GRAVITY / speed**2, -0.3, 0.3),
        "alpha_per_load": per_load,
        "elev_zero_alpha": _within(cruise.elevator - per_alpha * cruise.alpha, -0.5, 0.5),
        "elev_per_alpha": _within(per_alpha, -10.0, 0.0),
        "throttle_speed": _within((other.throttle - cruise.throttle) / ((factor - 1) * speed), 0.0, 0.2),
        "throttle_climb": _within((climbing.throttle - cruise.throttle) / (speed * np.sin(CLIMB)), 0.0, 0.5),
    }


def _other(airframe: Airframe, speed: float) -> tuple[float, Trim]:
    """Level flight at another speed, as a factor of this one."""
    *first, last = OTHERS
    for factor in first:
        try:
            return factor, airframe.start(level(factor * speed))
        except BadInput:
            continue
    return last, airframe.start(level(last * speed))


def _rates(airframe: Airframe, body: AirBody) -> dict[str, float]:
    """Gains of the rate loops: the feed-forward holds a rate against the damping (see services/autopilot/air/design.py)."""
    models = linearize(airframe, body.trim_speed, HEIGHT, Path(body.model))
    sides = {"roll": (models.lateral, "p", "delta_a", 0.3), "pitch": (models.longitudinal, "q", "delta_e", 0.4)}
    found = {}
    for axis, (side, rate, surface, quickest) in sides.items():
        damping, power = abs(side.slope(rate, rate)), abs(side.slope(rate, surface))
        if power < 1e-6 * damping:
            raise BadInput(f"{body.model}: nothing that the autopilot moves makes it {axis}; it turns by bank and climbs by pitch")
        ahead = damping / power
        found[f"{axis}_time"] = _within(RESPONSE / damping, quickest, 2.0)
        found[f"{axis}_ff"] = _within(ahead, 0.0, 2.0)
        found[f"{axis}_p"] = _within(PROPORTIONAL[axis] * ahead, 0.0, 2.0)
        found[f"{axis}_i"] = _within(INTEGRAL[axis] * ahead, 0.0, 2.0)
    return found


def _measures(speed: float) -> dict[str, float]:
    """What goes with the speed alone."""
    return {
        "trim_airspeed": speed,
        "min_airspeed": SLOWEST * speed,
        "max_airspeed": FASTEST * speed,
        "airspeed_p": 0.08 * SPEED / speed,
        "airspeed_i": 0.02 * SPEED / speed,
        "k_path": 0.04 * SPEED / speed,
        "hold_radius": max(speed**2 / (GRAVITY * BANK), 20.0),
    }


def _within(value: float, low: float, high: float) -> float:
    return float(min(max(value, low), high))
