"""What a JSBSim aircraft that nobody has described does with its commands: signs, travel, a speed to fly at, the step it needs."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import msgspec
import numpy as np

from launch.vehicles.aircraft_rules import ABOUT_LEVEL, HEIGHT, RIGHT_WAY, SEA_LEVEL, comes_to_rest, effect, throttle_works
from services.sim_air.analysis.linear import held_still
from services.sim_air.analysis.performance import stall
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import Held, InitialState
from services.sim_air.engine.trim import Trim
from services.sim_air.engine.wiring import Controls
from uvf.maths.geodesy import GRAVITY
from uvf.models.importing.notes import Notes
from uvf.models.jsbsim.model_parts import Unmade, properties_read
from uvf.models.vehicle.air import AirBody, Surface
from uvf.models.yaml_data import BadInput

RATES = (120.0, 240.0, 480.0, 960.0, 1920.0)  # Hz; the first is JSBSim's own
SPEEDS = (1.0, 1.1, 1.2, 0.85, 1.4, 0.7, 1.7, 2.0)  # of the first guess
USEFUL = (0.1, 0.9)  # throttle of a cruise from which there is something left to both sides
CLIMB = 0.02  # rad
ABOVE_STALL = 1.4  # times the speed at which the wing stalls: for turns, and for gusts
TURNS = 200  # physics steps after which a surface stands
TRAVEL = {"aileron": "left_aileron", "elevator": "elevator", "rudder": "rudder", "flap": "flap"}
LEAST = 0.02  # rad of travel that is one
UNEQUAL = 0.1  # of what a surface does, between both ways, from which on it is told
NOTHING = 1e-4  # m/s^2 or rad/s^2


def tried(folder: Path, body: AirBody, notes: Notes) -> AirBody:
    """The body with what trial flights of the model have shown. Raises BadInput where the engine refuses the model."""
    body = _with_throttle(folder, _with_settings(folder, body, notes), notes)
    body = _with_signs(Airframe(folder, body, SEA_LEVEL), body, notes)
    body = _with_travel(Airframe(folder, body, SEA_LEVEL), body, notes)
    body = _with_rate(folder, body, notes)
    return _with_speed(Airframe(folder, body, SEA_LEVEL), body, notes)


def level(speed: float, climb: float = 0.0) -> InitialState:
    """Flight at ``speed`` [m/s] through still air with flight-path angle ``climb`` [rad], yaw 0, at the height of the trials."""
    return InitialState(np.array((0.0, 0.0, HEIGHT)), 0.0, speed, np.zeros(3), climb)


def turning(speed: float) -> InitialState:
    """Level flight at ``speed`` [m/s], banked by 45 degrees: twice the load factor squared."""
    return replace(level(speed), turn_rate=GRAVITY / speed)


def _with_settings(folder: Path, body: AirBody, notes: Notes) -> AirBody:
    """Properties that nothing makes, set to zero."""
    while True:
        try:
            Airframe(folder, body, SEA_LEVEL)
            return body
        except Unmade as error:
            body = msgspec.structs.replace(body, settings={**body.settings, error.name: 0.0})
            notes.add("guessed: zero for what nothing in the model makes, under settings", error.name)


def _with_throttle(folder: Path, body: AirBody, notes: Notes) -> AirBody:
    airframe = Airframe(folder, body, SEA_LEVEL)
    airframe.hold_still(True)
    if not airframe.powered or throttle_works(airframe, level(body.trim_speed), ABOUT_LEVEL):
        return body
    read = properties_read(folder / body.model / f"{body.model}.xml")
    names = [name for name in read if "throttle" in name.rpartition("/")[2] and "pos" not in name]
    for name in names:
        throttle = msgspec.structs.replace(body.controls, throttle=msgspec.structs.replace(body.controls.throttle, property=name))
        made = msgspec.structs.replace(body, controls=throttle, settings={**body.settings, name: 0.0})
        airframe = Airframe(folder, made, SEA_LEVEL)
        airframe.hold_still(True)
        if throttle_works(airframe, level(body.trim_speed), ABOUT_LEVEL):
            notes.add("found: it takes its throttle from", name)
            return made
    notes.add("no property was found that works its throttle")
    return body


def _with_signs(airframe: Airframe, body: AirBody, notes: Notes) -> AirBody:
    start = level(body.trim_speed)
    airframe.hold_still(True)
    at_rest = airframe.accelerations(start, ABOUT_LEVEL)
    for name, (index, sign, _) in RIGHT_WAY.items():
        if (effect(airframe, start, ABOUT_LEVEL, body.controls, name) - at_rest)[index] * sign < 0:
            surface = msgspec.structs.replace(getattr(body.controls, name), sign=-1)
            body = _with(body, name, surface)
            notes.add("found: the sign is turned of", name)
    return body


def _with_travel(airframe: Airframe, body: AirBody, notes: Notes) -> AirBody:
    """Half of the way from stop to stop, where the model tells it."""
    airframe.hold_still(True)
    for name, joint in TRAVEL.items():
        control = getattr(body.controls, name)
        stops = (0.0 if name == "flap" else -1.0, 1.0)
        ends = [_stands(airframe, Controls(**{name: end * control.limit})).get(joint, 0.0) for end in stops]
        travel = abs(ends[1] - ends[0]) / (1 if name == "flap" else 2)
        if travel < LEAST:
            if name == "flap" and not _lifts(airframe, body):
                body = _with(body, "flap", msgspec.structs.replace(control, limit=0.0))
                notes.add("found: it has no flaps")
            else:
                notes.add("guessed: the travel is not told of", name)
            continue
        stronger = _stronger(airframe, body, name) if name in RIGHT_WAY else 1.0
        positive, negative = (round(min(2 * travel * share / (1 + stronger), 1.6), 3) for share in (stronger, 1.0))
        other = negative if negative != positive else None
        if other is not None:
            notes.add(f"found: the {name} goes from {-negative:g} to {positive:g} rad, by what it does")
        body = _with(body, name, msgspec.structs.replace(control, limit=positive, negative_limit=other))
    return body


def _stronger(airframe: Airframe, body: AirBody, name: str) -> float:
    """What half of the command does the positive way over what it does the other way; 1 where that is about the same."""
    index, _, _ = RIGHT_WAY[name]
    half = getattr(body.controls, name).limit / 2
    start = level(body.trim_speed)
    at_rest, *moved = (airframe.accelerations(start, replace(ABOUT_LEVEL, **{name: at}))[index] for at in (0.0, half, -half))
    does, other = (abs(float(effect - at_rest)) for effect in moved)
    return does / other if min(does, other) > NOTHING and max(does, other) > (1 + UNEQUAL) * min(does, other) else 1.0


def _with(body: AirBody, name: str, surface: Surface) -> AirBody:
    return msgspec.structs.replace(body, controls=msgspec.structs.replace(body.controls, **{name: surface}))


def _lifts(airframe: Airframe, body: AirBody) -> bool:
    """Whether flaps that are lowered do anything in flight."""
    held = Held(np.array((body.trim_speed, 0.0, 0.0)), np.zeros(3), np.zeros(3), HEIGHT)
    up, down = (airframe.accelerations_held(held, Controls(flap=flap)) for flap in (0.0, body.controls.flap.limit))
    return bool(np.abs(down - up).max() > NOTHING)


def _stands(airframe: Airframe, controls: Controls) -> dict[str, float]:
    """rad, of each joint, at a held command."""
    airframe.accelerations(level(30.0), ABOUT_LEVEL)
    airframe.command(controls)
    for _ in range(TURNS):
        airframe.step()
    return {joint.name: joint.position for joint in airframe.joints()}


def _with_rate(folder: Path, body: AirBody, notes: Notes) -> AirBody:
    """The first at which it comes to rest on its wheels."""
    for rate in RATES:
        if comes_to_rest(folder, body, rate):
            notes.add(f"found: at {rate:g} physics steps a second it comes to rest on its wheels")
            return msgspec.structs.replace(body, physics_hz=rate)
    notes.add("its landing gear comes to rest at no physics_hz: begin it in the air, or mend <ground_reactions>")
    return body


def _with_speed(airframe: Airframe, body: AirBody, notes: Notes) -> AirBody:
    """The first speed well above the stall at which it climbs and turns with some throttle left, else the best of the rest."""
    flown = list(_flights(airframe, body.trim_speed))
    if not flown:
        notes.add(f"guessed: trim_speed; no steady level flight was found from {min(SPEEDS):g} to {max(SPEEDS):g} times that")
        return body
    speed, trim, _ = max(flown, key=lambda found: found.clear)
    notes.add(f"found: steady flight at {speed:g} m/s with {trim.throttle:.2f} of the throttle, elevator {trim.elevator:.3f} rad")
    return msgspec.structs.replace(body, trim_speed=speed)


class _Flight(NamedTuple):
    speed: float  # m/s
    trim: Trim
    clear: float  # times the speed at which it stalls, up to ABOVE_STALL; 0 where it does not climb and turn


def _flights(airframe: Airframe, guess: float) -> Iterator[_Flight]:
    """Up to the first that is of use."""
    for factor in SPEEDS:
        speed = float(f"{guess * factor:.2g}")
        try:
            trim = airframe.start(level(speed))
        except BadInput:
            continue
        cruises = not airframe.powered or USEFUL[0] < trim.throttle < USEFUL[1]
        clear = _clear_of_stall(airframe, speed) if cruises and _manoeuvres(airframe, speed) else 0.0
        yield _Flight(speed, trim, clear)
        if clear == ABOVE_STALL:
            return


def _clear_of_stall(airframe: Airframe, speed: float) -> float:
    with held_still(airframe):
        _, stalled = stall(airframe, speed, HEIGHT)
    return min(speed / stalled, ABOVE_STALL)


def _manoeuvres(airframe: Airframe, speed: float) -> bool:
    try:
        for flight in (level(speed, CLIMB), turning(speed)):
            airframe.start(flight)
    except BadInput:
        return False
    return True
