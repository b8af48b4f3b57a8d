"""Gains that hold an aircraft to its path with as little motion of its surfaces as that takes, within margins at every airspeed.

What is made small is the error in moderate turbulence and after disturbances that no model has, and the way of the surfaces there,
each as a share of a budget. The margins count as walls. Searched by Nelder and Mead's simplex over
the logarithms of the gains (scipy), a few times anew from where it ended.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import msgspec
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from uvf.control.design import lateral_loops, longitudinal_loops
from uvf.control.design.aircraft_loops import FINAL_UP_TO, AircraftLoops
from uvf.control.design.flight_condition import ActuatorDelays, FlightCondition
from uvf.control.design.margins import margins
from uvf.control.design.signal_flow import Floats, SignalFlow
from uvf.control.flight_control import on_final
from uvf.maths.dryden import W20, spectra, strength
from uvf.models.vehicle.flight_params import AirParams

OMEGA: Floats = np.geomspace(0.02, 150.0, 110)  # rad/s
TURBULENCE, HEIGHT = "moderate", 100.0  # m
GAIN, PHASE, PEAK = 6.0, 45.0, 2.0  # dB, deg, sensitivity: what every loop has at least
RESERVE = 1.08  # of the margins, that is aimed at
BANK_OFF, PITCH_OFF = (0.05, 1.0), (0.01, 5.0)  # rad and s: disturbances that come on bank and pitch, and how long they last
LATERAL = {
    "roll_time": (0.1, 2.0),
    "roll_p": (1e-4, 2.0),
    "roll_i": (1e-3, 2.0),
    "yaw_damping": (1e-3, 1.0),
    "slip_i": (1e-4, 1.0),
    "course_p": (0.1, 5.0),
    "k_path": (1e-3, 1.0),
    "course_i": (1e-3, 0.2),
}
LONGITUDINAL = {
    "pitch_time": (0.1, 2.0),
    "pitch_p": (1e-4, 2.0),
    "pitch_i": (1e-3, 2.0),
    "climb_p": (0.05, 4.0),
    "climb_i": (0.01, 1.0),
    "altitude_p": (0.05, 2.0),
    "airspeed_p": (0.2, 2.0),
    "power_pole": (0.4, 5.0),
}
FINAL_LATERAL = ("roll_time", "roll_p", "roll_i", "course_p", "k_path")
FINAL_LONGITUDINAL = ("climb_p", "pitch_time", "pitch_p", "pitch_i")
"""Those that the final approach has of its own, called ``final_*``; and ``flare_p``."""
FLARE = {"flare_p": (0.2, 2.5)}
FINAL = (*(f"final_{name}" for name in (*FINAL_LATERAL, *FINAL_LONGITUDINAL)), *FLARE)
"""Gains that are searched for, within these limits in their own units."""
TRIALS = (600, 500, 400)  # evaluations of each simplex; the last with what is hardest
SOFTER = (1.0, 1.5, 2.2, 3.3, 5.0, 7.5)  # times the time constants to begin with, until the loops are stable
STIFF = {"roll_p": 0.15, "roll_i": 0.3, "pitch_p": 0.3, "pitch_i": 1.0}
"""Least gains of the rate loops, as shares of the feed-forward (those of ``_i``: 1/s): an attitude is to be held by itself, too."""
STEEP = 0.3  # 1/s, with which a path is approached at least
SLOWEST, SLOWER = 0.5, 4.0  # s, and of the delays: the longest time constant of an attitude
FLOOR = (2.5, 15.0, 4.0)  # dB, deg, sensitivity: what is left when the aircraft is not what its model says
HARDEST, ROUNDS = 4, 3  # of such aircraft that are designed for; how often others are found that are harder by then
ASIDE, ABOVE, FASTER = 0.5, 0.5, 0.7  # m, m, m/s: errors in turbulence, each worth as much as the surfaces' whole budget
FINAL_SHARE, FINAL_WAY = 0.3, 3.0  # of ABOVE, of PITCH_WAY: budgets near the ground
LEVEL = 0.05  # rad of bank in turbulence, worth a whole budget there
FLARES = 1.5  # times altitude_p, to begin with
ROLL_WAY, PITCH_WAY, THROTTLE_WAY = 5.0, 3.0, 0.3  # deg/s of ailerons and rudder, of the elevator; 1/s: budgets of their way there
LARGEST = 4  # power of a share: what lies well within its budget is not worth much
UNSTABLE = 1e3  # cost of a pole on the right
FIRST = 0.4  # of the simplex, in logarithms
WAY = np.degrees(np.sqrt(2 / np.pi))  # mean size of a normal number, in deg

Vector = NDArray[np.float64]
Limits = tuple[float, float]


@dataclass(frozen=True)
class Gusts:
    """Spectra of the gusts at OMEGA, by name."""

    spectra: Mapping[str, Floats]

    def rms(self, flow: SignalFlow, output: str, names: str, rate: bool = False) -> float:
        """Of a signal in gusts of these names; rate: of how fast it moves."""
        power = sum(np.abs(flow.response(output, f"gust_{name}")) ** 2 * self.spectra[name] for name in names)
        return float(np.sqrt(np.trapezoid(power * (OMEGA**2 if rate else 1.0), OMEGA)))


def disturbed(flow: SignalFlow, output: str, at: str, size: float, time: float) -> float:
    """RMS of a signal under a first-order random disturbance of ``size`` (RMS) and ``time`` [s] that is added at another."""
    power = size**2 * 2 * time / np.pi / (1 + (time * OMEGA) ** 2)
    return float(np.sqrt(np.trapezoid(np.abs(flow.closed(output, at)) ** 2 * power, OMEGA)))


@dataclass(frozen=True)
class RequiredMargins:
    """Margins that a flight's loops are to keep, with these delays."""

    flight: FlightCondition
    delays: ActuatorDelays
    gain: float = GAIN * RESERVE  # dB
    phase: float = PHASE * RESERVE  # deg
    peak: float = PEAK / RESERVE

    def lacking(self, flow: SignalFlow, opened: Iterable[str]) -> float:
        """What the loops lack of their margins, squared and weighted; 0 where they have them."""
        if poles := flow.unstable:
            return UNSTABLE * abs(poles)
        lack = 0.0
        for at in opened:
            found = margins(OMEGA, flow.loop(at))
            lack += 10 * max(found.peak - self.peak, 0.0) ** 2
            lack += 0.0 if np.isnan(found.gain) else max(self.gain - abs(found.gain_db), 0.0) ** 2
            lack += 0.0 if np.isnan(found.phase) else max(self.phase - np.degrees(abs(found.phase)), 0.0) ** 2 / 25
        return lack


@dataclass(frozen=True)
class Axis:
    """Loops that are designed together: their gains with limits, how they are built, and what is made small in cruise."""

    gains: Mapping[str, Limits]
    opened: Mapping[str, str]
    build: Callable[[FlightCondition, ActuatorDelays, AirParams], SignalFlow]
    wanted: Callable[[SignalFlow], float]
    fastest: float = np.inf  # m/s, up to which it is flown so


def designed(aircraft: AircraftLoops, params: AirParams, firmness: float = 1.0) -> AirParams:
    """The parameters with all gains designed, from those of ``begun``.

    firmness: above 1 errors count more, the motion of the surfaces less. First for the aircraft as its model has it,
    then again with the flights of ``AircraftLoops.spread`` that are nearest to instability.
    """
    for axis in _axes(aircraft, params, firmness):
        params = _designed(aircraft, params, axis)
    params = as_in_cruise(params)
    for axis in _final(aircraft, params, firmness):
        params = _designed(aircraft, params, axis)
    return params


def _designed(aircraft: AircraftLoops, params: AirParams, axis: Axis) -> AirParams:
    walls = [RequiredMargins(flight, aircraft.delays) for flight in aircraft.conditions if flight.airspeed < axis.fastest]
    cruise = min(range(len(walls)), key=lambda i: abs(walls[i].flight.airspeed - params.trim_airspeed))
    for trials in TRIALS[:-1]:
        params = _searched(params, axis, walls, cruise, trials)
    spread = [RequiredMargins(*off, *FLOOR) for off in aircraft.spread() if off[0].airspeed < axis.fastest]
    for _ in range(ROUNDS):
        spread.sort(key=lambda wall: -_lacking(wall, axis, params))
        walls, spread = walls + spread[:HARDEST], spread[HARDEST:]
        params = _searched(params, axis, walls, cruise, TRIALS[-1])
        if not any(_lacking(wall, axis, params) for wall in spread):
            break
    return params


def as_in_cruise(params: AirParams) -> AirParams:
    """With the gains of the final approach from those of cruise."""
    flare = min(max(FLARES * params.altitude_p, FLARE["flare_p"][0]), FLARE["flare_p"][1])
    same = {f"final_{name}": getattr(params, name) for name in (*FINAL_LATERAL, *FINAL_LONGITUDINAL)}
    return msgspec.structs.replace(params, flare_p=flare, **same)


def begun(aircraft: AircraftLoops, params: AirParams) -> AirParams:
    """Gains by rule of thumb: of each axis the first that are stable at every airspeed, quickest first."""
    for axis in _axes(aircraft, params):
        for softer in SOFTER:
            first = _first(aircraft, params, softer)
            limited = {name: min(max(first[name], low), high) for name, (low, high) in axis.gains.items() if name in first}
            params = msgspec.structs.replace(params, **limited)
            if not any(axis.build(flight, aircraft.delays, params).unstable for flight in aircraft.conditions):
                break
    return as_in_cruise(params)


def _axes(aircraft: AircraftLoops, params: AirParams, firmness: float = 1.0) -> tuple[Axis, Axis]:
    return _lateral(aircraft, params, firmness), _longitudinal(aircraft, params, firmness)


def _lacking(wall: RequiredMargins, axis: Axis, params: AirParams) -> float:
    return wall.lacking(axis.build(wall.flight, wall.delays, params), axis.opened.values())


def _air(aircraft: AircraftLoops, params: AirParams) -> Gusts:
    flight = _cruise(aircraft, params)
    return Gusts(spectra(OMEGA, strength(HEIGHT, W20[TURBULENCE], TURBULENCE), flight.airspeed, flight.span))


def _cruise(aircraft: AircraftLoops, params: AirParams) -> FlightCondition:
    return min(aircraft.conditions, key=lambda flight: abs(flight.airspeed - params.trim_airspeed))


def _lateral(aircraft: AircraftLoops, params: AirParams, firmness: float = 1.0) -> Axis:
    air = _air(aircraft, params)

    def wanted(flow: SignalFlow) -> float:
        error, way = _aside(air, flow)
        return _within(firmness * error / ASIDE, way / ROLL_WAY)

    gains = LATERAL | _inner("roll", aircraft.delays.total("aileron"), params.roll_ff, LATERAL)
    gains["k_path"] = STEEP / (params.trim_airspeed * params.chi_inf * 2 / np.pi), LATERAL["k_path"][1]
    if params.rudder_mix:
        gains["rudder_mix"] = (1e-3, abs(params.rudder_mix))
    return Axis(gains, lateral_loops.LOOPS, partial(lateral_loops.lateral_flow, OMEGA), wanted)


def _longitudinal(aircraft: AircraftLoops, params: AirParams, firmness: float = 1.0) -> Axis:
    air = _air(aircraft, params)

    def wanted(flow: SignalFlow) -> float:
        error, way = _above(air, flow)
        throttle = np.sqrt(2 / np.pi) * air.rms(flow, "servo_t", "uwq", rate=True) if aircraft.powered else 0.0
        return _within(firmness * error / ABOVE, air.rms(flow, "airspeed", "uwq") / FASTER, way / PITCH_WAY, throttle / THROTTLE_WAY)

    gains = LONGITUDINAL | _inner("pitch", aircraft.delays.total("elevator"), params.pitch_ff, LONGITUDINAL)
    loops = dict(longitudinal_loops.LOOPS)
    if not aircraft.powered:
        del loops["airspeed"], gains["airspeed_p"], gains["power_pole"]
    return Axis(gains, loops, partial(longitudinal_loops.longitudinal_flow, OMEGA, given_throttle=not aircraft.powered), wanted)


def _aside(air: Gusts, flow: SignalFlow) -> tuple[float, float]:
    """Error beside the path [m] in gusts and after disturbances of bank, and the way of ailerons and rudder [deg/s]."""
    error = float(np.hypot(air.rms(flow, "aside", "vpr"), disturbed(flow, "aside", "bank", *BANK_OFF)))
    return error, WAY * sum(air.rms(flow, surface, "vpr", rate=True) for surface in ("servo_a", "servo_r"))


def _above(air: Gusts, flow: SignalFlow) -> tuple[float, float]:
    """Error of height [m] in gusts and after disturbances of pitch, and the way of the elevator [deg/s]."""
    error = float(np.hypot(air.rms(flow, "h", "uwq"), disturbed(flow, "h", "pitch", *PITCH_OFF)))
    return error, WAY * air.rms(flow, "servo_e", "uwq", rate=True)


def _final(aircraft: AircraftLoops, params: AirParams, firmness: float) -> tuple[Axis, Axis]:
    """Near the ground, where comfort does not count: as stiff as the margins allow."""
    air = _air(aircraft, params)
    roll, pitch = _axes(aircraft, params)

    def beside(flow: SignalFlow) -> float:
        error, way = _aside(air, flow)
        level = air.rms(flow, "phi", "vpr") / LEVEL
        return _within(firmness * error / (FINAL_SHARE * ASIDE), firmness * level, way / (FINAL_WAY * ROLL_WAY))

    def above(flow: SignalFlow) -> float:
        error, way = _above(air, flow)
        return _within(firmness * error / (FINAL_SHARE * ABOVE), way / (FINAL_WAY * PITCH_WAY))

    lateral = {f"final_{name}": roll.gains[name] for name in FINAL_LATERAL}
    longitudinal = {f"final_{name}": pitch.gains[name] for name in FINAL_LONGITUDINAL} | FLARE
    return _as_final(roll, lateral, beside, params), _as_final(pitch, longitudinal, above, params)


def _as_final(axis: Axis, gains: Mapping[str, Limits], wanted: Callable[[SignalFlow], float], params: AirParams) -> Axis:
    """The axis of cruise with the ``gains`` that are its own on the final approach."""

    def build(flight: FlightCondition, delays: ActuatorDelays, params: AirParams) -> SignalFlow:
        return axis.build(flight, delays, on_final(params))

    return Axis(gains, axis.opened, build, wanted, FINAL_UP_TO * params.trim_airspeed)


def _inner(axis: str, delay: float, ahead: float, gains: Mapping[str, Limits]) -> dict[str, Limits]:
    """Limits of the inner loop's gains, by the delay [s] of its surface and its feed-forward."""
    low, high = gains[f"{axis}_time"]
    found = {f"{axis}_time": (low, min(max(SLOWEST, SLOWER * delay), high))}
    for name in (f"{axis}_p", f"{axis}_i"):
        low, high = gains[name]
        found[name] = min(max(STIFF[name] * ahead, low), high), high
    return found


def _within(*shares: float) -> float:
    """What is made small: each error and each way as a share of its budget, the largest almost alone."""
    return float(np.log(np.sum(np.power(shares, LARGEST))) / 2)


def _first(aircraft: AircraftLoops, params: AirParams, softer: float) -> dict[str, float]:
    """By rule of thumb: each loop some times slower than what it stands on."""
    roll, pitch = (softer * 2.5 * aircraft.delays.total(name) for name in ("aileron", "elevator"))
    path = 0.3 / roll
    return {
        "roll_time": roll,
        "roll_p": 0.3 * params.roll_ff / softer,
        "roll_i": 0.5 * params.roll_ff / softer,
        "yaw_damping": 0.05 / softer,
        "slip_i": 0.003 / softer,
        "course_p": path,
        "k_path": path / (params.trim_airspeed * params.chi_inf * 2 / np.pi),
        "course_i": 0.05 * path**2,
        "pitch_time": pitch,
        "pitch_p": 0.7 * params.pitch_ff / softer,
        "pitch_i": 1.5 * params.pitch_ff / softer,
        "climb_p": 1.0 / softer,
        "climb_i": 0.2 / softer**2,
        "altitude_p": 0.5 / softer,
        "airspeed_p": 0.8 / softer,
        "power_pole": 0.5 / softer,
    }


def _searched(params: AirParams, axis: Axis, walls: Sequence[RequiredMargins], cruise: int, trials: int) -> AirParams:
    names = list(axis.gains)
    low, high = np.log(np.array(list(axis.gains.values())).T)
    signs = np.array([-1.0 if getattr(params, name) < 0 else 1.0 for name in names])

    def made(x: Vector) -> AirParams:
        values = (signs * np.exp(np.clip(x, low, high))).tolist()
        return msgspec.structs.replace(params, **dict(zip(names, values, strict=True)))

    def priced(x: Vector) -> float:
        now = made(x)
        flows = [axis.build(wall.flight, wall.delays, now) for wall in walls]
        lack = sum(wall.lacking(flow, axis.opened.values()) for wall, flow in zip(walls, flows, strict=True))
        return axis.wanted(flows[cruise]) + lack + float(np.sum((np.clip(x, low, high) - x) ** 2))

    x: Vector = np.clip(np.log(np.maximum([abs(getattr(params, name)) for name in names], 1e-9)), low, high)
    simplex = np.vstack((x, x + FIRST * np.eye(len(x))))
    options = {"maxfev": trials, "fatol": 1e-3, "xatol": 1e-2, "initial_simplex": simplex}
    return made(minimize(priced, x, method="Nelder-Mead", options=options).x)
