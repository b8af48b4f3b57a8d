"""Loops that are designed together, the limits of their gains, and what is made small: errors and the way of the surfaces in turbulence.

Each error and each way counts as a share of a budget. Near the ground comfort does not count.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import msgspec
import numpy as np

from uvf.control.design import lateral_loops, longitudinal_loops
from uvf.control.design.aircraft_loops import FINAL_UP_TO, AircraftLoops
from uvf.control.design.flight_condition import ActuatorDelays, FlightCondition
from uvf.control.design.signal_flow import Floats, SignalFlow
from uvf.control.flight_control import on_final
from uvf.maths.dryden import W20, spectra, strength
from uvf.models.vehicle.flight_params import AirParams

OMEGA: Floats = np.geomspace(0.02, 150.0, 110)  # rad/s
TURBULENCE, HEIGHT = "moderate", 100.0  # m
BANK_OFF, PITCH_OFF = (0.05, 1.0), (0.01, 5.0)
"""rad and s: disturbances that come on bank and pitch, and how long they last."""
LASTING = {"bank": (0.025, 20.0), "rudder_asked": (0.01, 20.0)}
"""The same of what is off for as long as a turn: its feed-forward is not that of this aircraft, a propeller's torque changes."""
MIX = 0.25  # least share of the rudder that a steady roll needs; for gusts alone the search would take none
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
    "climb_i": (0.1, 1.0),
    "altitude_p": (0.05, 2.0),
    "airspeed_p": (0.08, 2.0),
    "power_pole": (0.15, 5.0),
}
BY_PITCH = {"airspeed_pitch_p": (0.08, 2.0)}
FINAL_LATERAL = ("roll_time", "roll_p", "roll_i", "course_p", "k_path")
FINAL_LONGITUDINAL = ("climb_p", "pitch_time", "pitch_p", "pitch_i")
"""Those that the final approach has of its own, called ``final_*``; and ``flare_p``."""
FLARE = {"flare_p": (0.2, 2.5)}
FINAL = (*(f"final_{name}" for name in (*FINAL_LATERAL, *FINAL_LONGITUDINAL)), *FLARE)
GAINS = (*LATERAL, "rudder_mix", *LONGITUDINAL, *BY_PITCH, *FINAL)
"""Gains that are searched for, within these limits in their own units; that of ``rudder_mix`` is the aircraft's own."""
OF_RUDDER = ("yaw_damping", "slip_i")
LATERAL_STARTS = ({"yaw_damping": (1.0, 4.0)}, {"rudder_mix": (1.0, 0.5, MIX)}, {"course_p": (1.0, 0.4), "k_path": (1.0, 0.4)})
FULL_THROTTLE_STARTS = ({"airspeed_pitch_p": (1.0, 0.3)},)
LONGITUDINAL_STARTS = ({"pitch_p": (1.0, 3.0)}, {"pitch_i": (1.0, 0.3)}, {"climb_p": (1.0, 0.4)}, {"altitude_p": (1.0, 0.4)})
"""Factors of the gains of a rule of thumb, of which the best are begun with: aircraft differ most in these."""
STIFF = {"roll_p": 0.15, "roll_i": 0.3, "pitch_p": 0.3, "pitch_i": 1.0}
"""Least gains of the rate loops, as shares of the feed-forward (those of ``_i``: 1/s), where an attitude is to be held by itself, too."""
LEARNING = 0.4  # 1/s, of the least pitch_i on a path: an elevator that sits 0.1 rad off costs metres, not tens of them
STEEP = 0.3  # 1/s, with which a path is approached at least
SLOWEST, SLOWER = 0.5, 4.0  # s, and of the delays: the longest time constant of an attitude there
ASIDE, ABOVE, FASTER = 0.5, 0.5, 0.7  # m, m, m/s: errors in turbulence, each worth as much as the surfaces' whole budget
LASTING_ASIDE = 0.5  # m, of ASIDE's kind: an error that is there in calm, too
SHORT_OF_POWER = 2.0  # m/s, of the airspeed while the throttle is at its stop, where the height counts, too
DESIGN_SPEED = 20.0  # m/s, up to which lengths are those; they grow with a higher one
FINAL_SHARE, FINAL_WAY = 0.3, 3.0  # of ABOVE, of PITCH_WAY: budgets near the ground
LEVEL = 0.05  # rad of bank in turbulence, worth a whole budget there
FLARES = 1.5  # times altitude_p, to begin with
ROLL_WAY, PITCH_WAY, THROTTLE_WAY = 5.0, 3.0, 0.3  # deg/s of ailerons and rudder, of the elevator; 1/s: budgets of their way there
LARGEST = 4  # power of a share: what lies well within its budget is not worth much
WAY = np.degrees(np.sqrt(2 / np.pi))  # mean size of a normal number, in deg

Limits = tuple[float, float]
Build = Callable[[FlightCondition, ActuatorDelays, AirParams], SignalFlow]


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
class Axis:
    """Loops that are designed together: their gains with limits, how they are built, and what is made small in cruise."""

    gains: Mapping[str, Limits]
    opened: Mapping[str, str]
    build: Build
    wanted: Callable[[SignalFlow], float]
    starts: Sequence[Mapping[str, Sequence[float]]] = ()  # factors of the gains, to begin with; those of one mapping go together
    fastest: float = np.inf  # m/s, up to which it is flown so
    also: Build | None = None  # built so, they are to have margins at every airspeed, too


def axes(aircraft: AircraftLoops, params: AirParams, firmness: float = 1.0) -> list[Axis]:
    """Lateral and longitudinal loops in cruise; firmness: above 1 errors count more, the motion of the surfaces less.

    With an engine there is a third: pitch that holds the airspeed while the throttle is at its stop, with the gains of the second.
    """
    across = _lateral(aircraft, params, firmness)
    if not aircraft.powered:
        return [across, _gliding(aircraft, params, firmness)]
    return [across, _longitudinal(aircraft, params, firmness), _at_full_throttle(aircraft, params, firmness)]


def as_in_cruise(params: AirParams) -> AirParams:
    """With the gains of the final approach from those of cruise."""
    flare = min(max(FLARES * params.altitude_p, FLARE["flare_p"][0]), FLARE["flare_p"][1])
    same = {f"final_{name}": getattr(params, name) for name in (*FINAL_LATERAL, *FINAL_LONGITUDINAL)}
    return msgspec.structs.replace(params, flare_p=flare, **same)


def _air(aircraft: AircraftLoops, params: AirParams) -> Gusts:
    flight = _cruise(aircraft, params)
    return Gusts(spectra(OMEGA, strength(HEIGHT, W20[TURBULENCE], TURBULENCE), flight.airspeed, flight.span))


def _cruise(aircraft: AircraftLoops, params: AirParams) -> FlightCondition:
    return min(aircraft.conditions, key=lambda flight: abs(flight.airspeed - params.trim_airspeed))


def longer(airspeed: float) -> float:
    """How much longer errors may be that are lengths, at a cruise speed [m/s]."""
    return max(1.0, airspeed / DESIGN_SPEED)


def _lateral(aircraft: AircraftLoops, params: AirParams, firmness: float = 1.0) -> Axis:
    air, length = _air(aircraft, params), longer(params.trim_airspeed)

    def wanted(flow: SignalFlow) -> float:
        error, way = _aside(air, flow)
        lasting = _lasting(flow) / (length * LASTING_ASIDE)
        return _within(firmness * error / (length * ASIDE), firmness * lasting, way / ROLL_WAY)

    gains = LATERAL | _inner("roll", aircraft.delays.total("aileron"), params.roll_ff, LATERAL)
    if not lateral_loops.has_rudder(_cruise(aircraft, params)):
        gains = {name: limits for name, limits in gains.items() if name not in OF_RUDDER}
    gains["k_path"] = STEEP / (params.trim_airspeed * params.chi_inf * 2 / np.pi), LATERAL["k_path"][1]
    if mix := abs(lateral_loops.rudder_of_roll(_cruise(aircraft, params))):
        gains["rudder_mix"] = (MIX * mix, mix)
    return Axis(gains, lateral_loops.LOOPS, partial(lateral_loops.lateral_flow, OMEGA), wanted, LATERAL_STARTS)


def _longitudinal(aircraft: AircraftLoops, params: AirParams, firmness: float = 1.0) -> Axis:
    air, above = _air(aircraft, params), ABOVE * longer(params.trim_airspeed)

    def wanted(flow: SignalFlow) -> float:
        error, way = _above(air, flow)
        throttle = np.sqrt(2 / np.pi) * air.rms(flow, "servo_t", "uwq", rate=True)
        return _within(firmness * error / above, air.rms(flow, "airspeed", "uwq") / FASTER, way / PITCH_WAY, throttle / THROTTLE_WAY)

    learning = {"pitch_i": (max(LEARNING * params.pitch_ff, LONGITUDINAL["pitch_i"][0]), LONGITUDINAL["pitch_i"][1])}
    return Axis(
        LONGITUDINAL | learning, longitudinal_loops.LOOPS, partial(longitudinal_loops.longitudinal_flow, OMEGA), wanted, LONGITUDINAL_STARTS
    )


def _gliding(aircraft: AircraftLoops, params: AirParams, firmness: float = 1.0) -> Axis:
    gains = {name: limits for name, limits in LONGITUDINAL.items() if name not in ("altitude_p", "airspeed_p")} | BY_PITCH
    gains |= _inner("pitch", aircraft.delays.total("elevator"), params.pitch_ff, LONGITUDINAL)
    return _by_pitch(aircraft, params, FASTER / firmness, gains, longitudinal_loops.GLIDING, LONGITUDINAL_STARTS)


def _at_full_throttle(aircraft: AircraftLoops, params: AirParams, firmness: float) -> Axis:
    return _by_pitch(aircraft, params, SHORT_OF_POWER / firmness, BY_PITCH, longitudinal_loops.AT_FULL_THROTTLE, FULL_THROTTLE_STARTS)


def _by_pitch(
    aircraft: AircraftLoops,
    params: AirParams,
    faster: float,
    gains: Mapping[str, Limits],
    opened: Mapping[str, str],
    starts: Sequence[Mapping[str, Sequence[float]]],
) -> Axis:
    """Pitch holds the airspeed; faster: its error [m/s] that is worth a whole budget of the elevator."""
    air = _air(aircraft, params)

    def wanted(flow: SignalFlow) -> float:
        error = np.hypot(air.rms(flow, "airspeed", "uwq"), disturbed(flow, "airspeed", "pitch", *PITCH_OFF))
        return _within(float(error) / faster, WAY * air.rms(flow, "servo_e", "uwq", rate=True) / PITCH_WAY)

    return Axis(gains, opened, partial(longitudinal_loops.gliding_flow, OMEGA), wanted, starts)


def _aside(air: Gusts, flow: SignalFlow) -> tuple[float, float]:
    """Error beside the path [m] in gusts and after disturbances of bank, and the way of ailerons and rudder [deg/s]."""
    error = math.hypot(air.rms(flow, "aside", "vpr"), disturbed(flow, "aside", "bank", *BANK_OFF))
    return error, WAY * sum(air.rms(flow, surface, "vpr", rate=True) for surface in ("servo_a", "servo_r"))


def _lasting(flow: SignalFlow) -> float:
    """Error beside the path [m] after disturbances that last."""
    return math.hypot(*(disturbed(flow, "aside", at, *by) for at, by in LASTING.items()))


def _above(air: Gusts, flow: SignalFlow) -> tuple[float, float]:
    """Error of height [m] in gusts and after disturbances of pitch, and the way of the elevator [deg/s]."""
    error = float(np.hypot(air.rms(flow, "h", "uwq"), disturbed(flow, "h", "pitch", *PITCH_OFF)))
    return error, WAY * air.rms(flow, "servo_e", "uwq", rate=True)


def final_axes(aircraft: AircraftLoops, params: AirParams, firmness: float) -> list[Axis]:
    """Near the ground, where comfort does not count: as stiff as the margins allow; pitch of a glider is as in cruise.

    The same gains hold an attitude that is asked for, up to the highest airspeed.
    """
    air, share = _air(aircraft, params), FINAL_SHARE * longer(params.trim_airspeed)
    roll, pitch = axes(aircraft, params)[:2]

    def beside(flow: SignalFlow) -> float:
        error, way = _aside(air, flow)
        lasting, level = _lasting(flow) / (share * LASTING_ASIDE), air.rms(flow, "phi", "vpr") / LEVEL
        return _within(firmness * error / (share * ASIDE), firmness * lasting, firmness * level, way / (FINAL_WAY * ROLL_WAY))

    def above(flow: SignalFlow) -> float:
        error, way = _above(air, flow)
        return _within(firmness * error / (share * ABOVE), way / (FINAL_WAY * PITCH_WAY))

    stiff = LONGITUDINAL | _inner("pitch", aircraft.delays.total("elevator"), params.pitch_ff, LONGITUDINAL)
    lateral = {f"final_{name}": roll.gains[name] for name in FINAL_LATERAL}
    longitudinal = {f"final_{name}": stiff[name] for name in FINAL_LONGITUDINAL} | FLARE
    fastest = FINAL_UP_TO * params.trim_airspeed
    banked, pitched = partial(lateral_loops.attitude_flow, OMEGA), partial(longitudinal_loops.attitude_flow, OMEGA)
    across = Axis(lateral, roll.opened, _finally(roll.build), beside, fastest=fastest, also=_finally(banked))
    along = Axis(longitudinal, pitch.opened, _finally(pitch.build), above, fastest=fastest, also=_finally(pitched))
    return [across, along] if aircraft.powered else [across]


def _finally(build: Build) -> Build:
    """With the gains that the final approach has of its own."""
    return lambda flight, delays, params: build(flight, delays, on_final(params))


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
