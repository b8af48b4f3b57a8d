"""Gains that hold an aircraft to its path with as little motion of its surfaces as that takes, within margins at every airspeed.

What is made small is the error in moderate turbulence and after disturbances that no model has, and the way of the surfaces there.
The margins count as walls. Searched by Nelder and Mead's simplex over the logarithms of the gains (scipy), a few times anew from
where it ended, begun with the best of several rules of thumb.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import msgspec
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from uvf.control.design.aircraft_loops import AircraftLoops
from uvf.control.design.design_axes import OMEGA, Axis, Build, as_in_cruise, axes, final_axes
from uvf.control.design.flight_condition import ActuatorDelays, FlightCondition
from uvf.control.design.gain_start import starts
from uvf.control.design.margins import margins
from uvf.control.design.signal_flow import SignalFlow
from uvf.models.vehicle.flight_params import AirParams

GAIN, PHASE, PEAK = 6.0, 45.0, 2.0  # dB, deg, sensitivity: what every loop has at least
RESERVE = 1.08  # of the margins, that is aimed at
TRIALS = (600, 500, 400)  # evaluations of each simplex; the last with what is hardest
FLOOR = (2.5, 15.0, 4.0)  # dB, deg, sensitivity: what is left when the aircraft is not what its model says
HARDEST = 4  # of such aircraft that are designed for
ROUNDS, MOST_ROUNDS = 3, 6  # how often others are found that are harder by then; more often only while one is unstable
UNSTABLE = 1e3  # cost of a pole on the right
NOTHING = 1e-9  # of a loop's gain: it is not closed
FIRST = 0.4  # of the simplex, in logarithms

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class RequiredMargins:
    """Margins that a flight's loops are to keep, with these delays."""

    build: Build
    flight: FlightCondition
    delays: ActuatorDelays
    gain: float = GAIN * RESERVE  # dB
    phase: float = PHASE * RESERVE  # deg
    peak: float = PEAK / RESERVE

    def flow(self, params: AirParams) -> SignalFlow:
        """The loops of that flight."""
        return self.build(self.flight, self.delays, params)

    def lacking(self, flow: SignalFlow, opened: Iterable[str]) -> float:
        """What the loops lack of their margins, squared and weighted; 0 where they have them."""
        if poles := flow.unstable:
            return UNSTABLE * abs(poles)
        lack = 0.0
        for at in opened:
            loop = flow.loop(at)
            if np.abs(loop).max() < NOTHING:
                continue
            found = margins(OMEGA, loop)
            lack += 10 * max(found.peak - self.peak, 0.0) ** 2
            lack += 0.0 if np.isnan(found.gain) else max(self.gain - abs(found.gain_db), 0.0) ** 2
            lack += 0.0 if np.isnan(found.phase) else max(self.phase - np.degrees(abs(found.phase)), 0.0) ** 2 / 25
        return lack


def designed(aircraft: AircraftLoops, params: AirParams, firmness: float = 1.0) -> AirParams:
    """The parameters with all gains designed, from those of ``begun``.

    firmness: above 1 errors count more, the motion of the surfaces less. First for the aircraft as its model has it,
    then again with the flights of ``AircraftLoops.spread`` that are nearest to instability.
    """
    for axis in axes(aircraft, params, firmness):
        params = _designed(aircraft, params, axis)
    params = as_in_cruise(params)
    for axis in final_axes(aircraft, params, firmness):
        params = _designed(aircraft, params, axis)
    return params


def _designed(aircraft: AircraftLoops, params: AirParams, axis: Axis) -> AirParams:
    walls = list(_walls(axis, ((flight, aircraft.delays) for flight in aircraft.conditions)))
    cruise = min(range(len(walls)), key=lambda i: abs(walls[i].flight.airspeed - params.trim_airspeed))
    params = min(starts(params, axis), key=lambda start: _priced(start, axis, walls, cruise))
    for trials in TRIALS[:-1]:
        params = _searched(params, axis, walls, cruise, trials)
    spread = list(_walls(axis, aircraft.spread(), *FLOOR))
    for number in range(MOST_ROUNDS):
        spread.sort(key=lambda wall: -_lacking(wall, axis, params))
        walls, spread = walls + spread[:HARDEST], spread[HARDEST:]
        params = _searched(params, axis, walls, cruise, TRIALS[-1])
        worst = max((_lacking(wall, axis, params) for wall in spread), default=0.0)
        if worst == 0.0 or (number + 1 >= ROUNDS and worst < UNSTABLE):
            break
    return params


def _walls(axis: Axis, flown: Iterable[tuple[FlightCondition, ActuatorDelays]], *least: float) -> Iterator[RequiredMargins]:
    """Of each flight first that of the axis itself: by that in cruise errors are priced."""
    for flight, delays in flown:
        if flight.airspeed < axis.fastest:
            yield RequiredMargins(axis.build, flight, delays, *least)
        if axis.also is not None:
            yield RequiredMargins(axis.also, flight, delays, *least)


def _lacking(wall: RequiredMargins, axis: Axis, params: AirParams) -> float:
    return wall.lacking(wall.flow(params), axis.opened.values())


def _priced(params: AirParams, axis: Axis, walls: Sequence[RequiredMargins], cruise: int) -> float:
    flows = [wall.flow(params) for wall in walls]
    lack = sum(wall.lacking(flow, axis.opened.values()) for wall, flow in zip(walls, flows, strict=True))
    return axis.wanted(flows[cruise]) + lack


def _searched(params: AirParams, axis: Axis, walls: Sequence[RequiredMargins], cruise: int, trials: int) -> AirParams:
    names = list(axis.gains)
    low, high = np.log(np.array(list(axis.gains.values())).T)
    signs = np.array([-1.0 if getattr(params, name) < 0 else 1.0 for name in names])

    def made(x: Vector) -> AirParams:
        values = (signs * np.exp(np.clip(x, low, high))).tolist()
        return msgspec.structs.replace(params, **dict(zip(names, values, strict=True)))

    def priced(x: Vector) -> float:
        return _priced(made(x), axis, walls, cruise) + float(np.sum((np.clip(x, low, high) - x) ** 2))

    x: Vector = np.clip(np.log(np.maximum([abs(getattr(params, name)) for name in names], 1e-9)), low, high)
    simplex = np.vstack((x, x + FIRST * np.eye(len(x))))
    options = {"maxfev": trials, "fatol": 1e-3, "xatol": 1e-2, "initial_simplex": simplex}
    return made(minimize(priced, x, method="Nelder-Mead", options=options).x)
