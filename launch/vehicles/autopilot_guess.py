"""The figures of an airframe that the air autopilot needs, from steady flights and linear models of the running model."""

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from launch.vehicles.aircraft_rules import ABOUT_LEVEL, HEIGHT
from launch.vehicles.aircraft_trial import CLIMB, level, turning
from services.sim_air.analysis.equilibrium import Condition, find
from services.sim_air.analysis.linear import LinearModels, held_still, linearize
from services.sim_air.analysis.performance import climb_rate, glides, stall
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import Held
from services.sim_air.engine.trim import Trim, attitude
from services.sim_air.engine.wiring import Controls
from uvf.maths.geodesy import GRAVITY
from uvf.maths.rotations import Floats
from uvf.maths.state_space import jacobian
from uvf.models.vehicle.air import AirBody
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.yaml_data import BadInput

OTHERS = 1.15, 1.07, 0.93  # of the trim speed, the first at which it flies
SLOWEST, FASTEST = 0.8, 1.25  # of the trim speed
STEEPEST = 0.12  # climb and sink over the speed
SHARE = 0.7  # of the climb at full throttle
DIVING, IDLE_SHARE = 1.15, 0.9  # of the trim speed, that a steep descent may take; of the sink with an idling engine there
BANK, HOLDING = 0.7, 0.75  # tangent of the bank of a holding circle, and its largest share of that of a planned turn
TURN_SHARE, LIFT_SHARE, POWER_SHARE = 0.6, 0.8, 0.5  # of the elevator's way from level flight to its stop, of the lift, of the throttle
LEAST_BANK, STEEPEST_BANK = 0.3, 1.2  # rad
BANKS = 61  # that are tried
MARGIN = 1.1  # of a speed over that at which the wing stalls
HIGHEST_ALPHA = 0.25  # rad, where a model tells of no stall
IDLING = (0.0, 0.15, 0.3)
THROTTLES = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)
RUDDER_SHARE = 0.7  # the rest is for gusts
LEAST_CROSSWIND, MOST_CROSSWIND = 0.2, 0.45  # of min_airspeed; 0.2 is shown of every certified aeroplane (CS 23.233)
LEAST_SLOPE = 1e-3  # s/m, of throttle per climb
TAKE_OFF, STARTING = 4.0, 0.3  # m/s^2, of trim speed
LOWERED, FLAP_STEPS = 0.1, (1e-3, 1e-3, 0.05)  # rad of flap; rad of alpha, elevator and flap


def autopilot_figures(airframe: Airframe, body: AirBody) -> dict[str, float]:
    """Autopilot parameters by name, but for the gains, each in its own unit (s, rad, m/s, 1/s, [-]), of an aircraft with an engine.

    The pitch and roll feed-forward follow Beard & McLain (5.26, 5.30). Raises BadInput where it has no such steady flight.
    """
    models = linearize(airframe, body.trim_speed, HEIGHT, Path(body.model))
    rates = _rates(models, body)  # first: it tells of an aircraft that cannot bank, which would not fly a turn either
    found = {**_balance(airframe, body.trim_speed), **rates, **_measures(body.trim_speed)}
    found["rudder_force"] = _within(models.lateral.slope("v", "delta_r"), -50.0, 50.0)
    found["flap_alpha"] = _within(_flap_lift(airframe, models.trim), 0.0, 1.0)
    found |= _slowest(airframe, body, found) | {"idle_sink": _within(_idle_sink(airframe, body, body.trim_speed), 0.1, 20.0)}
    found |= {"turn_bank": planned_bank(body, found), "bank_limit": sustained_bank(found, 1.0)}
    found["hold_radius"] = max(body.trim_speed**2 / (GRAVITY * min(BANK, HOLDING * math.tan(found["turn_bank"]))), 20.0)
    found["crosswind_max"] = _crosswind(models, body, found["min_airspeed"])
    dives = IDLE_SHARE * _idle_sink(airframe, body, DIVING * body.trim_speed)
    climbs = SHARE * (1 - found["trim_throttle"]) / max(found["throttle_climb"], 1e-3)
    for name, reach in (("climb_max", climbs), ("sink_max", dives)):
        found[name] = min(max(min(reach, STEEPEST * body.trim_speed), 0.5), 15.0)
    needed = found["trim_throttle"] + found["throttle_climb"] * found["climb_max"]
    found["takeoff_throttle"] = max(_pulling(airframe, body.trim_speed), min(needed, 1.0))
    return {name: three_digits(value) for name, value in found.items()}


def three_digits(value: float) -> float:
    """As it is written into a vehicle's file."""
    return float(f"{value:.3g}")


def _pulling(airframe: Airframe, speed: float) -> float:
    """Throttle, 0 to 1, that accelerates it by TAKE_OFF at the beginning of its run: a model's motor often pulls with its whole weight."""
    run = level(STARTING * speed)
    with held_still(airframe):
        idle, *pulls = (airframe.accelerations(run, replace(ABOUT_LEVEL, throttle=throttle))[0] for throttle in THROTTLES)
    return float(np.interp(TAKE_OFF, np.maximum.accumulate([0.0, *(pull - idle for pull in pulls)]), THROTTLES))


def _balance(airframe: Airframe, speed: float) -> dict[str, float]:
    """Lift, surfaces and throttle from four steady flights: cruise, at another speed, climbing, turning."""
    cruise, climbing, turn = (airframe.start(start) for start in (level(speed), level(speed, CLIMB), turning(speed)))
    yawing = attitude(turning(speed).path, turn).rates[2]
    factor, other = _other(airframe, speed)
    per_load = (cruise.alpha - other.alpha) / (GRAVITY * (1 - factor**-2)) * speed**2
    per_alpha = (cruise.elevator - other.elevator) / (cruise.alpha - other.alpha)
    least_slope = LEAST_SLOPE if airframe.powered else 0.0
    return {
        "trim_throttle": cruise.throttle,
        "alpha_zero_lift": _within(cruise.alpha - per_load * GRAVITY / speed**2, -0.3, 0.3),
        "alpha_per_load": per_load,
        "elev_zero_alpha": _within(cruise.elevator - per_alpha * cruise.alpha, -0.5, 0.5),
        "elev_per_alpha": _within(per_alpha, -10.0, 0.0),
        "throttle_speed": _within((other.throttle - cruise.throttle) / ((factor - 1) * speed), 0.0, 0.2),
        "throttle_load": _within(turn.throttle - cruise.throttle, 0.0, 0.5),
        "aileron_turn": _within((turn.aileron - cruise.aileron) / yawing, -2.0, 2.0),
        "rudder_turn": _within((turn.rudder - cruise.rudder) / yawing, -2.0, 2.0),
        "throttle_climb": _within((climbing.throttle - cruise.throttle) / (speed * np.sin(CLIMB)), least_slope, 0.5),
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


def _idle_sink(airframe: Airframe, body: AirBody, airspeed: float) -> float:
    """m/s, the steepest of steady descents at an airspeed [m/s] with little throttle: a propeller brakes most while it still turns."""
    near = Condition(airspeed, HEIGHT, climb=-0.1)
    with held_still(airframe):
        flown = [find(airframe, replace(near, throttle=throttle), ("airspeed", "throttle")) for throttle in IDLING]
    return -min((climb_rate(c) for c in flown if c is not None), default=-STEEPEST * body.trim_speed)


def _slowest(airframe: Airframe, body: AirBody, found: Mapping[str, float]) -> dict[str, float]:
    """The largest angle of attack: what the elevator balances gliding, within a margin to the stall; and the airspeed that goes with it."""
    with held_still(airframe):
        slowest = min(glides(airframe, body, HEIGHT), key=lambda c: c.airspeed)
        stalls, _ = stall(airframe, body.trim_speed, HEIGHT)
    zero = found["alpha_zero_lift"]
    alpha = _within(min(slowest.alpha, zero + (stalls - zero) / MARGIN**2), 0.05, HIGHEST_ALPHA)
    stalled = (found["alpha_per_load"] * GRAVITY / (alpha - zero)) ** 0.5
    return {"alpha_max": alpha, "min_airspeed": max(SLOWEST * body.trim_speed, MARGIN * stalled)}


def planned_bank(body: AirBody, found: Mapping[str, float]) -> float:
    """Bank [rad] of planned turns: the usual one, or as steep as shares of the lift, of the elevator and of the throttle carry and hold.

    The elevator holds the angle of attack, and the pitch rate against its damping; the rest of it begins and ends turns.
    """
    speed, usual = body.trim_speed, AirParams().turn_bank

    def elevator(bank: float) -> float:
        load = 1 / math.cos(bank)
        alpha = found["alpha_zero_lift"] + found["alpha_per_load"] * load * GRAVITY / speed**2
        rate = GRAVITY / speed * (load - 1 / load)
        return found["elev_zero_alpha"] + found["elev_per_alpha"] * alpha - found["pitch_ff"] * rate

    most = (1 - TURN_SHARE) * elevator(0.0) + TURN_SHARE * body.controls.elevator.lowest()
    lifts = (found["alpha_max"] - found["alpha_zero_lift"]) * speed**2 / (found["alpha_per_load"] * GRAVITY)
    carried = math.acos(min(1 / max(LIFT_SHARE * lifts, 1.0), math.cos(LEAST_BANK)))
    carried = min(carried, sustained_bank(found, POWER_SHARE))
    held = (bank for bank in np.linspace(LEAST_BANK, usual, BANKS).tolist() if bank < carried and elevator(bank) > most)
    return max(held, default=LEAST_BANK)


def sustained_bank(found: Mapping[str, float], share: float) -> float:
    """Bank [rad] of the level turn that a share of the throttle above cruise sustains; the steepest of all without an engine."""
    if not found["throttle_climb"] or not found["throttle_load"]:
        return STEEPEST_BANK
    load = math.sqrt(1 + share * (1 - found["trim_throttle"]) / found["throttle_load"])
    return min(math.acos(1 / load), STEEPEST_BANK)


def _crosswind(models: LinearModels, body: AirBody, airspeed: float) -> float:
    """m/s, in which a share of the rudder still turns the nose along the strip at an airspeed [m/s], and no more than is usual."""
    side = models.lateral
    weathercock, rudder = side.slope("r", "v"), abs(side.slope("r", "delta_r"))
    slips = RUDDER_SHARE * rudder * body.controls.rudder.limit / max(weathercock, 1e-6) * airspeed / models.trim.airspeed
    return max(min(slips, MOST_CROSSWIND * airspeed), LEAST_CROSSWIND * airspeed)


def _flap_lift(airframe: Airframe, trim: Condition) -> float:
    """How far the angle of attack falls per flap that is lowered, lift and pitching moment as before; 0 without flaps."""

    def left(x: Floats) -> Floats:
        alpha, elevator, flap = x.tolist()
        state = replace(trim, alpha=alpha).state
        controls = Controls(trim.aileron, elevator, trim.rudder, trim.throttle, flap=flap)
        return airframe.accelerations_held(Held(state[:3], state[3:6], state[6:9], trim.altitude), controls)[[2, 4]]

    with held_still(airframe):
        slopes = jacobian(left, np.array((trim.alpha, trim.elevator, LOWERED)), FLAP_STEPS)
    return -float(np.linalg.solve(slopes[:, :2], -slopes[:, 2])[0])


def _rates(models: LinearModels, body: AirBody) -> dict[str, float]:
    """The feed-forward of a rate is the deflection that holds it against the damping.

    That is a_phi1 / a_phi2 and a_theta1 / a_theta3 of Beard & McLain (5.26, 5.30).
    """
    sides = {"roll": (models.lateral, "p", "delta_a"), "pitch": (models.longitudinal, "q", "delta_e")}
    found = {}
    for axis, (side, rate, surface) in sides.items():
        damping, power = abs(side.slope(rate, rate)), abs(side.slope(rate, surface))
        if power < 1e-6 * damping:
            why = f"{body.model}: nothing that the autopilot moves makes it {axis}"
            what = (
                "an aeroplane that turns by its rudder alone cannot be flown, and an airship's figures are set by hand, with law: airship"
            )
            raise BadInput(f"{why}: {what}")
        found[f"{axis}_ff"] = _within(damping / power, 0.0, 2.0)
    return found


def _measures(speed: float) -> dict[str, float]:
    """What goes with the speed alone."""
    return {
        "trim_airspeed": speed,
        "max_airspeed": FASTEST * speed,
    }


def _within(value: float, low: float, high: float) -> float:
    return float(min(max(value, low), high)) + 0.0  # no negative zero
