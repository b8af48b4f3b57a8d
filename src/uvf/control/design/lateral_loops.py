"""Roll, yaw and path of ``attitude_loops`` and ``vector_field``, linear about level flight along a line."""

import math

from uvf.control.design.flight_condition import FORCE_TIME, GYRO_TIME, ActuatorDelays, FlightCondition
from uvf.control.design.signal_flow import Floats, SignalFlow
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams

SIGNALS = (
    *("v", "p", "r", "phi", "psi", "aside", "off"),
    *("p_felt", "r_felt", "side_force"),
    *("path_trim", "bank", "roll_trim", "aileron_asked", "slip_trim", "rudder_asked"),
    *("servo_a", "servo_r", "delta_a", "delta_r"),
)
INPUTS = ("gust_v", "gust_p", "gust_r")
LEAST_DAMPING = 0.1  # 1/s, of rolls
IN_AIR = {"v": ("v",), "p": ("v", "p", "r"), "r": ("v", "p", "r")}
LOOPS = {"path": "bank", "roll": "aileron_asked", "yaw": "rudder_asked"}
ON_FINAL = {"final path": "bank", "final roll": "aileron_asked"}
ATTITUDE = {"attitude roll": "aileron_asked"}
"""Where each is opened."""


def lateral_flow(omega: Floats, flight: FlightCondition, delays: ActuatorDelays, params: AirParams) -> SignalFlow:
    """The closed loops at omega (k,) [rad/s]; angles [rad], ``aside`` [m] to the right of the line, ``off`` [rad] its course."""
    flow = SignalFlow(omega, SIGNALS, INPUTS)
    flow.opens(*LOOPS.values())
    _airframe(flow, flight, ("psi",))
    _motion(flow, flight)
    _guidance(flow, flight, params)
    _inner(flow, flight, delays, params)
    return flow


def attitude_flow(omega: Floats, flight: FlightCondition, delays: ActuatorDelays, params: AirParams) -> SignalFlow:
    """The closed loops with a bank that is given, as by a stick: no path is held."""
    flow = SignalFlow(omega, SIGNALS, INPUTS)
    flow.opens(*LOOPS.values())
    _airframe(flow, flight)
    for free in ("psi", "aside", "off", "path_trim", "bank"):
        flow.equal(free, {})
    _inner(flow, flight, delays, params)
    return flow


def _inner(flow: SignalFlow, flight: FlightCondition, delays: ActuatorDelays, params: AirParams) -> None:
    flow.actuator("a", "aileron_asked", delays.aileron, delays.dead_time)
    flow.actuator("r", "rudder_asked", delays.rudder, delays.dead_time)
    flow.lag("p_felt", GYRO_TIME, {"p": 1.0})
    flow.lag("r_felt", GYRO_TIME, {"r": 1.0})
    _roll(flow, flight, params)
    _yaw(flow, flight, params)


def _airframe(flow: SignalFlow, flight: FlightCondition, also: tuple[str, ...] = ()) -> None:
    model = flight.lateral
    flow.airframe(model, ("v", "p", "r", "phi", *also), IN_AIR)
    force = {by: model.slope("v", by) for by in ("v", *model.inputs)}
    flow.lag("side_force", FORCE_TIME, force | {"gust_v": -force["v"]})


def _motion(flow: SignalFlow, flight: FlightCondition) -> None:
    along, across = flight.airspeed * math.cos(flight.alpha), -flight.airspeed * math.sin(flight.alpha)
    flow.integral("aside", {"psi": along, "phi": across, "v": 1.0})
    flow.equal("off", {name: value / flight.ground_speed for name, value in (("psi", along), ("phi", across), ("v", 1.0))})


def _guidance(flow: SignalFlow, flight: FlightCondition, params: AirParams) -> None:
    speed = flight.ground_speed
    slope = params.chi_inf * 2 / math.pi * params.k_path * params.trim_airspeed / speed
    flow.integral("path_trim", {"off": -params.course_i, "aside": -params.course_i * slope})
    rate = {"off": -slope * speed - params.course_p, "aside": -params.course_p * slope, "path_trim": 1.0}
    flow.equal("bank", {name: value * speed / GRAVITY for name, value in rate.items()})


def _roll(flow: SignalFlow, flight: FlightCondition, params: AirParams) -> None:
    scale, asked = _scale(flight, params), {"bank": 1 / params.roll_time, "phi": -1 / params.roll_time}
    error = asked | {"p_felt": -1.0}
    flow.integral("roll_trim", {name: params.roll_i * value for name, value in error.items()})
    moving = {name: math.sqrt(scale) * params.roll_ff * value for name, value in asked.items()}
    moving = {name: moving.get(name, 0.0) + scale * params.roll_p * value for name, value in error.items()}
    moving["phi"] += _held(flight, params) * params.aileron_turn
    flow.equal("aileron_asked", moving | {"roll_trim": scale})


def has_rudder(flight: FlightCondition) -> bool:
    """Whether there is one: flying wings have none."""
    return any(flight.lateral.slope(of, "delta_r") for of in ("v", "p", "r"))


def loops_of(flight: FlightCondition) -> dict[str, str]:
    """LOOPS, as far as this aircraft has them."""
    return {name: at for name, at in LOOPS.items() if name != "yaw" or has_rudder(flight)}


def _yaw(flow: SignalFlow, flight: FlightCondition, params: AirParams) -> None:
    scale = _scale(flight, params)
    if not has_rudder(flight):
        for signal in ("slip_trim", "rudder_asked"):
            flow.equal(signal, {})
        return
    flow.integral("slip_trim", {"side_force": params.slip_i, "rudder_asked": -params.slip_i * params.rudder_force / scale})
    ahead = _held(flight, params) * (params.rudder_turn - params.rudder_mix * params.aileron_turn)
    damped = {"r_felt": scale * params.yaw_damping, "phi": ahead - scale * params.yaw_damping * _turning(flight), "slip_trim": scale}
    flow.equal("rudder_asked", damped | {"aileron_asked": params.rudder_mix})


def _turning(flight: FlightCondition) -> float:
    """Yaw rate [rad/s] of a coordinated turn per rad of bank."""
    return GRAVITY / flight.airspeed


def _held(flight: FlightCondition, params: AirParams) -> float:
    """The same for what holds against damping, which goes with airspeed, not with its square."""
    return math.sqrt(_scale(flight, params)) * _turning(flight)


def rudder_of_roll(flight: FlightCondition) -> float:
    """Rudder per aileron, within +-1, of a steady roll that does not yaw: against what the ailerons and the rate of the roll yaw."""
    side = flight.lateral
    power, rolling = side.slope("r", "delta_r"), -side.slope("p", "delta_a") / min(side.slope("p", "p"), -LEAST_DAMPING)
    mix = -(side.slope("r", "delta_a") + side.slope("r", "p") * rolling) / power if power else 0.0
    return min(max(mix, -1.0), 1.0)


def _scale(flight: FlightCondition, params: AirParams) -> float:
    """Dynamic pressure at the trim airspeed over that of the condition."""
    return (params.trim_airspeed / flight.eas) ** 2
