"""The loops of an aircraft from its running model: what they are designed for, their gains, and how early its turns are banked for."""

import math
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np
from scipy.optimize import minimize

from launch.vehicles.aircraft_rules import HEIGHT
from services.sim_air.analysis.lags import lags
from services.sim_air.analysis.linear import LinearModels, held_still, linearize
from services.sim_air.engine.airframe import Airframe
from uvf.control.design.aircraft_loops import OMEGA, AircraftLoops
from uvf.control.design.flight_condition import ActuatorDelays, FlightCondition
from uvf.control.design.lateral_loops import lateral_flow, rudder_of_roll
from uvf.maths.atmosphere import RHO0, standard_density
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.air import AirBody
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.yaml_data import BadInput

ABOVE_SLOWEST = 1.05  # of the lowest airspeed, at which loops are looked at
TURNING = (0.2, 5.0)  # rad/s, of a turn's beginning
ROLL_SHARE = 0.6  # of the ailerons' way, for planned turns
QUICKEST, LONGEST = 1.0, 10.0  # s, from level to the bank of a turn


@dataclass(frozen=True)
class ModelledAircraft:
    """What the loops hold, and the figures of its linear model in cruise that feed-forwards come from."""

    loops: AircraftLoops
    cruise: FlightCondition

    def with_mix(self, params: AirParams) -> AirParams:
        """With the rudder that cancels what a steady roll yaws, by its ailerons and by its rate, to begin with."""
        return msgspec.structs.replace(params, rudder_mix=rudder_of_roll(self.cruise))


def modelled(airframe: Airframe, body: AirBody, params: AirParams) -> ModelledAircraft:
    """The aircraft at its lowest airspeed, in cruise and at its highest, as far as it flies level there. Raises BadInput."""
    path = Path(body.model)
    cruise = linearize(airframe, params.trim_airspeed, HEIGHT, path)
    found = [_or_nothing(airframe, ABOVE_SLOWEST * params.min_airspeed, path), cruise, _or_nothing(airframe, params.max_airspeed, path)]
    with held_still(airframe):
        behind = lags(airframe, cruise.trim, body.physics_hz)
    aileron, elevator, rudder = ((body.lag_of(getattr(body.controls, name)), behind[name]) for name in ("aileron", "elevator", "rudder"))
    delays = ActuatorDelays(aileron, elevator, rudder, (body.controls.throttle.lag, behind["throttle"]))
    conditions = [_condition(models, airframe.span) for models in found if models is not None]
    return ModelledAircraft(AircraftLoops(conditions, delays, airframe.powered), _condition(cruise, airframe.span))


def timing(aircraft: ModelledAircraft, params: AirParams, limit: float) -> dict[str, float]:
    """How turns are planned and banked for; limit: of the ailerons [rad].

    ``lead_time`` and ``bank_time`` invert how the turn of the path follows the bank asked for, (1 + bank_time s) exp(lead_time s), as
    well as they can where turns begin: later than the bank, where the aircraft slips first;
    ``roll_in`` is the time in which a share of the ailerons reaches the bank of a turn against inertia and damping.
    """
    flow = lateral_flow(OMEGA, aircraft.cruise, aircraft.loops.delays, params)
    turns = flow.closed("off", "bank") / flow.closed("bank", "bank") * flow.s * aircraft.cruise.ground_speed / GRAVITY
    k = (TURNING[0] < OMEGA) & (TURNING[1] > OMEGA)

    def missed(x: np.ndarray) -> float:
        inverted = turns[k] * (1 + abs(x[0]) * flow.s[k]) * np.exp(abs(x[1]) * flow.s[k])
        return float(np.sum(np.abs(1 - inverted) ** 2 / OMEGA[k]))

    bank_time, lead_time = np.abs(minimize(missed, (params.roll_time, 0.1), method="Nelder-Mead").x).tolist()
    damping, roll_in = abs(aircraft.cruise.lateral.slope("p", "p")), QUICKEST
    while roll_in < LONGEST and _aileron(params, damping, roll_in) > ROLL_SHARE * limit:
        roll_in *= 1.05
    return {"lead_time": min(lead_time, 2.0), "bank_time": min(bank_time, 2.0), "roll_in": min(roll_in, LONGEST)}


def _aileron(params: AirParams, damping: float, roll_in: float) -> float:
    """rad, the most that it takes to roll to ``turn_bank`` along half a cosine."""
    quickest = params.turn_bank * math.pi / 2 / roll_in
    return params.roll_ff * quickest * math.hypot(1.0, math.pi / roll_in / damping)


def _or_nothing(airframe: Airframe, airspeed: float, path: Path) -> LinearModels | None:
    try:
        return linearize(airframe, airspeed, HEIGHT, path)
    except BadInput:
        return None


def _condition(models: LinearModels, span: float) -> FlightCondition:
    speed = models.trim.airspeed
    eas = speed * math.sqrt(standard_density(models.trim.altitude) / RHO0)
    return FlightCondition(speed, eas, models.trim.alpha, models.longitudinal, models.lateral, speed, span)
