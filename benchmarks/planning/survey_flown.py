"""A survey planned, and its mission flown in lockstep by an aircraft of JSBSim: what its true track covers, against the plan.

Covered is the area within half a spacing beside the true track while the camera is on; ``aside`` is the distance of the true track from
the swath there, ``bank`` the bank at the first picture of each swath, ``pictures / planned`` their number over length / trigger distance.
``python -m benchmarks.planning.survey_flown OUT`` draws OUT/survey-flown.png.
"""

import sys
import tempfile
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from launch import catalogue
from launch.commands.bench import Figures
from launch.planning.survey import Survey, SurveyWishes, plan_survey
from services.autopilot.air.service import AutopilotAir
from services.sim_air.service import SimAir
from uvf.maths import rotations
from uvf.models.scenario import load_scenario
from uvf.planning.coverage.plan import covered_share
from uvf.runtime.time.lockstep import Lockstep

Floats = NDArray[np.float64]

OUTLINE = [[-240, -200], [210, -190], [260, 40], [120, 60], [60, 260], [-180, 230]]
HOLE = [[-20, -60], [60, -50], [40, 10], [-30, 0]]
HEIGHT = 80.0  # m
BEYOND = 20.0  # m, by which a swath is longer as a line to be beside of
WINDS = {"calm": (0.0, 0.0), "wind 5 m/s": (4.0, -3.0), "wind 10 m/s": (-6.0, 8.0)}


@dataclass(frozen=True)
class Flown:
    """A survey and its flight: rows (k, 6) of t [s], x, y [m], bank [rad], whether the camera is on, pictures so far."""

    survey: Survey
    rows: Floats

    @property
    def swept(self) -> shapely.Geometry:
        """What lies within half a spacing beside the true track while the camera was on."""
        on = self.rows[:, 4] > 0
        edges = np.flatnonzero(np.diff(np.concatenate(((False,), on, (False,))).astype(int))).reshape(-1, 2)
        lines = [shapely.LineString(self.rows[a:b, 1:3]) for a, b in edges if b - a > 1]
        return shapely.union_all([shapely.buffer(line, self.survey.plan.width / 2, cap_style="flat") for line in lines])


class Probe:
    """Looks into both services at every tick."""

    def __init__(self, lockstep: Lockstep) -> None:
        services = [shell.service for shell in lockstep.shells]
        (sim,) = (s for s in services if isinstance(s, SimAir))
        (self._autopilot,) = (s for s in services if isinstance(s, AutopilotAir))
        (self._craft,) = sim._stage.aircraft.values()
        self.rows: list[tuple[float, ...]] = []

    def __call__(self, t: float) -> bool:
        """Whether the mission goes on."""
        navigator, motion = self._autopilot._mode_manager.navigator, self._craft.motion
        bank, _, _ = rotations.to_euler(motion.world_from_body)
        self.rows.append((t, *motion.position[:2].tolist(), bank, navigator.camera._distance, navigator.camera.pictures))
        return not navigator.finished


def fly(wind: tuple[float, float]) -> Flown:
    """The survey of the field planned for a wind [m/s, east and north] and flown in it."""
    with tempfile.TemporaryDirectory() as folder:
        area, mission = Path(folder) / "area.yaml", Path(folder) / "survey.yaml"
        area.write_text(f"outline: {OUTLINE}\nholes: [{HOLE}]\n")
        wishes = SurveyWishes(area, HEIGHT, "milvus", "empty", wind, None, (0.6, 0.75), None, None, None, None, None, 1)
        survey = plan_survey(wishes)
        mission.write_text(survey.mission_text())
        site = load_scenario(mission)
    lockstep = Lockstep(catalogue.hosts(site, [catalogue.kind("sim_air"), catalogue.kind("autopilot")]))
    with closing(lockstep):
        probe = Probe(lockstep)
        lockstep.run(site.mission.duration, probe)
    return Flown(survey, np.array(probe.rows))


def figures(flown: Flown) -> dict[str, float]:
    """The row of one flight."""
    plan, rows = flown.survey.plan, flown.rows
    on = rows[:, 4] > 0
    away = plan.swaths[:, 2:] - plan.swaths[:, :2]
    on_by = BEYOND * away / np.hypot(*away.T)[:, None]
    lines = shapely.linestrings(np.hstack((plan.swaths[:, :2] - on_by, plan.swaths[:, 2:] + on_by)).reshape(-1, 2, 2))
    aside = shapely.distance(shapely.MultiLineString(list(lines)), shapely.points(rows[on, 1:3]))
    begins = np.flatnonzero(np.diff(np.concatenate(((False,), on)).astype(int)) == 1)
    return {
        "swaths": len(plan.swaths),
        "covered planned, %": 100 * plan.covered,
        "covered flown, %": 100 * covered_share(plan.field, flown.swept),
        "aside rms, m": float(np.sqrt(np.mean(aside**2))),
        "aside max, m": float(aside.max()),
        "bank, deg": float(np.degrees(np.abs(rows[begins, 3]).max())),
        "pictures / planned": float(rows[-1, 5] / (plan.swath_length / flown.survey.flight.trigger)),
        "time planned, s": plan.time,
        "time flown, s": float(rows[-1, 0] - rows[begins[0], 0]),
    }


def measure(data: Path | None) -> Figures:
    """A row for each wind."""
    return {name: figures(fly(wind)) for name, wind in WINDS.items()}


def draw(axes: Axes, name: str, flown: Flown) -> None:
    """The field, what was covered, the swaths, and the true track."""
    plan, rows = flown.survey.plan, flown.rows
    for part in shapely.get_parts(flown.swept):
        axes.fill(*part.exterior.xy, facecolor="#cfe3f5", edgecolor="none")
        for hole in part.interiors:
            axes.fill(*hole.xy, facecolor="w", edgecolor="none")
    for ring in plan.field.rings:
        axes.plot(*np.concatenate((ring, ring[:1])).T, "k", linewidth=1.2)
    for x0, y0, x1, y1 in plan.swaths:
        axes.plot((x0, x1), (y0, y1), "C1", linewidth=3.0, alpha=0.5)
    axes.plot(rows[:, 1], rows[:, 2], "0.3", linewidth=0.7)
    on = rows[:, 4] > 0
    axes.plot(np.where(on, rows[:, 1], np.nan), np.where(on, rows[:, 2], np.nan), "C0", linewidth=1.2)
    row = figures(flown)
    axes.set_title(f"{name}: covered {row['covered flown, %']:.2f} % flown, {row['covered planned, %']:.2f} % planned", fontsize=9)
    axes.set_aspect("equal")


def main(out: Path) -> None:
    """Draws each flight and says its figures."""
    figure = Figure(figsize=(18.0, 6.5), layout="constrained")
    for axes, (name, wind) in zip(figure.subplots(1, len(WINDS)), WINDS.items(), strict=True):
        flown = fly(wind)
        draw(axes, name, flown)
        sys.stdout.write(f"{name:12} {'  '.join(f'{metric} {value:.4g}' for metric, value in figures(flown).items())}\n")
    figure.savefig(out / "survey-flown.png", dpi=65)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
