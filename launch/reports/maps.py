"""The maps of a run, as they lie in the world, and how well they fit it."""

from dataclasses import dataclass

from launch.reports.recorded_run import RecordedRun
from launch.scoring.map_measures import placed_in_world
from schemas.messages import Grid
from uvf.maths.se2 import Pose2
from uvf.models.world.geometry import floor_plan
from uvf.models.world.map_file import GridMap
from uvf.models.yaml_data import BadInput
from uvf.slam.maps.quality import MapScore, score

PLAN_CELL = 0.02  # m
LARGEST = 40_000_000  # cells of a floor plan


@dataclass(frozen=True)
class ReportedMap:
    """A map at the end of a run; score: None where the world is too large to be held against it."""

    name: str
    grid: GridMap
    score: MapScore | None


def own_map(run: RecordedRun, name: str, topic: str = "map/grid") -> GridMap | None:
    """The last map of a vehicle on a topic, in the world frame; None where it has none, or nobody knows where it lies."""
    payload = run.vehicles[name].maps.get(topic)
    if payload is None or run.site is None or name not in run.site.members:
        return None
    try:
        grid = placed_in_world(Grid.FromString(payload), name, run.site)
    except BadInput:
        return None
    return grid if grid.cells.size else None


def reported_maps(run: RecordedRun) -> list[ReportedMap]:
    """Each vehicle's own map, and those of teams."""
    found = [(name, own_map(run, name)) for name in run.vehicles]
    found += [(f"team of {name}", own_map(run, name, "map/team")) for name in run.vehicles]
    if run.site is None:
        return []
    x_min, y_min, x_max, y_max = run.site.world.floor
    fits = (x_max - x_min) * (y_max - y_min) / PLAN_CELL**2 <= LARGEST
    plan = floor_plan(run.site.world, PLAN_CELL) if fits and any(grid is not None for _, grid in found) else None
    here = Pose2(0.0, 0.0, 0.0)
    return [ReportedMap(name, grid, None if plan is None else score(grid, plan, here)) for name, grid in found if grid is not None]


def team_map(maps: list[ReportedMap]) -> GridMap | None:
    """The largest map of a team."""
    teams = [each.grid for each in maps if each.name.startswith("team of ")]
    return max(teams, key=lambda grid: int((grid.cells >= 0).sum()), default=None)
