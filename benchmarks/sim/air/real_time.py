"""sim_air alone with 1 to 10 aircraft, in lockstep: how much faster than real time it runs.

Each aircraft is a Milvus in level flight with all its sensors but the camera: IMU 100 Hz, GNSS 5 Hz, pressures 50 Hz, battery, joints,
truth 50 Hz; flight dynamics at 120 Hz in calm air and, ``turbulent x``, in moderate Dryden turbulence. ``log x`` is the same with an MCAP
log of everything; ``engine x`` is JSBSim's steps alone, commands standing, in the same run. Factors count this process's CPU time,
``wall x`` that on the clock; each is the fastest of three runs of ten seconds, for what else the machine does only slows them.
"""

import tempfile
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
import psutil
import yaml

from benchmarks.measuring.timing import stopwatch, timed
from schemas import topics
from schemas.messages import SurfaceCommand
from services.sim_air.build import build
from uvf.models.scenario import Scenario, load_scenario
from uvf.runtime.contract.declaration import Writes, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import stamp
from uvf.runtime.time.lockstep import Lockstep

SECONDS = 10.0
RUNS = 3
FLEETS = (1, 5, 10)
DYNAMICS_HZ = 120.0
SPACING = 40.0  # m, between levels
TURBULENT = {"turbulence": {"severity": "moderate"}}


class Steady(Service):
    """About the surfaces of level flight at 50 Hz."""

    name = "steady"
    hz = 50.0

    class Outputs(Writes):
        surfaces: SurfaceCommand | None = topic(topics.SURFACE_COMMAND)

    def step(self, t: float, now) -> Outputs:
        """The same deflections [rad] and throttle always."""
        return self.Outputs(surfaces=SurfaceCommand(timestamp=stamp(t), aileron=0.006, elevator=-0.135, rudder=-0.001, throttle=0.78))


def fleet(count: int, folder: Path, wind: dict[str, Any]) -> Scenario:
    """So many aircraft one above the other."""
    starts = [{"x": 0.0, "y": 0.0, "z": 400.0 + SPACING * i, "yaw": 0.0, "speed": 25.0} for i in range(count)]
    vehicles = {f"plane{i:02}": {"model": "milvus", "system_id": i, "start": start} for i, start in enumerate(starts, 1)}
    path = folder / "fleet.yaml"
    path.write_text(
        yaml.safe_dump({"about": "benchmark", "world": "empty", "seed": 1, "vehicles": vehicles, **({"wind": wind} if wind else {})})
    )
    site = load_scenario(path)
    members = {}
    for name, member in site.members.items():
        assert member.file.air is not None
        air = msgspec.structs.replace(member.file.air, physics_hz=DYNAMICS_HZ)
        members[name] = replace(member, file=msgspec.structs.replace(member.file, air=air))
    return replace(site, members=members)


def simulator(site: Scenario, log: Path | None = None) -> list[float]:
    """CPU and wall seconds of the run, without building."""
    drivers = [ServiceInstance(Steady, Steady, name) for name in site.members]
    lockstep = Lockstep(build(site) + drivers)
    try:
        taken = timed(lockstep, SECONDS, log)
        (service,) = (shell.service for shell in lockstep.shells if shell.service.name == "sim_air")
        assert not any(craft.wreck for craft in service._stage.aircraft.values()), "what lies on the ground costs nothing"  # type: ignore[attr-defined]
        return taken
    finally:
        lockstep.close()


def engine(site: Scenario) -> list[float]:
    """JSBSim's steps alone."""
    (host,) = build(site)
    service = host.make()
    engines = [craft.body._fdm for craft in service._stage.aircraft.values()]  # type: ignore[attr-defined]
    with stopwatch() as taken:
        for _ in range(round(SECONDS * DYNAMICS_HZ)):
            for one in engines:
                one.run()
    service.close()
    return taken


def fastest(run: Callable[[], list[float]]) -> list[float]:
    """The least CPU and the least wall seconds."""
    return [min(times) for times in zip(*(run() for _ in range(RUNS)), strict=True)]


def aircraft(data: Path | None) -> dict[str, dict[str, float]]:
    """A row for each of FLEETS: real-time factors [s/s] and resident memory [MB]."""
    figures: dict[str, dict[str, float]] = {}
    for count in FLEETS:
        with tempfile.TemporaryDirectory() as folder:
            site = fleet(count, Path(folder), {})
            cpu, wall = fastest(partial(simulator, site))
            logged, _ = fastest(partial(simulator, site, Path(folder, "log.mcap")))
            turbulent, _ = fastest(partial(simulator, fleet(count, Path(folder), TURBULENT)))
            alone, _ = fastest(partial(engine, site))
        figures[f"{count} aircraft"] = {
            "x": SECONDS / cpu,
            "wall x": SECONDS / wall,
            "turbulent x": SECONDS / turbulent,
            "log x": SECONDS / logged,
            "engine x": SECONDS / alone,
            "engine % of CPU": 100 * alone / cpu,
            "MB": psutil.Process().memory_info().rss / 1e6,
        }
    return figures


CASES = {"aircraft": aircraft}
