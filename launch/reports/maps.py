"""The maps of a run, as they lie in the world, and how well they fit it."""

from dataclasses import dataclass

from launch.reports.history import History
from launch.reports.recorded_run import RecordedRun
from launch.scoring.map_measures import true_plan
from schemas.messages import Grid
from services.slam.map_server import in_world
from uvf.maths.se2 import IDENTITY
from uvf.models.world.map_file import GridMap
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.maps.grids import as_map
from uvf.slam.maps.quality import MapScore, score


@dataclass(frozen=True)
class ReportedMap:
    """A map at the end of a run; score: None where the world is not known."""

    name: str
    grid: GridMap
    score: MapScore | None


def own_map(history: History, topic: str = "map/grid") -> GridMap | None:
    """The last map of a vehicle on a topic, in the world frame; None where it has none, or nobody knows where it lies."""
    payload = history.maps.get(topic)
    if payload is None or history.placing is None:
        return None
    try:
        return in_world(as_map(Grid.FromString(payload)), history.placing)
    except BadInput:
        return None


def reported_maps(run: RecordedRun) -> list[ReportedMap]:
    """Each vehicle's own map, and those of teams."""
    found = [(name, own_map(history)) for name, history in run.vehicles.items()]
    found += [(f"team of {name}", own_map(history, "map/team")) for name, history in run.vehicles.items()]
    drawn = [(name, grid) for name, grid in found if grid is not None]
    plan = true_plan(run.site.world) if drawn and run.site is not None else None
    return [ReportedMap(name, grid, None if plan is None else score(grid, plan, IDENTITY)) for name, grid in drawn]


def team_map(maps: list[ReportedMap]) -> GridMap | None:
    """The largest map of a team."""
    teams = [each.grid for each in maps if each.name.startswith("team of ")]
    return max(teams, key=lambda grid: int((grid.cells >= 0).sum()), default=None)
