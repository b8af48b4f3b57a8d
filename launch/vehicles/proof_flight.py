"""The flight that a tuning is proved by: steps of the sticks, then a mission with a leg, a corner, a circle and a landing.

Flown by the simulator and the autopilot as in any mission, through their topics and requests alone.
"""

import math
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from launch import catalogue
from launch.scoring.recorded_track import CRASHED
from launch.vehicles.parameter_lines import SERVICE
from schemas import topics
from schemas.messages import MissionProgress, Mode, ModeRequest, SurfaceCommand
from schemas.topics import M, Topic
from uvf.maths.filters import LowPass
from uvf.maths.rotations import to_euler
from uvf.models.mission.file import JobFile, MissionFile, StartPose, Vehicle, Waypoint
from uvf.models.scenario import ROOT, MissionVehicle, Scenario
from uvf.models.vehicle.air import AirBody
from uvf.models.vehicle.file import VehicleFile, load_vehicle
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.world.file import load_world
from uvf.models.world.wind import TurbulenceFile, Wind
from uvf.models.yaml_data import BadInput, convert
from uvf.runtime.messages.convert import stamp, wxyz
from uvf.runtime.messages.step_times import NS
from uvf.runtime.time.lockstep import Lockstep

Floats = NDArray[np.float64]

NAME, WRITER = "proof", "teleop"
WORLDS, WORLD = ROOT / "worlds", "empty"
HEIGHT = 120.0  # m
STEPS_AT, LEVELS, HELD, CLIMBED = 12.0, 4.0, 6.0, 8.0  # s: when the sticks are taken, how long they are centred, a bank and a climb last
STICK = 0.5  # of a stick's way
AWAY, LEG = 75.0, 30.0  # s of cruise: to where the first leg begins, along each of the legs
TURNS = 2.0
STEEPER = 1.3  # than the glide of cruise, along the course of a glider
LAPS, LANDS = 6.0, 200.0  # of the circle and s, at most from the mission's own circle to the end
NEEDED = ("imu", "gnss")


class ProofAir(NamedTuple):
    """What a proof is flown in, and whether one lands in it."""

    turbulence: TurbulenceFile | None
    lands: bool


@dataclass(frozen=True)
class ProofCourse:
    """Where the mission leads an aircraft; lengths go with its airspeed. m east and north of the start, headings to the north and east."""

    airspeed: float  # m/s
    radius: float  # m, of the circle
    glide: float  # rad, slope down of all of it; 0 with an engine
    air: ProofAir

    @property
    def corner(self) -> tuple[float, float]:
        """From the leg to the north to the one to the east."""
        return 0.0, (AWAY + LEG) * self.airspeed

    @property
    def end(self) -> tuple[float, float]:
        """Of the leg to the east."""
        east, north = self.corner
        return east + LEG * self.airspeed, north

    @property
    def centre(self) -> tuple[float, float]:
        """Of the circle, which lies to the right."""
        east, north = self.end
        return east + 2 * self.radius, north - self.radius

    @property
    def lap(self) -> float:
        """Of the circle [s]."""
        return math.tau * self.radius / self.airspeed

    @property
    def steps(self) -> "Steps":
        """Of the sticks, before the mission; without a climb for what glides."""
        climbs = 0.0 if self.glide else CLIMBED
        return Steps(*np.cumsum([STEPS_AT, LEVELS, HELD, HELD, LEVELS, climbs, LEVELS]).tolist())

    @property
    def longest(self) -> float:
        """Time [s] after which it ought to be over."""
        return self.steps.end + 1.5 * (AWAY + 2 * LEG) + (TURNS + LAPS) * self.lap + LANDS

    @property
    def start(self) -> float:
        """Height [m] of the start."""
        return HEIGHT + math.tan(self.glide) * ((AWAY + 2 * LEG) * self.airspeed + (TURNS * math.tau + 2.0) * self.radius)

    def job(self) -> JobFile:
        """Mission items."""
        begin, (east, north), (x, y) = self.corner[1] - LEG * self.airspeed, self.corner, self.centre
        heights = [self.start - math.tan(self.glide) * way * self.airspeed for way in (AWAY, AWAY + LEG, AWAY + 2 * LEG)]
        items = [
            Waypoint(x=0.0, y=begin, z=heights[0]),
            Waypoint(x=east, y=north, z=heights[1]),
            Waypoint(x=self.end[0], y=north, z=heights[2]),
            Waypoint(kind="orbit", x=x, y=y, z=HEIGHT, radius=self.radius, turns=TURNS),
        ]
        return JobFile(mission=[*items, Waypoint(kind="land", x=x, y=y)] if self.air.lands else items)


class Steps(NamedTuple):
    """Times [s] at which the sticks are taken and go on: right, left, level, up, level, and are given back."""

    begin: float
    right: float
    left: float
    level: float
    climb: float
    hold: float
    end: float

    def sticks(self, t: float) -> tuple[float, float]:
        """Shares of bank and climb that are asked for at ``t`` [s], -1 to 1."""
        bank = 1.0 if self.right <= t < self.left else -1.0 if self.left <= t < self.level else 0.0
        return bank, 1.0 if self.climb <= t < self.hold else 0.0


@dataclass(frozen=True)
class ProofFlight:
    """What was seen of the truth, n samples, and of the surfaces, m samples."""

    course: ProofCourse
    t: Floats  # (n,) s
    position: Floats  # (n, 3) m east, north, height
    climb: Floats  # (n,) m/s
    bank: Floats  # (n,) rad, right wing down
    surfaces_t: Floats  # (m,) s
    surfaces: Floats  # (m, 3) rad: aileron, elevator, rudder, where servos are
    status_t: Floats  # (k,) s
    off_path: Floats  # (k,) m, from the path that is planned, as the autopilot sees it
    crash: str
    """How it ended; empty where it did not."""
    complete: bool
    """Whether the mission was flown to its end."""
    events: list[str]
    """Of the autopilot, a line each."""

    @property
    def last_words(self) -> str:
        """The last event, or that there was none."""
        return self.events[-1] if self.events else "nothing"


def glide(params: AirParams) -> float:
    """Slope [rad] down which a course leads, a little steeper than the glide of cruise; 0 with an engine."""
    return 0.0 if params.throttle_climb else STEEPER * params.idle_sink / params.trim_airspeed


def proof_flight(folder: Path, air: ProofAir) -> ProofFlight:
    """One flight of the vehicle in this folder. Raises BadInput."""
    file = load_vehicle(folder.parent, folder.name)
    assert file.air is not None
    if missing := [name for name in NEEDED if getattr(file.sensors, name) is None]:
        place = f"{folder / 'vehicle.yaml'}: sensors"
        raise BadInput(f"{place}: no {' and no '.join(missing)}, without which the autopilot flies nothing; add it")
    params = convert(file.params.get(SERVICE, {}), AirParams, str(folder / "vehicle.yaml"), ("params", SERVICE))
    course = ProofCourse(params.trim_airspeed, params.hold_radius, glide(params), air)
    site = _site(folder, file, course)
    hosts = catalogue.hosts(site, [catalogue.kind("sim_air"), catalogue.kind("autopilot")])
    with closing(Lockstep(hosts)) as lockstep:
        pilot = _Pilot(lockstep, file.air, params, course.steps)
        lockstep.run(course.longest, pilot)
    return pilot.flight(course)


def _site(folder: Path, file: VehicleFile, course: ProofCourse) -> Scenario:
    """A mission over flat ground."""
    entry = Vehicle(folder.name, StartPose(0.0, 0.0, course.start, math.pi / 2, course.airspeed), 1, course.job())
    world = msgspec.structs.replace(load_world(WORLDS, WORLD), wind=Wind(turbulence=course.air.turbulence))
    member = MissionVehicle(NAME, entry, file, folder)
    mission = MissionFile("proof of a tuning", WORLD, {NAME: entry})
    return Scenario(folder / "proof.yaml", mission, world, WORLDS / WORLD, {NAME: member})


class _Pilot:
    """Takes the sticks for the steps, gives the aircraft back to the mission, and writes down what it does."""

    def __init__(self, lockstep: Lockstep, body: AirBody, params: AirParams, steps: Steps) -> None:
        self._bus, self._body = lockstep.bus, body
        self._throttle = (params.trim_airspeed - params.min_airspeed) / (params.max_airspeed - params.min_airspeed)
        topic = topics.SURFACES.by(WRITER)
        self._sticks = self._bus.publisher(topic.at(NAME), SurfaceCommand.DESCRIPTOR.full_name, topic.qos)
        self._steps = steps
        self._flies = ""
        self._truth = self._kept(topics.TRUTH)
        self._surfaces = self._kept(topics.SURFACE_COMMAND)
        self._status = self._kept(topics.STATUS)
        self._progress = self._kept(topics.PROGRESS)
        self._ends, self._events = self._kept(topics.EVENTS.by("sim_air")), self._kept(topics.EVENTS.by("autopilot"))

    def __call__(self, t: float) -> bool:
        """Whether to go on."""
        self._fly("sticks" if STEPS_AT <= t < self._steps.end else "mission", t)
        if self._flies == "sticks" and round(t * topics.CLOCK.hz) % round(topics.CLOCK.hz / topics.SURFACES.hz) == 0:
            bank, climb = self._steps.sticks(t)
            controls = self._body.controls
            aileron, elevator = controls.aileron.deflection(STICK * bank), controls.elevator.deflection(-STICK * climb)
            message = SurfaceCommand(timestamp=stamp(t), aileron=aileron, elevator=elevator, throttle=self._throttle)
            self._sticks.put(message.SerializeToString(), round(t * NS))
        return not (self._crash or self._complete)

    def _fly(self, who: str, t: float) -> None:
        if who == self._flies:
            return
        self._flies = who
        request = ModeRequest(mode=Mode.MODE_ALTITUDE if who == "sticks" else Mode.MODE_MISSION, source=WRITER)
        self._bus.call(topics.SET_MODE.at(NAME), request.SerializeToString(), round(t * NS), lambda *_: None)

    @property
    def _complete(self) -> bool:
        return bool(self._progress) and self._progress[-1][1].state == MissionProgress.COMPLETE

    @property
    def _crash(self) -> str:
        return next((m.cause for _, m in self._ends if m.text == CRASHED), "")

    def _kept(self, topic: Topic[M]) -> list[tuple[float, M]]:
        kept: list[tuple[float, M]] = []
        self._bus.subscribe(topic.at(NAME), topic.qos, lambda s: kept.append((s.stamp_ns / NS, topic.message.FromString(s.payload))))
        return kept

    def flight(self, course: ProofCourse) -> ProofFlight:
        """What was seen."""
        truth, surfaces = [m for _, m in self._truth], [m for _, m in self._surfaces]
        times = np.array([t for t, _ in self._surfaces])
        return ProofFlight(
            course,
            np.array([t for t, _ in self._truth]),
            np.array([(m.position.x, m.position.y, m.position.z) for m in truth]),
            np.array([m.velocity.z for m in truth]),
            np.array([to_euler(wxyz(m.orientation))[0] for m in truth]),
            times,
            followed(np.array([(m.aileron, m.elevator, m.rudder) for m in surfaces]), times, self._body),
            np.array([t for t, _ in self._status]),
            np.array([m.cross_track for _, m in self._status]),
            self._crash,
            self._complete,
            [f"{t:.1f} s: {m.text}, {m.cause}" if m.cause else f"{t:.1f} s: {m.text}" for t, m in self._events],
        )


def followed(asked: Floats, t: Floats, body: AirBody) -> Floats:
    """Where servos are that follow (m, 3) deflections [rad] asked for at times ``t`` (m,) [s] with their lags; their rates are left out."""
    found = asked.copy()
    controls = body.controls
    for column, surface in enumerate((controls.aileron, controls.elevator, controls.rudder)):
        if lag := body.lag_of(surface):
            servo = LowPass(lag)
            found[:, column] = [servo.step(float(x), float(dt)) for x, dt in zip(asked[:, column], np.diff(t, prepend=t[0]), strict=True)]
    return found
