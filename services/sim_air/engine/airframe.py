"""One aircraft in JSBSim: the only file that imports it; where a model begins and what it says of itself are files beside."""

import io
import os
import re
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Self

import numpy as np

from services.sim_air.engine.contacts import Contacts, GroundTouch
from services.sim_air.engine.engine_state import CYCLES, HELD, EngineState
from services.sim_air.engine.gauges import FT, Gauges
from services.sim_air.engine.gust_rates import GUST_RATES, with_gust_rates
from services.sim_air.engine.initial import at_rest, blow, lay_terrain, put, put_held
from services.sim_air.engine.spin_up import FUEL_FREEZE, Hold, SpinUp
from services.sim_air.engine.states import Air, AircraftMotion, Held, InitialState, Runaway
from services.sim_air.engine.trim import FlightPath, Trim, TrimAttitude, attitude, solve
from services.sim_air.engine.wiring import Controls, JointAngle, Wiring
from services.sim_air.environment.ground import LEVEL, GroundSurface
from services.sim_air.environment.wind import AirMotion, AirRelativeState
from uvf.maths import rotations
from uvf.maths.geodesy import LocalTangent
from uvf.maths.rotations import Floats
from uvf.models.jsbsim.model_file import check_model
from uvf.models.jsbsim.model_parts import Unmade, properties_read
from uvf.models.vehicle.air import AirBody
from uvf.models.yaml_data import BadInput, FileLocation
from uvf.runtime.process.quiet import c_output_discarded

os.environ.setdefault("JSBSIM_DEBUG", "0")  # read when the engine is made: without it a banner goes to the output
import jsbsim

SETTLE = 30.0  # s, within which it comes to rest on its wheels
AT_REST = 0.02  # m/s and rad/s
TOUCHING = 0.5  # m above the reach of the wheels, from where on touches are looked for
SWIFTEST = ("velocities/vt-fps", "velocities/p-rad_sec", "velocities/q-rad_sec", "velocities/r-rad_sec")
RUNAWAY = 1e5  # ft/s and rad/s, from where on the engine's numbers soon end in none, and then the process
SURFACES = ("aileron", "elevator", "rudder")  # that trim


class Airframe:
    """A JSBSim model, flying, held at the commands it was last given."""

    def __init__(self, folder: Path, body: AirBody, tangent: LocalTangent) -> None:
        self._body = body
        self._tangent = tangent
        self._path = folder / body.model / f"{body.model}.xml"
        self._folder = folder
        self._ground = LEVEL
        self._spin_up = SpinUp(body.physics_hz)
        self._load()

    def _load(self) -> None:
        """The engine anew: it keeps from one beginning to the next what was true before, and a number that is none for ever."""
        self._fdm = _load(self._folder, self._path, self._body)
        known = list(dict.fromkeys([*_catalogue(self._fdm), *_made_by_settings(self._fdm, self._body)]))
        place = FileLocation(str(self._folder / "vehicle.yaml"), ("air",))
        self._wiring = Wiring(self._fdm, known, self._body, place)
        self._contacts = Contacts(self._fdm, known, self._path, self._body.skids, place.at("skids"))
        self._reach = float(np.linalg.norm(self._contacts.points(), axis=1).max(initial=0.0))
        self._gauges = Gauges(self._fdm, known, self._tangent)
        self._hold = Hold(self._fdm, not self._body.settings.get(FUEL_FREEZE))
        self._controls = Controls()
        self._stands: tuple[InitialState, TrimAttitude] | None = None  # how it was put on its wheels, until its first step

    def save(self) -> EngineState:
        """Its state, from which ``restored`` makes another one."""
        return EngineState({name: self._fdm[name] for name in _catalogue(self._fdm)}, self._controls, self._fdm.get_sim_time())

    def restored(self, state: EngineState) -> Self:
        """Another airframe that goes on from a saved state: identically each time, and nearly as the original does."""
        twin = type(self)(self._folder, self._body, self._tangent)
        twin.over(self._ground)
        turns = round(HELD * self._body.physics_hz / CYCLES)
        twin.hold_still(True)
        try:
            state.place(twin._fdm, turns * CYCLES / self._body.physics_hz)
        except jsbsim.BaseError as error:
            raise _refusal(self._path, error) from error
        twin._begin(np.zeros(3))
        state.settle(twin._fdm, twin.command, turns)
        twin.hold_still(False)
        twin._fdm.set_sim_time(state.time)
        return twin

    def over(self, ground: GroundSurface) -> None:
        """Sets the ground that it stands on and flies over, from its next start on."""
        self._ground = ground

    def start(self, start: InitialState) -> Trim:
        """Puts the aircraft into trimmed flight; returns the trim. Raises BadInput when it cannot fly so."""
        self._load()
        try:
            with c_output_discarded():
                trim = self._trim(start)
        except jsbsim.BaseError as error:
            raise _refusal(self._path, error) from error
        if not trim.converged:
            flight = "level flight" if start.path == FlightPath(start.airspeed) else "climb or turn like this"
            raise BadInput(f"{self._path}: no {flight} at {start.airspeed} m/s: {trim.lacks}")
        for name in SURFACES:
            surface, needed = getattr(self._body.controls, name), getattr(trim, name)
            if not surface.reaches(needed):
                way = f"it goes from {surface.lowest():g} to {surface.limit:g} rad"
                raise BadInput(f"{self._path}: at {start.airspeed} m/s it needs {needed:.2f} rad of {name}; {way}")
        return trim

    def stand(self, place: InitialState) -> None:
        """Puts the aircraft on its wheels, at rest, brakes on, motor off. Raises BadInput when it does not come to rest on them.

        One that rolls on, idling, because it has no brakes, stands too.
        """
        self.drop(place, 0.0)
        try:
            settled = self._settled()
        except Runaway:
            settled = False
        if not settled:
            raise BadInput(f"{self._path}: it does not come to rest on its wheels in {SETTLE:g} s; look at <ground_reactions>, physics_hz")
        motion = self.motion()
        roll, pitch, _ = rotations.to_euler(motion.world_from_body)
        self._stands = at_rest(place, float(motion.position[2])), TrimAttitude(roll, -pitch, 0.0, (0.0, 0.0, 0.0))
        self._wait_in_the_wind(*self._stands, place.wind)

    def _wait_in_the_wind(self, start: InitialState, lies: TrimAttitude, wind: Floats) -> None:
        """Functions of a model read ``aero/ci2vel`` of the step before; after a calm one that is the chord over no airspeed."""
        steps = 2
        self.hold_still(True)
        self._place(start, lies, steps / self._body.physics_hz)
        self.blow(wind)
        for _ in range(steps):
            self._fdm.run()
        self.hold_still(False)

    def release(self, start: InitialState, lies: TrimAttitude, wind: Floats) -> None:
        """Lets the aircraft go in flight with ``start.velocity`` over ground and the attitude ``lies``, in a ``wind`` (3,) [m/s, world]."""
        self._load()
        self._wait_in_the_wind(start, lies, wind)

    def drop(self, place: InitialState, height: float) -> None:
        """Puts the aircraft level and at rest with its wheels ``height`` [m] above the ground, brakes on, motor off, in calm air."""
        self._load()
        lowest = -float(self._contacts.points()[:, 2].min(initial=0.0))
        ground = self._ground.under(place.position)
        self._place(at_rest(place, ground + lowest + height), TrimAttitude(0.0, 0.0, 0.0, (0.0, 0.0, 0.0)))
        self.command(Controls(brake=1.0))

    def _settled(self) -> bool:
        """Whether it has come to rest for a second."""
        quiet = 0
        for _ in range(round(SETTLE * self._body.physics_hz)):
            self.step()
            motion = self.motion()
            moves = max(abs(motion.velocity[2]), np.linalg.norm(motion.angular_velocity))
            quiet = quiet + 1 if moves < AT_REST else 0
            if quiet >= self._body.physics_hz:
                return bool(motion.position[2] > self._ground.under(motion.position))
        return False

    @property
    def has_wheels(self) -> bool:
        """Whether it has any wheel."""
        return self._contacts.has_wheels

    def contacts(self) -> dict[str, Floats]:
        """Places (3,) [m] of all points that can touch the ground, unloaded, from the centre of gravity, body FLU, by name."""
        return dict(zip(self._contacts.names, self._contacts.points(), strict=True))

    def touches(self) -> list[GroundTouch]:
        """Its points that touch the ground."""
        return self._contacts.touches() if self._gauges.height() < self._reach + TOUCHING else []

    def _trim(self, start: InitialState) -> Trim:
        self.hold_still(True)
        calm = replace(start, wind=np.zeros(3))  # a turn through moving air is steady in the air only
        found = solve(lambda guess: self.accelerations(calm, guess), start.path.bank, self.powered)
        trim = replace(found, **{name: 0.0 for name in SURFACES if not getattr(self._body.controls, name).limit})
        self.accelerations(start, trim)
        self.hold_still(False)
        return trim

    def hold_still(self, still: bool) -> None:
        """Holds the motion of the body while the engine runs on, or releases it."""
        self._hold.still(still)

    def accelerations(self, start: InitialState, trim: Trim) -> Floats:
        """Body accelerations (6,) [m/s^2, rad/s^2, FRD] once the propeller turns steadily, the body held in this state."""
        flown = replace(start, climb=start.climb - trim.glide)
        return self._steady(partial(self._place, flown, attitude(start.path, trim)), trim.controls)

    def accelerations_held(self, held: Held, controls: Controls) -> Floats:
        """(6,) derivatives of u, v, w [m/s^2] and p, q, r [rad/s^2], FRD, once the engine turns steadily.

        Call ``hold_still`` before; ``shaft_power`` and ``propulsive_force`` tell of this state afterwards.
        """
        return self._steady(lambda _: self._place_held(held), controls)

    def accelerations_now(self) -> Floats:
        """(6,) derivatives of u, v, w [m/s^2] and p, q, r [rad/s^2], FRD, of the last step; also while it is held still."""
        return self._gauges.accelerations()

    def _steady(self, place: Callable[[float], None], controls: Controls) -> Floats:
        """place: sets the state, given the time [s] for which it will be held."""

        def begin(spin_up: float) -> None:
            place(spin_up)
            self.command(controls)

        self._spin_up.settle(self._fdm, self._gauges, begin)
        return self._gauges.accelerations()

    def _place(self, start: InitialState, lies: TrimAttitude, spin_up: float = 0.0) -> None:
        """spin_up: s for which the body is held still."""
        x, y, _ = start.position
        lay_terrain(self._fdm, self._tangent, x, y, self._ground.under(start.position))
        try:
            put(self._fdm, self._tangent, start, lies, spin_up)
        except jsbsim.BaseError as error:
            raise _refusal(self._path, error) from error
        self._begin(start.wind)

    def _place_held(self, held: Held) -> None:
        put_held(self._fdm, self._tangent, held)
        self._begin(np.zeros(3))

    def _begin(self, wind: Floats) -> None:
        """What the engine forgets at each beginning. wind: m/s, world."""
        self._wiring.set_up()
        self._fdm["propulsion/set-running"] = -1
        self.blow(wind)

    def blow(self, wind: Floats) -> None:
        """Sets the wind velocity (3,) [m/s, world], the direction it blows to."""
        blow(self._fdm, wind)

    def set_wind(self, air: AirMotion) -> None:
        """Sets velocity and rotation of the air until the next call. The first wind that blows on what stands has blown on it before."""
        if self._stands is not None:
            self._wait_in_the_wind(*self._stands, air.velocity)
        self.blow(air.velocity)
        for name, rate in zip(GUST_RATES, air.rates, strict=True):
            self._fdm[name] = rate

    def flight(self) -> AirRelativeState:
        """The state that the wind model depends on."""
        return self._gauges.flight()

    def command(self, controls: Controls) -> None:
        """Sets deflections, throttle and brake, held until the next call."""
        self._controls = controls
        self._wiring.write(controls)

    def step(self) -> None:
        """One physics step of 1 / physics_hz. Raises Runaway, after which the body can only begin anew."""
        self._stands = None
        self._lay_terrain()
        try:
            self._fdm.run()
        except jsbsim.BaseError as error:
            raise Runaway(" ".join(str(error).split())) from error
        for name in SWIFTEST:
            if not abs(self._fdm[name]) < RUNAWAY:
                raise Runaway(f"{name} is {self._fdm[name]:.3g}")

    def _lay_terrain(self) -> None:
        """All wheels stand on the level of the ground below the centre of gravity: the engine has one elevation for all."""
        position = self._gauges.position()
        height = position[2] - self._ground.under(position)
        self._fdm["position/terrain-elevation-asl-ft"] = self._fdm["position/geod-alt-ft"] - height / FT

    def motion(self) -> AircraftMotion:
        """True motion now: world ENU, body FLU."""
        return self._gauges.motion()

    def air(self) -> Air:
        """The air about the aircraft now."""
        return self._gauges.air()

    def joints(self) -> list[JointAngle]:
        """Angles of the surfaces and speeds of the propellers."""
        return self._wiring.joints()

    @property
    def span(self) -> float:
        """Wing span [m]."""
        return self._gauges.span

    @property
    def powered(self) -> bool:
        """Whether it has an engine."""
        return self._gauges.powered

    @property
    def propulsive_force(self) -> float:
        """Force [N] of all engines along the body's x axis."""
        return self._gauges.propulsive_force

    @property
    def shaft_power(self) -> float:
        """Shaft power [W] of all engines."""
        return self._gauges.shaft_power

    @property
    def motor_power(self) -> float:
        """Electric power [W] that all engines draw from the battery; 0 without one."""
        return self._gauges.motor_power(self._body.battery)


def _load(folder: Path, path: Path, body: AirBody) -> jsbsim.FGFDMExec:
    """The model at ``path`` = ``folder``/<model>/<model>.xml, with engines in ``folder``/engine. Raises BadInput."""
    if not path.is_file():
        raise BadInput(f"{folder / 'vehicle.yaml'}: air: model: there is no {body.model}/{body.model}.xml")
    check_model(path)
    fdm = jsbsim.FGFDMExec(str(folder))
    fdm.set_debug_level(0)
    fdm.set_dt(1 / body.physics_hz)  # before loading: filters and actuators of the model work out their coefficients then
    try:
        with c_output_discarded(), with_gust_rates(path) as aircraft:
            loaded = fdm.load_model_with_paths(body.model, str(aircraft), "engine", "systems")
            why = "" if loaded else _why_refused(folder, body.model, aircraft)
    except jsbsim.BaseError as error:
        raise _refusal(path, error) from error
    if not loaded:
        raise BadInput(f"{path}{why or ': JSBSim refuses it; look at its <file=...> names, engine and sections'}")
    _check_properties(path, fdm, body)
    try:
        with c_output_discarded():
            fdm.run_ic()  # until then it does not know its own centre of gravity
    except jsbsim.BaseError as error:
        raise _refusal(path, error) from error
    return fdm


def _why_refused(folder: Path, model: str, aircraft: Path) -> str:
    """What JSBSim writes when it does not load a model; "" where it does not say it."""
    said = io.StringIO()
    with redirect_stdout(said), redirect_stderr(said):  # it writes through Python
        jsbsim.FGFDMExec(str(folder)).load_model_with_paths(model, str(aircraft), "engine", "systems")
    found = re.search(r"In file [^\n]*: line \d+\s+(\S[^\n]*)", said.getvalue())  # of a copy in which the line is another
    return "" if found is None else f": JSBSim refuses it: {' '.join(found[1].split())}"


def _catalogue(fdm: jsbsim.FGFDMExec) -> list[str]:
    """The names of all properties of a loaded model."""
    return [line.split(" ")[0] for line in fdm.query_property_catalog("").splitlines()]


def _made_by_settings(fdm: jsbsim.FGFDMExec, body: AirBody) -> list[str]:
    """Properties that a model reads and nothing else makes."""
    manager = fdm.get_property_manager()
    return [name for name in body.settings if manager.hasNode(name)]


def _check_properties(path: Path, fdm: jsbsim.FGFDMExec, body: AirBody) -> None:
    """Whatever the model reads is there; what a surrounding program would give is what the settings say, or nothing. Raises BadInput."""
    manager = fdm.get_property_manager()
    missing = {name: file for name, file in properties_read(path).items() if not manager.hasNode(name)}
    for name in missing:
        fdm[name] = body.settings.get(name, 0.0)  # the engine aborts the process when it is taken down without it, not only when it flies
    for name, file in missing.items():
        if not name.startswith("/") and name not in body.settings:
            raise Unmade(f"{file}: nothing makes the property '{name}'; mend its name, or give its value under air: settings:", name)


def _refusal(path: Path, error: Exception) -> BadInput:
    """What the engine says in several lines, as one."""
    return BadInput(f"{path}: JSBSim refuses it: {' '.join(str(error).split())}")


def fly_one_step(models: str, body: AirBody, origin: tuple[float, float, float]) -> None:
    """Makes the aircraft and moves it once, to be run in a subprocess: JSBSim ends the process at some faults in a model.

    models: path of the folder; origin: latitude, longitude [deg], altitude [m]. Raises BadInput.
    """
    Airframe(Path(models), body, LocalTangent.from_degrees(*origin)).step()
