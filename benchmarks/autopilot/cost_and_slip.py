"""What the autopilot of one aircraft costs, and what its side-slip loop does.

``cost``: CPU time of the autopilot's service with its shell (messages decoded, step, messages encoded) on the accuracy course in 10 m/s
with moderate turbulence, in lockstep: what it takes of a core at real time; a bus comes on top.
``slip``: mean true side slip over the last 15 of 60 s in calm air, level and in a circle, with rudders rigged 0.1 rad aside or not.
"""

import tempfile
import time
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import yaml

from benchmarks.autopilot.accuracy.flight import PLANE, Case, Probe, course_site
from launch import catalogue
from launch.commands.bench import Figures
from services.autopilot.air.service import AutopilotAir
from uvf.maths import rotations
from uvf.models.scenario import Scenario, load_scenario
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.time.lockstep import Lockstep

KINDS = ["sim_air", "autopilot"]
WARM_UP, SECONDS = 10.0, 60.0  # s
SLIP_SECONDS, SETTLED = 60.0, 45.0  # s
RIGGED = 0.1  # rad, of both rudders
STRAIGHT: dict[str, Any] = {"x": 5000.0, "y": 0.0, "z": 150.0}
CIRCLE: dict[str, Any] = {"kind": "orbit", "x": 300.0, "y": 100.0, "z": 150.0, "radius": 100.0}


def lockstep_of(site: Scenario) -> Lockstep:
    """The simulator of aircraft and the autopilot alone."""
    return Lockstep(catalogue.hosts(site, [catalogue.kind(name) for name in KINDS]))


class Stopwatch:
    """Stands in for a shell's ``advance``; ``taken``: CPU seconds of each step."""

    def __init__(self, shell: ServiceRunner) -> None:
        self._advance = shell.advance
        self.taken: list[float] = []
        shell.advance = self  # type: ignore[method-assign, assignment]

    def __call__(self) -> None:
        """One step, with its CPU time [s] kept."""
        begun = time.thread_time()
        self._advance()
        self.taken.append(time.thread_time() - begun)


def cost(estimator: str) -> dict[str, float]:
    """Times [ms] of the autopilot's steps with one estimator: per simulated second, and of a step the mean and the 99th percentile."""
    with tempfile.TemporaryDirectory() as folder:
        site, _ = course_site("milvus", Case((0.0, -10.0), "moderate"), "good", Path(folder))
    member = site.members[PLANE]
    own = member.file.params | {"autopilot_air": {**member.file.params["autopilot_air"], "estimator": estimator}}
    site = replace(site, members={PLANE: replace(member, file=msgspec.structs.replace(member.file, params=own))})
    lockstep = lockstep_of(site)
    with closing(lockstep):
        (shell,) = (s for s in lockstep.shells if isinstance(s.service, AutopilotAir))
        lockstep.run(WARM_UP)
        watch = Stopwatch(shell)
        lockstep.run(WARM_UP + SECONDS)
    taken = 1e3 * np.array(watch.taken)
    per_second = float(taken.sum()) / SECONDS
    return {
        "ms per s": per_second,
        "% of a core": per_second / 10,
        "step ms": float(taken.mean()),
        "99 % ms": float(np.percentile(taken, 99)),
    }


def slip(item: dict[str, Any], rigged: float, has_loop: bool) -> float:
    """deg, wind from the right positive."""
    start = {"x": 0.0, "y": 0.0, "z": 150.0, "yaw": 0.0, "speed": 25.0}
    vehicle = {"model": "milvus", "system_id": 1, "start": start, "job": {"mission": [item]}}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "slip.yaml"
        path.write_text(yaml.safe_dump({"about": "slip", "world": "empty", "seed": 1, "vehicles": {PLANE: vehicle}}))
        site = load_scenario(path)
    member = site.members[PLANE]
    assert member.file.air is not None
    offsets = {f"fcs/{side}-rudder-offset-rad": rigged for side in ("left", "right")}
    air = msgspec.structs.replace(member.file.air, settings=member.file.air.settings | offsets)
    site = replace(site, members={PLANE: replace(member, file=msgspec.structs.replace(member.file, air=air))})
    lockstep = lockstep_of(site)
    with closing(lockstep):
        probe = Probe(lockstep, site)
        if not has_loop:
            probe.autopilot.params = msgspec.structs.replace(probe.autopilot.params, slip_i=0.0)
        seen: list[float] = []

        def look(t: float) -> bool:
            if t > SETTLED:
                seen.append(_side_slip(probe))
            return True

        lockstep.run(SLIP_SECONDS, look)
    return float(np.degrees(np.mean(seen)))


def _side_slip(probe: Probe) -> float:
    """rad."""
    motion = probe.craft.motion
    x, y, z = rotations.matrix(motion.world_from_body).T @ (motion.velocity - np.array(probe.craft.wind))
    return float(-np.arcsin(y / np.linalg.norm((x, y, z))))


def costs(data: Path | None) -> Figures:
    """A row for each estimator, ``full`` and ``book``."""
    return {f"milvus, estimator {kind}": cost(kind) for kind in ("full", "book")}


def slips(data: Path | None) -> Figures:
    """Mean true side slip [deg] of each flight, with the loop and without it."""
    flown = {"level": (STRAIGHT, 0.0), "level, rigged": (STRAIGHT, RIGGED), "circle": (CIRCLE, 0.0), "circle, rigged": (CIRCLE, RIGGED)}
    return {f"slip, {name}": {"deg": slip(*of, True), "deg without its loop": slip(*of, False)} for name, of in flown.items()}


CASES = {"cost": costs, "slip": slips}
