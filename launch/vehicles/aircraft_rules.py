"""What is wrong with an aircraft: its model's files, its names, its trim, its signs, its landing gear."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import msgspec
import numpy as np

from services.sim_air.actuators import Actuators
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import InitialState, Runaway
from services.sim_air.engine.trim import Trim
from services.sim_air.engine.wiring import Controls
from uvf.maths.geodesy import LocalTangent
from uvf.maths.rotations import to_euler
from uvf.models.jsbsim.model_file import model_faults
from uvf.models.vehicle.air import AirBody, Surface
from uvf.models.vehicle.layers import folders_of, holding
from uvf.models.yaml_data import BadInput, FileLocation
from uvf.runtime.process.subprocess_jobs import Died, run_in_subprocess

SEA_LEVEL = LocalTangent.from_degrees(0.0, 0.0, 0.0)
HEIGHT = 100.0  # m, where level flight is tried
HIGHEST = 4800.0  # Hz
ABOUT_LEVEL = Trim(alpha=0.05, roll=0.0, aileron=0.0, elevator=0.0, rudder=0.0, throttle=0.5)
BODY = 0.15  # of the span, to each side
LANDING_PITCH, RESTS = 0.25, 0.01  # rad; m
STANDING = InitialState(np.zeros(3), 0.0, 0.0, np.zeros(3))
CYCLES = 50.0  # 1/s, in which the throttle opens
RUN_UP, JUMP, ROLLS_OFF = 2.0, 0.5, 4.0  # s; rad/s of roll and m/s up; m/s
FULL = 0.5  # of a surface's limit, tried from the trim
RIGHT_WAY = {"aileron": (3, 1, "rolls right"), "elevator": (4, -1, "pitches down"), "rudder": (5, -1, "yaws left")}
"""For each surface the body acceleration (of u, v, w, p, q, r; FRD) that it is for, its sign and its name."""
WEAK = 1e-3  # rad/s^2


def aircraft_faults(folder: Path, air: AirBody) -> tuple[list[str], list[str]]:
    """(faults, notes), a line each; also for a model that makes the engine end its process."""
    try:
        return run_in_subprocess(_aircraft_faults, str(folder), air)
    except Died as error:
        line = f"JSBSim ends the process with this model ({error}); look at what was changed last, and at its own names and tables"
        return [f"{folder / 'vehicle.yaml'}: air: model: {line}"], []


def _aircraft_faults(vehicle: str, air: AirBody) -> tuple[list[str], list[str]]:
    """vehicle: path of its folder."""
    folder = Path(vehicle)
    models, place = holding(folders_of(folder), air.model), FileLocation(str(folder / "vehicle.yaml"), ("air",))
    path = models / air.model / f"{air.model}.xml"
    try:
        faults = list(model_faults(path)) if path.is_file() else []
        if faults:
            return faults, []
        airframe = Airframe(models, air, SEA_LEVEL)
    except BadInput as error:
        return [str(error)], []
    flight, notes = _flight(airframe, air, place)
    try:
        return [*flight, *_gear_faults(models, air, place)], notes
    except BadInput as error:  # told already where level flight was tried
        return flight or [str(error)], notes


def _flight(airframe: Airframe, air: AirBody, place: FileLocation) -> tuple[list[str], list[str]]:
    """Of level flight at trim_speed."""
    level = InitialState(np.array((0.0, 0.0, HEIGHT)), 0.0, air.trim_speed, np.zeros(3))
    untrimmed = []
    try:
        trim = airframe.start(level)
    except BadInput as error:
        untrimmed, trim = [f"{place.at('trim_speed')}: {error}"], ABOUT_LEVEL
        if "JSBSim refuses" in str(error):
            return [str(error)], []
    airframe.hold_still(True)
    at_trim = airframe.accelerations(level, trim)
    effects = {name: effect(airframe, level, trim, air.controls, name) - at_trim for name in RIGHT_WAY}
    faults, notes = _idle(effects, air, place)
    if airframe.powered and not throttle_works(airframe, level, trim):
        faults.append(f"{place.at('controls', 'throttle')}: it changes no thrust; name the property that the model reads its throttle from")
    return [*untrimmed, *_sign_faults(effects, place), *faults], notes


def throttle_works(airframe: Airframe, level: InitialState, trim: Trim) -> bool:
    """Whether the throttle changes the thrust of an airframe that is held still."""
    thrusts = []
    for throttle in (0.0, 1.0):
        airframe.accelerations(level, replace(trim, throttle=throttle))
        thrusts.append(airframe.propulsive_force)
    return abs(thrusts[1] - thrusts[0]) > WEAK * max(map(abs, thrusts))


def effect(airframe: Airframe, level: InitialState, trim: Trim, controls: object, name: str) -> np.ndarray:
    """Body accelerations (6,) [m/s^2, rad/s^2] with the surface ``name`` deflected."""
    moved = {name: getattr(trim, name) + FULL * getattr(controls, name).limit}
    return airframe.accelerations(level, replace(trim, **moved))


def _sign_faults(effects: dict[str, np.ndarray], place: FileLocation) -> Iterator[str]:
    for name, effect in effects.items():
        index, sign, does = RIGHT_WAY[name]
        if effect[index] * sign < -WEAK:
            yield f"{place.at('controls', name)}: a positive {name} ought to be one that {does}, and this does the opposite; turn its sign"


def _idle(effects: dict[str, np.ndarray], air: AirBody, place: FileLocation) -> tuple[list[str], list[str]]:
    """(faults, notes) of surfaces that do nothing: an aircraft may have no ailerons, or no rudder, when its file names none."""
    idle = [name for name, effect in effects.items() if abs(effect[RIGHT_WAY[name][0]]) < WEAK]
    if "elevator" in idle or {"aileron", "rudder"} <= set(idle):
        line = f"{place.at('controls')}: {' and '.join(idle)} move nothing; name the properties that the model reads its commands from"
        return [line], []
    named = [name for name in idle if getattr(air.controls, name) != Surface()]
    return [], [f"its {name} does nothing, though vehicle.yaml has one" for name in named]


def _gear_faults(models: Path, air: AirBody, place: FileLocation) -> Iterator[str]:
    if comes_to_rest(models, air, air.physics_hz):
        return
    where, fell = place.at("physics_hz"), "it does not come to rest on its wheels, or jumps when its motor runs up"
    rate = air.physics_hz
    while (rate := rate * 2) <= HIGHEST:
        if comes_to_rest(models, air, rate):
            yield f"{where}: {fell}: at {air.physics_hz:g} Hz the landing gear is unstable; set {rate:g} Hz, or soften springs and dampers"
            return
    yield f"{where}: {fell}, at {HIGHEST:g} Hz neither; look at <ground_reactions>: springs, dampers, places of the wheels"


def comes_to_rest(models: Path, air: AirBody, rate: float) -> bool:
    """Whether the aircraft comes to rest on its wheels with ``rate`` [1/s] physics steps, as it has to when it begins on them.

    Nor does it jump when its motor runs up: the torque of a light propeller takes shorter steps than its springs.
    """
    airframe = _standing(models, air, rate)
    if airframe is None:
        return False
    try:
        return not (airframe.has_wheels and airframe.powered) or _runs_up(airframe, Actuators(Controls(brake=1.0), air), rate)
    except Runaway:
        return False


def _standing(models: Path, air: AirBody, rate: float) -> Airframe | None:
    """The aircraft at rest on the ground; None where it does not come to rest."""
    airframe = Airframe(models, msgspec.structs.replace(air, physics_hz=rate), SEA_LEVEL)
    try:
        airframe.stand(STANDING)
    except BadInput:
        return None
    return airframe


def _runs_up(airframe: Airframe, actuators: Actuators, rate: float) -> bool:
    """Whether it stays on the ground and upright while the throttle opens, in the steps of an autopilot."""
    for i in range(round(RUN_UP * rate)):
        opened = math.floor(i * CYCLES / rate) / (CYCLES * RUN_UP / 2)
        airframe.command(actuators.step(Controls(throttle=min(opened, 1.0)), 1 / rate))
        airframe.step()
        motion = airframe.motion()
        if motion.airspeed > ROLLS_OFF:
            return True
        if max(abs(motion.angular_velocity[0]), abs(motion.velocity[2])) > JUMP:
            return False
    return True


@dataclass(frozen=True)
class GroundStance:
    """How an aircraft stands: height [m] of the centre of gravity, pitch [rad], and on what."""

    height: float
    pitch: float
    gear: str
    """As the parameter ``gear``."""
    skids: list[str]
    """Parts of the structure that it lies on, for want of wheels."""


def stands(models: Path, air: AirBody, rate: float) -> GroundStance | None:
    """How the aircraft stands with ``rate`` [1/s] physics steps; None where it does not come to rest."""
    airframe = _standing(models, air, rate)
    if airframe is None:
        return None
    motion = airframe.motion()
    _, pitch, _ = to_euler(motion.world_from_body)
    places = airframe.contacts()
    on = np.array([places[touch.name] for touch in airframe.touches()])
    if not airframe.has_wheels:
        return GroundStance(float(motion.position[2]), -pitch, "belly", list(_underside(places, on, airframe.span)))
    aside = np.abs(on[:, 1])
    main, middle = on[aside > aside.max() / 2], on[aside <= aside.max() / 2]
    tail = len(middle) > 0 and middle[:, 0].max() < main[:, 0].min()
    return GroundStance(float(motion.position[2]), -pitch, "tail_wheel" if tail else "nose_wheel", [])


def _underside(places: Mapping[str, np.ndarray], on: np.ndarray, span: float) -> Iterator[str]:
    """Contacts that touch the ground when it lies, and those of the body that do with its nose or tail a little lower."""
    lowest, middle = on[:, 2].min(), on[:, 0].mean()
    for name, (x, y, z) in places.items():
        if abs(y) < BODY * span and z - lowest <= max(LANDING_PITCH * abs(x - middle), RESTS):
            yield name
