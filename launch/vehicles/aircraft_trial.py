"""What a JSBSim aircraft that nobody has described does with its commands: signs, travel, a speed to fly at, the step it needs."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np

from launch.vehicles.aircraft_rules import ABOUT_LEVEL, HEIGHT, RIGHT_WAY, SEA_LEVEL, comes_to_rest, effect, throttle_works
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import Held, InitialState
from services.sim_air.engine.trim import Trim
from services.sim_air.engine.wiring import Controls
from uvf.models.importing.notes import Notes
from uvf.models.jsbsim.model_parts import Unmade, properties_read
from uvf.models.vehicle.air import AirBody, Surface
from uvf.models.yaml_data import BadInput

RATES = (120.0, 240.0, 480.0, 960.0, 1920.0)  # Hz; the first is JSBSim's own
SPEEDS = (1.0, 1.2, 0.85, 1.4, 0.7, 1.7, 2.0)  # of the first guess
USEFUL = (0.1, 0.9)  # throttle of a cruise from which there is something left to both sides
TURNS = 200  # physics steps after which a surface stands
TRAVEL = {"aileron": "left_aileron", "elevator": "elevator", "rudder": "rudder", "flap": "flap"}
LEAST = 0.02  # rad of travel that is one
UNEQUAL = 0.1  # of the travel, between both ends, from which on it is told
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
        if name != "flap" and abs(abs(ends[0]) - abs(ends[1])) > UNEQUAL * travel:
            first, last = (round(abs(end), 3) for end in ends)
            notes.add(f"found: the {name} goes {last:g} rad one way and {first:g} the other; taken as {round(travel, 3):g} to both sides")
        surface = msgspec.structs.replace(control, limit=round(min(travel, 1.6), 3))
        body = _with(body, name, surface)
    return body


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
    """The first speed at which it flies steadily with some throttle left, else the first at which it flies at all."""
    flown = list(_flights(airframe, body.trim_speed))
    if not flown:
        notes.add(f"guessed: trim_speed; no steady level flight was found from {min(SPEEDS):g} to {max(SPEEDS):g} times that")
        return body
    speed, trim = min(flown, key=lambda found: not (USEFUL[0] < found[1].throttle < USEFUL[1]) if airframe.powered else False)
    notes.add(f"found: steady flight at {speed:g} m/s with {trim.throttle:.2f} of the throttle, elevator {trim.elevator:.3f} rad")
    return msgspec.structs.replace(body, trim_speed=speed)


def _flights(airframe: Airframe, guess: float) -> Iterator[tuple[float, Trim]]:
    for factor in SPEEDS:
        speed = float(f"{guess * factor:.2g}")
        try:
            trim = airframe.start(level(speed))
        except BadInput:
            continue
        yield speed, replace(trim)
        if not airframe.powered or USEFUL[0] < trim.throttle < USEFUL[1]:
            return
