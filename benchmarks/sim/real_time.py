"""Real-time factors in lockstep: the whole demo, and each simulator alone with its sensors."""

import tempfile
import time
from pathlib import Path
from statistics import median
from unittest.mock import patch

from benchmarks.measuring.timing import timed
from launch import catalogue
from launch.run import run_lockstep
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.bus import wire
from uvf.runtime.time.lockstep import Lockstep

DEMO = ROOT / "missions" / "demo.yaml"
SECONDS = 30.0
ROUNDS = 5


def demo(data: Path | None) -> dict[str, dict[str, float]]:
    """Everything of the demo with its log: physics at the vehicles' own steps, cameras, lidar, SLAM, planner, autopilots."""
    with tempfile.TemporaryDirectory() as folder:
        result = run_lockstep(load_scenario(DEMO), SECONDS, Path(folder, "log.mcap"))
    return {"demo": {"real-time factor": result.factor, "ms per s": 1000 / result.factor, "messages per s": result.messages / SECONDS}}


def each(data: Path | None) -> dict[str, dict[str, float]]:
    """One kind of service at a time; those that need others' messages stay idle and are left out."""
    site, figures = load_scenario(DEMO), {}
    for kind in catalogue.KINDS:
        if kind.simulator:
            lockstep = Lockstep(catalogue.hosts(site, [kind]))
            begun = time.perf_counter()
            lockstep.run(SECONDS)
            wall = time.perf_counter() - begun
            lockstep.close()
            figures[kind.name] = {"real-time factor": SECONDS / wall, "ms per s": 1000 * wall / SECONDS}
    return figures


def border(data: Path | None) -> dict[str, dict[str, float]]:
    """What it costs that services check all they hear: CPU time of the demo with the checks to that without, taking turns."""
    site = load_scenario(DEMO)
    kinds = [kind for kind in catalogue.needed(site) if kind.clock == "sim"]
    taken: dict[bool, list[float]] = {True: [], False: []}
    for _ in range(ROUNDS):
        for checked in taken:
            lockstep = Lockstep(catalogue.hosts(site, kinds))
            with patch.object(wire, "error_in", wire.error_in if checked else lambda message: ""):
                taken[checked].append(timed(lockstep, SECONDS, None)[0])
            lockstep.close()
    return {"demo, checks": {"ms per s": 1000 * median(taken[True]) / SECONDS, "ratio": median(taken[True]) / median(taken[False])}}


CASES = {"border": border, "demo": demo, "each": each}
