"""One flight of the accuracy course by the autopilot on noisy sensors, and what is written down of it."""

import tempfile
from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import yaml

from benchmarks.autopilot.accuracy.course import HIGH, LOW, Course
from benchmarks.autopilot.accuracy.score import Flight, score
from launch import catalogue
from launch.vehicles.proof_flight import glide
from services.autopilot.air.mode_table import FlightMode
from services.autopilot.air.service import AutopilotAir
from services.sim_air.service import SimAir
from uvf.control import thesis
from uvf.maths import rotations
from uvf.maths.geodesy import LocalTangent
from uvf.models.scenario import ROOT, Scenario, load_scenario
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.vehicle.sensor_presets import PRESETS
from uvf.runtime.time.lockstep import Lockstep

LONGEST = 2400.0  # s
PLANE = "plane"
WIND, SHARE = 10.0, 0.9  # m/s, from behind; of the climb and the sink that the aircraft has
UP, DOWN = 600.0, 450.0  # m, of the legs that climb and descend
PLACED = ("mount", "frame")  # of a sensor, whatever its preset


@dataclass(frozen=True)
class Case:
    """The air, and the seed of everything random."""

    steady: tuple[float, float] = (0.0, 0.0)  # m/s north and east, the way it blows to
    severity: str = ""
    seed: int = 1

    def wind(self) -> dict[str, Any]:
        """As a mission file states it: steady [m/s], east first, and turbulence."""
        wind: dict[str, Any] = {"steady": [self.steady[1], self.steady[0], 0.0]}
        return wind | ({"turbulence": {"severity": self.severity}} if self.severity else {})


def course_site(model: str, case: Case, preset: str, folder: Path, root: Path = ROOT) -> tuple[Scenario, Course]:
    """A mission over the course with the sensors of this preset; those that have none of that name are the vehicle's own.

    root: holds ``vehicles`` and ``worlds``; slopes are those that an aircraft of another root than ours can fly.
    """
    probe = {"model": model, "system_id": 1, "start": {"x": 0.0, "y": 0.0, "z": 100.0}}
    mission: dict[str, Any] = {"about": "accuracy", "world": "empty", "seed": case.seed, "wind": case.wind(), "vehicles": {PLANE: probe}}
    path = folder / "accuracy.yaml"
    path.write_text(yaml.safe_dump(mission))
    params = load_scenario(path, root).members[PLANE].params("autopilot_air", AirParams)
    course = Course(params.trim_airspeed) if root == ROOT else _within_reach(params)
    probe |= course.mission()
    path.write_text(yaml.safe_dump(mission))
    return _with_sensors(load_scenario(path, root), preset), course


def _within_reach(params: AirParams) -> Course:
    """Of slopes that the aircraft can fly with the wind from behind."""
    whole = Course(params.trim_airspeed)
    if slope := glide(params):
        return Course(params.trim_airspeed, 0.0, slope)
    fastest, designed = params.trim_airspeed + WIND, whole.scale * (HIGH - LOW)
    reached = [SHARE * climb * whole.scale * length / fastest for climb, length in ((params.climb_max, UP), (params.sink_max, DOWN))]
    return whole if min(reached) >= designed else Course(params.trim_airspeed, min(reached))


def _with_sensors(site: Scenario, preset: str) -> Scenario:
    member = site.members[PLANE]
    sensors = member.file.sensors
    for kind, presets in PRESETS.items():
        own = getattr(sensors, kind)
        if own is not None and preset in presets:
            placed = {name: getattr(own, name) for name in PLACED if hasattr(own, name)}
            taken: dict[str, Any] = {**presets[preset], **placed}
            sensors = msgspec.structs.replace(sensors, **{kind: type(own)(**taken)})
    return replace(site, members={PLANE: replace(member, file=msgspec.structs.replace(member.file, sensors=sensors))})


class Probe:
    """Looks into both services at every tick."""

    def __init__(self, lockstep: Lockstep, site: Scenario) -> None:
        services = [shell.service for shell in lockstep.shells]
        (sim,) = (s for s in services if isinstance(s, SimAir))
        (self.autopilot,) = (s for s in services if isinstance(s, AutopilotAir))
        self.craft = sim._stage.aircraft[PLANE]
        origin = site.world.origin
        self._tangent = LocalTangent.from_degrees(origin.latitude, origin.longitude, origin.altitude)
        self.rows: list[tuple[float, ...]] = []

    def __call__(self, t: float) -> bool:
        """Whether to go on."""
        pilot, now, motion = self.autopilot._mode_manager, self.autopilot._now, self.craft.motion
        if now is None:
            return True
        east, north, _ = motion.position.tolist()
        height = self._tangent.geodetic(motion.position)[2] - self._tangent.altitude  # the tangent plane leaves the Earth's surface
        roll, _, _ = rotations.to_euler(motion.world_from_body)
        s, wind = self.craft.actuators.position, self.craft.wind
        piece, params = pilot.navigator._piece, self.autopilot.params
        true = replace(now, north=north, east=east, height=height)
        off = (piece.aim(true, params).error, piece.aim(now, params).error) if piece is not None else (0.0, 0.0)
        wind_error = float(np.hypot(now.wind_east - wind[0], now.wind_north - wind[1]))
        speeds, surfaces = (motion.airspeed, now.airspeed), (s.aileron, s.elevator, s.rudder, s.throttle)
        self.rows.append((t, north, east, height, now.north, now.east, now.height, *speeds, *surfaces, *off, roll, wind_error))
        return not pilot.navigator.finished and self.craft.wreck is None and pilot.mode is FlightMode.MISSION

    def flight(self) -> Flight:
        """What has been seen so far, column by column."""
        x = np.array(self.rows)
        return Flight(x[:, 0], x[:, 1:4], x[:, 4:7], x[:, 7:9], x[:, 9:13], x[:, 13:15], x[:, 15], x[:, 16])


def fly(
    model: str, case: Case, preset: str = "good", params: Mapping[str, Any] = {}, law: str = "energy", root: Path = ROOT
) -> tuple[Flight, Course]:
    """One flight of the course by one of the autopilot's laws of control; root: as for ``course_site``. Raises BadInput."""
    with tempfile.TemporaryDirectory() as folder:
        site, course = course_site(model, case, preset, Path(folder), root)
    hosts = catalogue.hosts(site, [catalogue.kind("sim_air"), catalogue.kind("autopilot")])
    lockstep = Lockstep(hosts)
    with closing(lockstep):
        probe = Probe(lockstep, site)
        own = probe.autopilot.params
        gains = thesis.preset(own.trim_airspeed) if law == "thesis" else {}
        probe.autopilot.params = msgspec.structs.replace(own, **{**gains, **params})
        lockstep.run(LONGEST, probe)
    return probe.flight(), course


def scored(model: str, case: Case, preset: str, params: Mapping[str, Any], law: str, root: Path = ROOT) -> dict[str, float]:
    """Figures of one flight; none where it did not fly the course."""
    flight, course = fly(model, case, preset, params, law, root)
    try:
        return score(flight, course)
    except ValueError:
        return {}
