"""sim_ground alone with 1 to 20 vehicles in the house, in lockstep: how much faster than real time it runs.

Each vehicle is a burger that drives circles, with a lidar of 360 beams at 5 Hz, an IMU at 200 Hz, encoders at 50 Hz, truth at 50 Hz;
physics steps at 200 Hz. ``log x`` is the same with an MCAP log of everything; ``engine x`` is PyBullet's steps alone on the same world
and commands, in the same run. Factors count this process's CPU time, ``wall x`` that on the clock.
"""

import itertools
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import psutil
import pybullet
import yaml

from benchmarks.measuring.timing import stopwatch, timed
from schemas import topics
from schemas.messages import WheelCommand
from services.sim_ground.build import build
from tests.runtime.stepping import stepped
from uvf.models.scenario import ROOT, Scenario, load_scenario
from uvf.models.world.file import load_world
from uvf.models.world.footing import Footing
from uvf.runtime.contract.declaration import Writes, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import stamp
from uvf.runtime.time.lockstep import Lockstep

SECONDS = 10.0
FLEETS = (1, 5, 10, 20)
IMU_HZ = 200.0
SPACING, ROOM = 0.9, 0.4  # m


class Circling(Service):
    """Circles of 0.1 m radius: 0.1 m/s, 1 rad/s."""

    name = "circling"
    hz = 50.0

    class Outputs(Writes):
        wheels: WheelCommand | None = topic(topics.WHEEL_COMMAND)

    def step(self, t: float, now) -> Outputs:
        """The same wheel speeds [rad/s] always."""
        return self.Outputs(wheels=WheelCommand(timestamp=stamp(t), left=0.6, right=5.4))


def fleet(count: int, folder: Path) -> Scenario:
    """So many burgers where there is room for them."""
    footing = Footing(load_world(ROOT / "worlds", "house"))
    grid = itertools.product(range(1, 10), range(1, 14))
    free = [(x * SPACING, y * SPACING) for y, x in grid if footing.at(x * SPACING, y * SPACING).room > ROOM]
    starts = [{"x": x, "y": y, "yaw": 0.0} for x, y in free[:count]]
    vehicles = {f"rover{i:02}": {"model": "burger", "system_id": i, "start": start} for i, start in enumerate(starts, 1)}
    path = folder / "fleet.yaml"
    path.write_text(yaml.safe_dump({"about": "benchmark", "world": "house", "seed": 1, "vehicles": vehicles}))
    site = load_scenario(path)
    members = {}
    for name, member in site.members.items():
        imu = msgspec.structs.replace(member.file.sensors.imu, hz=IMU_HZ)
        sensors = msgspec.structs.replace(member.file.sensors, imu=imu)
        members[name] = replace(member, file=msgspec.structs.replace(member.file, sensors=sensors))
    return replace(site, members=members)


def simulator(site: Scenario, log: Path | None = None) -> list[float]:
    """CPU and wall seconds of the run, without building."""
    drivers = [ServiceInstance(Circling, Circling, name) for name in site.members]
    lockstep = Lockstep(build(site) + drivers)
    try:
        return timed(lockstep, SECONDS, log)
    finally:
        lockstep.close()


NOTHING = ("spawn", "remove", "set_pose", "save", "restore")
IDLE: dict[str, Any] = {"joint_commands": {}, "truth": {}, "flying": None, **{name: [] for name in NOTHING}}


def engine(site: Scenario) -> list[float]:
    """PyBullet's steps alone, the wheels turning."""
    (host,) = build(site)
    service = host.make()
    world = service._world  # type: ignore[attr-defined]
    commands = {name: WheelCommand(left=0.6, right=5.4) for name in site.members}
    for n in range(1, 51):
        stepped(service, n / 100, **IDLE, commands=commands)
    with stopwatch() as taken:
        for _ in range(round(SECONDS * world.rate)):
            pybullet.stepSimulation(physicsClientId=world.engine.client)
    service.close()
    return taken


def vehicles(data: Path | None) -> dict[str, dict[str, float]]:
    """A row for each of FLEETS: real-time factors [s/s] and resident memory [MB]."""
    figures: dict[str, dict[str, float]] = {}
    for count in FLEETS:
        with tempfile.TemporaryDirectory() as folder:
            site = fleet(count, Path(folder))
            cpu, wall = simulator(site)
            logged, _ = simulator(site, Path(folder, "log.mcap"))
            alone, _ = engine(site)
        figures[f"{count} vehicles"] = {
            "x": SECONDS / cpu,
            "wall x": SECONDS / wall,
            "log x": SECONDS / logged,
            "engine x": SECONDS / alone,
            "sim / engine": cpu / alone,
            "MB": psutil.Process().memory_info().rss / 1e6,
        }
    return figures


CASES = {"vehicles": vehicles}
