"""Flight accuracy: the course flown by the autopilot on noisy sensors, scored from the truth, in calm, wind and turbulence.

``python -m benchmarks.accuracy NAME [CASE ...]`` flies one aircraft, several cases at once on as many processors.
"""

import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import yaml

from benchmarks.accuracy_course import Course
from benchmarks.accuracy_score import Flight, score
from services.autopilot.air import thesis
from services.autopilot.air.params import AirParams
from services.autopilot.air.service import AutopilotAir
from services.sim_air.service import SimAir
from uvf.launch import catalogue
from uvf.launch.bench import Figures
from uvf.maths import rotations
from uvf.runtime.lockstep import Lockstep
from uvf.runtime.sensor_presets import PRESETS
from uvf.runtime.site import Site, load_site

LONGEST = 1200.0  # s
PLANE = "plane"
SEEDS = range(1, 6)
SHOWN = ("xtrack", "p95", "max", "control", "estimation", "path", "orbit", "level", "slope", "V sd", "deg/s", "orbit deg/s", "throttle/s")
COMPARED = ("xtrack", "orbit", "level", "V sd", "deg/s", "orbit deg/s", "throttle/s")
"""Of the same flights by the thesis' control."""
BESIDE = (*SHOWN, *(f"thesis {metric}" for metric in COMPARED), "of thesis")


@dataclass(frozen=True)
class Case:
    """The air, and the seed of everything random."""

    steady: tuple[float, float] = (0.0, 0.0)  # m/s north and east, the way it blows to
    severity: str = ""
    seed: int = 1

    def wind(self) -> dict[str, Any]:
        wind: dict[str, Any] = {"steady": [self.steady[1], self.steady[0], 0.0]}
        return wind | ({"turbulence": {"severity": self.severity}} if self.severity else {})


ONE = {
    "calm": (Case(),),
    "5 from N": (Case((-5.0, 0.0)),),
    "5 from E": (Case((0.0, -5.0)),),
    "10 from N": (Case((-10.0, 0.0)),),
    "10 from E": (Case((0.0, -10.0)),),
    "light": tuple(Case(severity="light", seed=s) for s in SEEDS),
    "moderate": tuple(Case(severity="moderate", seed=s) for s in SEEDS),
    "10 from E, moderate": tuple(Case((0.0, -10.0), "moderate", s) for s in SEEDS),
}


def course_site(model: str, case: Case, preset: str, folder: Path) -> tuple[Site, Course]:
    """A mission over the course with the gnss of this preset (``own``: the vehicle's)."""
    probe = {"model": model, "system_id": 1, "start": {"x": 0.0, "y": 0.0, "z": 100.0}}
    mission: dict[str, Any] = {"about": "accuracy", "world": "empty", "seed": case.seed, "wind": case.wind(), "vehicles": {PLANE: probe}}
    path = folder / "accuracy.yaml"
    path.write_text(yaml.safe_dump(mission))
    params = load_site(path).members[PLANE].params("autopilot_air", AirParams)
    course = Course(params.trim_airspeed)
    probe |= course.mission()
    path.write_text(yaml.safe_dump(mission))
    site = load_site(path)
    return (_with_gnss(site, preset) if preset != "own" else site), course


def _with_gnss(site: Site, preset: str) -> Site:
    member = site.members[PLANE]
    gnss = msgspec.convert({**PRESETS["gnss"][preset]}, type(member.file.sensors.gnss))
    sensors = msgspec.structs.replace(member.file.sensors, gnss=gnss)
    return replace(site, members={PLANE: replace(member, file=msgspec.structs.replace(member.file, sensors=sensors))})


class Probe:
    """Looks into both services at every tick."""

    def __init__(self, lockstep: Lockstep) -> None:
        services = [shell.service for shell in lockstep.shells]
        (sim,) = (s for s in services if isinstance(s, SimAir))
        (self.autopilot,) = (s for s in services if isinstance(s, AutopilotAir))
        self.craft = sim._stage.aircraft[PLANE]
        self.rows: list[tuple[float, ...]] = []

    def __call__(self, t: float) -> bool:
        """Whether to go on."""
        pilot, now, motion = self.autopilot._pilot, self.autopilot._now, self.craft.motion
        if now is None:
            return True
        east, north, height = motion.position.tolist()
        roll, _, _ = rotations.to_euler(motion.world_from_body)
        s, wind = self.craft.actuators.position, self.craft.wind
        piece = pilot.navigator._piece
        true = replace(now, north=north, east=east, height=height)
        off = piece.aim(true, self.autopilot.params).error if piece is not None else 0.0
        wind_error = float(np.hypot(now.wind_east - wind[0], now.wind_north - wind[1]))
        surfaces = (s.aileron, s.elevator, s.rudder, s.throttle)
        self.rows.append((t, north, east, height, now.north, now.east, now.height, motion.airspeed, *surfaces, off, roll, wind_error))
        return not pilot.navigator.finished and self.craft.wreck is None

    def flight(self) -> Flight:
        x = np.array(self.rows)
        return Flight(x[:, 0], x[:, 1:4], x[:, 4:7], x[:, 7], x[:, 8:12], x[:, 12], x[:, 13], x[:, 14])


def fly(model: str, case: Case, preset: str = "good", params: Mapping[str, Any] = {}, law: str = "energy") -> tuple[Flight, Course]:
    """One flight of the course by one of the autopilot's laws of control. Raises BadInput."""
    with tempfile.TemporaryDirectory() as folder:
        site, course = course_site(model, case, preset, Path(folder))
    hosts = catalogue.hosts(site, [catalogue.kind("sim_air"), catalogue.kind("autopilot")])
    lockstep = Lockstep(hosts)
    with closing(lockstep):
        probe = Probe(lockstep)
        own = probe.autopilot.params
        gains = thesis.preset(own.trim_airspeed) if law == "thesis" else {}
        probe.autopilot.params = msgspec.structs.replace(own, **{**gains, **params})
        lockstep.run(LONGEST, probe)
    return probe.flight(), course


def scored(model: str, preset: str, params: Mapping[str, Any], case: Case, law: str = "energy") -> dict[str, float]:
    return score(*fly(model, case, preset, params, law))


def compared(model: str, preset: str, params: Mapping[str, Any], case: Case) -> dict[str, float]:
    """What the thesis' control makes of the same flight; nan where it does not fly the course."""
    try:
        row = scored(model, preset, params, case, "thesis")
    except ValueError:
        row = dict.fromkeys(COMPARED, float("nan"))
    return {f"thesis {metric}": row[metric] for metric in COMPARED}


def table(model: str, preset: str, names: list[str], params: Mapping[str, Any]) -> Iterator[tuple[str, dict[str, float]]]:
    """Name of the case -> mean over its seeds, and beside it the thesis' control over the same seeds."""
    with ProcessPoolExecutor() as pool:
        jobs = {n: [[pool.submit(law, model, preset, params, case) for law in (scored, compared)] for case in ONE[n]] for n in names}
        for name, pairs in jobs.items():
            rows = [ours.result() | theirs.result() for ours, theirs in pairs]
            mean = {metric: float(np.mean([row[metric] for row in rows])) for metric in rows[0]}
            yield name, mean | {"of thesis": mean["deg/s"] / mean["thesis deg/s"]}


def case(model: str, preset: str) -> Callable[[Path | None], Figures]:
    return lambda data: {f"{model}, {preset}, {name}": {m: row[m] for m in BESIDE} for name, row in table(model, preset, list(ONE), {})}


CASES = {"milvus": case("milvus", "good"), "milvus_book": case("milvus", "book"), "stick25": case("stick25", "good")}

if __name__ == "__main__":
    MODEL, *WANTED = sys.argv[1:]
    PARAMS = {k: float(v) for k, v in (w.split("=") for w in WANTED if "=" in w)}
    NAMES = [w for w in WANTED if "=" not in w] or list(ONE)
    for NAME, ROW in table(MODEL, "good", NAMES, PARAMS):
        sys.stdout.write(f"{NAME:20} {'  '.join(f'{metric} {value:.2f}' for metric, value in ROW.items())}\n")
        sys.stdout.flush()
