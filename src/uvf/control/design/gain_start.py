"""Gains by rule of thumb, to begin with: each loop some times slower than what it stands on."""

import math
from collections.abc import Iterator
from itertools import product

import msgspec

from uvf.control.design.aircraft_loops import AircraftLoops
from uvf.control.design.design_axes import Axis, Limits, as_in_cruise, axes
from uvf.models.vehicle.flight_params import AirParams

SOFTER = (1.0, 1.5, 2.2, 3.3, 5.0, 7.5)  # times the time constants, until the loops are stable


def begun(aircraft: AircraftLoops, params: AirParams) -> AirParams:
    """Gains by rule of thumb: of each axis the first that are stable at every airspeed, quickest first."""
    for axis in axes(aircraft, params):
        for softer in SOFTER:
            first = _first(aircraft, params, softer)
            limited = {name: _within_limits(first[name], limits) for name, limits in axis.gains.items() if name in first}
            params = msgspec.structs.replace(params, **limited)
            stable = (start for start in starts(params, axis) if not _unstable(aircraft, axis, start))
            if (found := next(stable, None)) is not None:
                params = found
                break
    return as_in_cruise(params)


def starts(params: AirParams, axis: Axis) -> Iterator[AirParams]:
    """The parameters with each of the axis' factors, within its limits."""
    columns = [[dict(zip(one, row, strict=True)) for row in zip(*one.values(), strict=True)] for one in axis.starts]
    for factors in ({name: factor for part in parts for name, factor in part.items()} for parts in product(*columns)):
        made = {name: factor * getattr(params, name) for name, factor in factors.items() if name in axis.gains}
        limited = {name: math.copysign(_within_limits(abs(value), axis.gains[name]), value) for name, value in made.items()}
        yield msgspec.structs.replace(params, **limited)


def _within_limits(value: float, limits: Limits) -> float:
    return min(max(value, limits[0]), limits[1])


def _unstable(aircraft: AircraftLoops, axis: Axis, params: AirParams) -> bool:
    return any(axis.build(flight, aircraft.delays, params).unstable for flight in aircraft.conditions)


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
        "k_path": path / (params.trim_airspeed * params.chi_inf * 2 / math.pi),
        "course_i": 0.05 * path**2,
        "pitch_time": pitch,
        "pitch_p": 0.7 * params.pitch_ff / softer,
        "pitch_i": 1.5 * params.pitch_ff / softer,
        "climb_p": 1.0 / softer,
        "climb_i": 0.2 / softer**2,
        "altitude_p": 0.5 / softer,
        "airspeed_p": 0.8 / softer,
        "airspeed_pitch_p": 0.2 / softer,
        "power_pole": 0.5 / softer,
    }
