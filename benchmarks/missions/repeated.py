"""Every use case twice, and with twenty seeds.

``twice``: passed: every criterion holds; equal: both runs have the same hash; simulated [s], and how much faster than real time in one
process. ``seeds``: runs that passed, and the 95 % interval of the success rate (Wilson); logs of those that did not are kept.
"""

import tempfile
from collections.abc import Callable
from pathlib import Path

import typer

from launch.campaign import run_seeds, success_interval
from launch.commands.bench import Figures
from launch.run import run_lockstep
from launch.runs import new_run
from uvf.models.scenario import ROOT, load_scenario

SEEDS = 20
USE_CASES = (
    "ugv1_waypoints",
    "ugv2_slam",
    "ugv3_team_slam",
    "ugv3_explore",
    "uav1_surfaces",
    "uav2_dubins",
    "leader_follower",
    "formation_dubins",
    "airship",
    "air_ground",
    "search",
    "convoy",
    "delivery",
    "fleet",
)


def twice(mission: str) -> Callable[[Path | None], Figures]:
    """What runs a mission twice."""

    def run(data: Path | None) -> Figures:
        site = load_scenario(ROOT / "missions" / f"{mission}.yaml")
        with tempfile.TemporaryDirectory() as folder:
            first, second = (run_lockstep(site, site.mission.duration, Path(folder) / f"{k}.mcap") for k in range(2))
        return {
            mission: {
                "passed": float(first.passed),
                "equal": float(first.log_hash == second.log_hash),
                "simulated": first.simulated,
                "real-time factor": first.simulated / min(first.wall, second.wall),
            }
        }

    return run


def seeds(mission: str) -> Callable[[Path | None], Figures]:
    """What runs a mission with many seeds."""

    def run(data: Path | None) -> Figures:
        runs = list(run_seeds(ROOT / "missions" / f"{mission}.yaml", SEEDS, None, new_run()))
        for line in (line for run in runs for line in run.complaints):
            typer.echo(f"{mission}, {line}")
        passed = sum(each.passed for each in runs)
        low, high = success_interval(passed, SEEDS)
        return {f"{mission}, {SEEDS} seeds": {"passed": float(passed), "of": float(SEEDS), "low %": 100 * low, "high %": 100 * high}}

    return run


CASES = {f"{kind}:{mission}": made(mission) for kind, made in (("twice", twice), ("seeds", seeds)) for mission in USE_CASES}
