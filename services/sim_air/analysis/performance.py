"""What an aircraft can do, from steady flights of the running model: glide, slowest flight, climb, endurance."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from services.sim_air.analysis.equilibrium import Condition, find
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import Held
from services.sim_air.engine.wiring import Controls
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.air import AirBody, Surface
from uvf.models.vehicle.battery import lasts
from uvf.models.yaml_data import BadInput

ALPHAS = tuple(np.radians(np.arange(0.0, 16.01, 0.5)).tolist())
STALL_ALPHAS = tuple(np.radians(np.arange(0.0, 45.01, 0.25)).tolist())
POWER_SPEEDS = tuple(np.arange(1.0, 2.01, 0.05).tolist())
"""Of the slowest flight."""


@dataclass(frozen=True)
class Performance:
    """The best flight of each kind; ``endurance`` [s] is None without a battery, ``climb`` when no climb was found."""

    glide: Condition
    sink: Condition
    slowest: Condition
    stall_speed: float  # m/s, at the largest lift of the wing, elevator at zero
    stall_alpha: float  # rad
    climb: Condition | None
    cruise: Condition
    power: float  # W from the battery in ``cruise``
    endurance: float | None


def performance(airframe: Airframe, body: AirBody, altitude: float) -> Performance:
    """The performance at ``altitude`` [m AMSL] of an airframe that is held still. Raises BadInput when it has no steady glide.

    Gliding is with the motor off. What the elevator cannot balance is left out.
    """
    flown = glides(airframe, body, altitude)
    climbs = list(_sweep(airframe, Condition(body.trim_speed, altitude, throttle=1.0, climb=0.1), body.controls.elevator))
    slowest = min(flown, key=lambda c: c.airspeed)
    alpha, stall_speed = stall(airframe, body.trim_speed, altitude)
    power, cruise = min(_level(airframe, body, [slowest.airspeed * s for s in POWER_SPEEDS], altitude), key=lambda found: found[0])
    return Performance(
        glide=max(flown, key=lambda c: c.climb),
        sink=max(flown, key=climb_rate),
        slowest=slowest,
        stall_speed=stall_speed,
        stall_alpha=alpha,
        climb=max(climbs, key=climb_rate, default=None),
        cruise=cruise,
        power=power,
        endurance=lasts(body.battery, power) if body.battery else None,
    )


def glides(airframe: Airframe, body: AirBody, altitude: float) -> list[Condition]:
    """Steady glides at ``altitude`` [m AMSL], motor off, of an airframe that is held still, up to the elevator's stop.

    Raises BadInput when there is none.
    """
    elevator = body.controls.elevator
    found = list(_sweep(airframe, Condition(body.trim_speed, altitude, throttle=0.0, climb=-0.1), elevator))
    if not found:
        raise BadInput(f"{body.model}: no steady glide at {altitude:g} m was found")
    stop = find(airframe, replace(found[-1], elevator=elevator.lowest()), ("elevator", "throttle"))
    return found if stop is None else [*found, stop]


def climb_rate(flight: Condition) -> float:
    """Climb rate [m/s], upwards."""
    return flight.airspeed * math.sin(flight.climb)


def glide_ratio(flight: Condition) -> float:
    """Glide ratio [-] in calm air: distance over height lost."""
    return -1 / math.tan(flight.climb)


def _sweep(airframe: Airframe, begin: Condition, elevator: Surface) -> Iterator[Condition]:
    """One flight for each angle of attack that is balanced at this throttle, each found from the one before."""
    near = begin
    for alpha in ALPHAS:
        found = find(airframe, replace(near, alpha=alpha), ("alpha", "throttle"))
        if found is not None and found.airspeed > 0 and elevator.reaches(found.elevator) and abs(found.climb) < math.pi / 2:
            near = found
            yield found


def stall(airframe: Airframe, airspeed: float, altitude: float) -> tuple[float, float]:
    """Angle of attack [rad] of the largest lift, and the speed [m/s] at which that carries the weight, inf without any.

    airspeed: at which the lift is measured [m/s]; altitude: [m AMSL]. The airframe is held still, motor off, surfaces at zero.
    """
    lifts = [_lift(airframe, airspeed, altitude, alpha) for alpha in STALL_ALPHAS]
    best = int(np.argmax(lifts))
    return STALL_ALPHAS[best], airspeed * math.sqrt(GRAVITY / lifts[best]) if lifts[best] > 0 else math.inf


def _lift(airframe: Airframe, airspeed: float, altitude: float, alpha: float) -> float:
    """m/s^2, across the path, of the air alone: motor off, surfaces at zero."""
    along = np.array((math.cos(alpha), 0.0, math.sin(alpha)))
    felt = airframe.accelerations_held(Held(airspeed * along, np.zeros(3), np.array((0.0, alpha, 0.0)), altitude), Controls())
    return float(felt[0] * math.sin(alpha) - felt[2] * math.cos(alpha)) + GRAVITY


def _level(airframe: Airframe, body: AirBody, speeds: Sequence[float], altitude: float) -> Iterator[tuple[float, Condition]]:
    """Power from the battery [W] and the flight, of those speeds that it can fly level at."""
    near = Condition(body.trim_speed, altitude)
    avionics = body.battery.avionics if body.battery else 0.0
    for airspeed in sorted(speeds, reverse=True):
        found = find(airframe, replace(near, airspeed=airspeed), ("airspeed", "climb"))
        if found is not None and 0 <= found.throttle <= 1 and body.controls.elevator.reaches(found.elevator):
            near = found
            yield airframe.motor_power + avionics, found
