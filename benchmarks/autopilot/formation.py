"""The mission ``formation`` flown in lockstep, as it is and in moderate turbulence, judged from the truth.

``late``, ``aside`` and ``above`` are the distances of a follower from its station in m, ``least`` the smallest one between aircraft.
``python -m benchmarks.autopilot.formation docs/images`` draws docs/images/formation.png; ``... docs/images 60`` flies a minute only.
"""

import sys
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import msgspec
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from launch import catalogue
from launch.commands.bench import Figures
from launch.scoring.formation_scores import separation, station_errors
from launch.scoring.scores import Scorer
from uvf.models.mission.formation import Follow
from uvf.models.scenario import ROOT, Scenario, load_scenario
from uvf.models.world.wind import TurbulenceFile, Wind
from uvf.runtime.time.lockstep import Lockstep

Floats = NDArray[np.float64]
Motions = dict[str, Floats]
"""By aircraft, (n, 5) true t, x, y, z and airspeed."""

MISSION = ROOT / "missions" / "formation.yaml"
WINDS = {"light": None, "moderate": Wind((-6.2, 5.0, 0.0), turbulence=TurbulenceFile("moderate"))}
"""None: the mission's own."""
SHOWN = 260.0  # s, of tracks on the map
SAMPLES = 0.2  # s


def site_in(case: str) -> Scenario:
    """The mission in one of WINDS."""
    site, wind = load_scenario(MISSION), WINDS[case]
    return site if wind is None else replace(site, mission=msgspec.structs.replace(site.mission, wind=wind))


def fly(site: Scenario, seconds: float) -> Motions:
    """The true motions of so many seconds [s] in lockstep."""
    lockstep, scorer = Lockstep(catalogue.hosts(site, [catalogue.kind("sim_air"), catalogue.kind("autopilot")])), Scorer(site)
    scorer.follow(lockstep.bus)
    with closing(lockstep):
        lockstep.run(seconds)
    return scorer.motions()


def follows(site: Scenario) -> dict[str, Follow]:
    """By follower, whom it follows and where its station is."""
    return {name: m.entry.job.follow for name, m in site.members.items() if m.entry.job.follow is not None}


def errors(site: Scenario, flown: Motions) -> dict[str, Floats]:
    """By follower, (k, 4) t [s] and m late, right and above."""
    return {name: station_errors(flown[name], flown[follow.leader], follow) for name, follow in follows(site).items()}


def figures(site: Scenario, flown: Motions, case: str) -> Figures:
    """A row for each follower: distances from its station and the least one between aircraft [m]."""
    table: Figures = {}
    for name, rows in errors(site, flown).items():
        late, aside, above = np.sqrt(np.mean(rows[:, 1:] ** 2, axis=0))
        row = {"late rms": late, "late p95": np.percentile(abs(rows[:, 1]), 95), "late max": abs(rows[:, 1]).max()}
        row |= {"aside rms": aside, "aside max": abs(rows[:, 2]).max(), "above rms": above, "above max": abs(rows[:, 3]).max()}
        row["least"] = min(separation(flown[name], other)[0] for n, other in flown.items() if n != name)
        table[f"{name}, {case}"] = {metric: float(value) for metric, value in row.items()}
    return table


def draw(site: Scenario, cases: dict[str, Motions], path: Path) -> None:
    """The map of the first case; the distances from the stations of all, and between the aircraft."""
    figure = Figure(figsize=(15.0, 8.0), layout="constrained")
    grid = figure.add_gridspec(3, 1 + len(cases))
    _map(figure.add_subplot(grid[:, 0]), next(iter(cases.values())))
    for column, (case, flown) in enumerate(cases.items(), 1):
        found = errors(site, flown)
        for k, title in ((1, "late along the trail, m"), (2, "aside of it, m")):
            axes = figure.add_subplot(grid[k - 1, column])
            for name, rows in found.items():
                axes.plot(rows[:, 0], rows[:, k], linewidth=0.9, label=f"{name}: RMS {np.sqrt(np.mean(rows[:, k] ** 2)):.2f}")
            _finish(axes, f"{case}: {title}")
        axes = figure.add_subplot(grid[2, column])
        for a, b in combinations(flown, 2):
            t = np.arange(flown[a][0, 0], min(flown[a][-1, 0], flown[b][-1, 0]), SAMPLES)
            apart = np.linalg.norm([np.interp(t, *flown[a].T[[0, i]]) - np.interp(t, *flown[b].T[[0, i]]) for i in (1, 2, 3)], axis=0)
            axes.plot(t, apart, linewidth=0.9, label=f"{a[-1]} and {b[-1]}: at least {apart.min():.1f}")
        _finish(axes, f"{case}: between aircraft, m")
    figure.savefig(path, dpi=75)


def _map(axes: Axes, flown: Motions) -> None:
    for name, rows in flown.items():
        shown = rows[rows[:, 0] < SHOWN]
        axes.plot(shown[:, 1], shown[:, 2], linewidth=0.9, label=name)
    axes.set(aspect="equal", xlabel="east, m", ylabel="north, m")
    _finish(axes, f"tracks of the first {SHOWN:g} s")


def _finish(axes: Axes, title: str) -> None:
    axes.set_title(title)
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small", loc="upper right")


def case(name: str) -> Callable[[Path | None], Figures]:
    """What flies the mission in one of WINDS to its end."""

    def flown(data: Path | None) -> Figures:
        site = site_in(name)
        return figures(site, fly(site, site.mission.duration), name)

    return flown


CASES = {name: case(name) for name in WINDS}

if __name__ == "__main__":
    SECONDS = float(sys.argv[2]) if len(sys.argv) > 2 else load_scenario(MISSION).mission.duration
    FLOWN = {name: fly(site_in(name), SECONDS) for name in WINDS}
    draw(load_scenario(MISSION), FLOWN, Path(sys.argv[1]) / "formation.png")
    for CASE, MOTIONS in FLOWN.items():
        for NAME, ROW in figures(load_scenario(MISSION), MOTIONS, CASE).items():
            sys.stdout.write(f"{NAME:20} {'  '.join(f'{metric} {value:.2f}' for metric, value in ROW.items())}\n")
