"""Real-time factors in lockstep: the whole demo, and each simulator alone with its sensors."""

import tempfile
import time
from pathlib import Path

from uvf.launch import catalogue
from uvf.launch.run import run_lockstep
from uvf.runtime.lockstep import Lockstep
from uvf.runtime.site import ROOT, load_site

DEMO = ROOT / "missions" / "demo.yaml"
SECONDS = 30.0


def demo(data: Path | None) -> dict[str, dict[str, float]]:
    """Everything of the demo with its log: physics at the vehicles' own steps, cameras, lidar, SLAM, planner, autopilots."""
    with tempfile.TemporaryDirectory() as folder:
        result = run_lockstep(load_site(DEMO), SECONDS, Path(folder, "log.mcap"))
    return {"demo": {"real-time factor": result.factor, "ms per s": 1000 / result.factor, "messages per s": result.messages / SECONDS}}


def each(data: Path | None) -> dict[str, dict[str, float]]:
    """One kind of service at a time; those that need others' messages stay idle and are left out."""
    site, figures = load_site(DEMO), {}
    for kind in catalogue.KINDS:
        if kind.simulator:
            lockstep = Lockstep(catalogue.hosts(site, [kind]))
            begun = time.perf_counter()
            lockstep.run(SECONDS)
            wall = time.perf_counter() - begun
            lockstep.close()
            figures[kind.name] = {"real-time factor": SECONDS / wall, "ms per s": 1000 * wall / SECONDS}
    return figures


CASES = {"demo": demo, "each": each}
