"""Pitch, height and airspeed of ``attitude_loops`` and ``total_energy``, linear about level flight."""

import math
from collections.abc import Mapping

from uvf.control.design.flight_condition import AIRSPEED_TIME, GYRO_TIME, ActuatorDelays, FlightCondition
from uvf.control.design.signal_flow import Floats, SignalFlow, Terms
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams

SIGNALS = (
    *("u", "w", "q", "theta", "h", "climb", "airspeed", "q_felt", "airspeed_felt"),
    *("climb_asked", "climb_trim", "pitch", "pitch_trim", "alpha_asked", "elevator_asked"),
    *("kinetic", "unexplained", "throttle_asked"),
    *("servo_e", "servo_t", "delta_e", "delta_t"),
)
INPUTS = ("gust_u", "gust_w", "gust_q")
IN_AIR = {"u": ("u", "w"), "w": ("u", "w"), "q": ("u", "w", "q")}
LOOPS = {"height": "pitch", "pitch": "elevator_asked", "airspeed": "throttle_asked"}
GLIDING = {"airspeed": "pitch", "pitch": "elevator_asked"}
AT_FULL_THROTTLE = {"airspeed by pitch": "pitch"}
ON_FINAL = {"flare": "pitch", "flare pitch": "elevator_asked"}
ATTITUDE = {"attitude pitch": "elevator_asked"}
"""Where each is opened."""


def longitudinal_flow(omega: Floats, flight: FlightCondition, delays: ActuatorDelays, params: AirParams) -> SignalFlow:
    """The closed loops at omega (k,) [rad/s]; angles [rad], speeds [m/s], ``h`` [m]."""
    flow = SignalFlow(omega, SIGNALS, INPUTS)
    flow.opens(*LOOPS.values())
    _inner(flow, flight, delays, params)
    flow.actuator("t", "throttle_asked", delays.throttle, delays.dead_time)
    flow.integral("h", {"climb": 1.0})
    _path(flow, flight, params, {"h": -params.altitude_p})
    _energy(flow, flight, params)
    return flow


def gliding_flow(omega: Floats, flight: FlightCondition, delays: ActuatorDelays, params: AirParams) -> SignalFlow:
    """The closed loops without an engine, or at full throttle: pitch holds the airspeed, and no height."""
    flow = SignalFlow(omega, SIGNALS, INPUTS)
    flow.opens(*GLIDING.values())
    _inner(flow, flight, delays, params)
    made = -params.throttle_speed / params.throttle_climb if params.throttle_climb else 0.0
    exchanged = flight.airspeed / GRAVITY * params.airspeed_pitch_p
    flow.equal("h", {})  # what the density changes is slower than all else
    _path(flow, flight, params, {"airspeed_felt": made + exchanged, "unexplained": 1.0})
    _observer(flow, flight, params, {"airspeed_felt": made})
    flow.equal("throttle_asked", {})
    flow.actuator("t", None, delays.throttle, delays.dead_time)
    return flow


def attitude_flow(omega: Floats, flight: FlightCondition, delays: ActuatorDelays, params: AirParams) -> SignalFlow:
    """The closed loops with pitch and throttle that are given, as by sticks."""
    flow = SignalFlow(omega, SIGNALS, INPUTS)
    flow.opens(*LOOPS.values())
    _inner(flow, flight, delays, params)
    for free in ("h", "climb_asked", "climb_trim", "pitch", "kinetic", "unexplained", "throttle_asked"):
        flow.equal(free, {})
    flow.actuator("t", None, delays.throttle, delays.dead_time)
    return flow


def _inner(flow: SignalFlow, flight: FlightCondition, delays: ActuatorDelays, params: AirParams) -> None:
    _airframe(flow, flight)
    flow.actuator("e", "elevator_asked", delays.elevator, delays.dead_time)
    flow.lag("q_felt", GYRO_TIME, {"q": 1.0})
    flow.lag("airspeed_felt", AIRSPEED_TIME, {"airspeed": 1.0})
    _pitch(flow, flight, params)


def _airframe(flow: SignalFlow, flight: FlightCondition) -> None:
    model = flight.longitudinal
    flow.airframe(model, ("u", "w", "q", "theta"), IN_AIR)
    up = {by: model.slope("h", by) for by in model.states}
    flow.equal("climb", up)
    c, s = math.cos(flight.alpha), math.sin(flight.alpha)
    flow.equal("airspeed", {"u": c, "w": s, "gust_u": -c, "gust_w": -s})


def _path(flow: SignalFlow, flight: FlightCondition, params: AirParams, climb: Terms) -> None:
    """climb: what is asked for."""
    speed = flight.airspeed
    flow.equal("climb_asked", climb)
    error = {"climb_asked": 1 / speed, "climb": -1 / speed}
    flow.integral("climb_trim", {name: params.climb_i * value for name, value in error.items()})
    asked = {name: params.climb_p * value for name, value in error.items()}
    asked["climb_asked"] += 1 / speed
    carried = -2 * params.alpha_per_load * GRAVITY / flight.eas**2 / speed  # rad of alpha per m/s
    flow.equal("pitch", asked | {"climb_trim": 1.0, "airspeed_felt": carried})


def _pitch(flow: SignalFlow, flight: FlightCondition, params: AirParams) -> None:
    scale, asked = (params.trim_airspeed / flight.eas) ** 2, {"pitch": 1 / params.pitch_time, "theta": -1 / params.pitch_time}
    error = asked | {"q_felt": -1.0}
    flow.integral("pitch_trim", {name: -params.pitch_i * value for name, value in error.items()})
    ahead = {name: math.sqrt(scale) * params.pitch_ff * value for name, value in asked.items()}
    moving = {name: -ahead.get(name, 0.0) - scale * params.pitch_p * value for name, value in error.items()}
    turned = params.alpha_per_load * flight.airspeed / flight.eas**2  # s, and rad of alpha per rad/s
    carried = -2 * params.alpha_per_load * GRAVITY / flight.eas**2 / flight.airspeed
    flow.lag("alpha_asked", turned, {name: turned * value for name, value in asked.items()} | {"airspeed_felt": carried})
    flow.equal("elevator_asked", moving | {"pitch_trim": scale, "alpha_asked": params.elev_per_alpha})


def _energy(flow: SignalFlow, flight: FlightCondition, params: AirParams) -> None:
    slope = max(params.throttle_climb, 1e-3)
    _observer(flow, flight, params, {"throttle_asked": 1 / slope, "airspeed_felt": -params.throttle_speed / slope})
    faster = slope * flight.airspeed / GRAVITY * params.airspeed_p
    flow.equal("throttle_asked", {"climb_asked": slope, "airspeed_felt": -faster, "unexplained": -slope})


def _observer(flow: SignalFlow, flight: FlightCondition, params: AirParams, made: Mapping[str, float]) -> None:
    """made: climb rate by the throttle, as it is believed to be."""
    pole = params.power_pole
    error = {"airspeed_felt": flight.airspeed / GRAVITY, "kinetic": -1.0}  # m of kinetic energy
    gained = {name: 2 * pole * value for name, value in error.items()} | {"unexplained": 1.0, "climb": -1.0}
    flow.integral("kinetic", {name: gained.get(name, 0.0) + made.get(name, 0.0) for name in {**gained, **made}})
    flow.integral("unexplained", {name: pole**2 * value for name, value in error.items()})
