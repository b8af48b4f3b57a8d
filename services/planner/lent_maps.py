"""What a vehicle plans on where its own map shows nothing: a map that was handed over to it, or the merged map of its team."""

from collections.abc import Mapping
from math import isfinite

from schemas.messages import FrameTransform, Grid
from uvf.maths.se2 import Pose2, compose, inverse
from uvf.models.yaml_data import BadInput
from uvf.planning.costmap.shared_map import SharedMap
from uvf.planning.costmap.terrain import TerrainLimits, terrain_obstacles
from uvf.runtime.messages.convert import pose2_of, pose2_of_frame
from uvf.runtime.messages.maps.grids import as_map
from uvf.runtime.messages.maps.height_grids import has_heights, heights_of


class LentMaps:
    """Of one vehicle. What was handed over, that is by order of a mission or of a person, comes first."""

    def __init__(self, map_from_world: Pose2) -> None:
        self.lent: SharedMap | None = None
        """What is to be laid below its own map now."""
        self._map_from_world = map_from_world
        self._handed: Grid | None = None
        self._limits: TerrainLimits | None = None
        self._is_handed = False
        self._team: tuple[Grid, Pose2] | None = None

    def take(self, handed: Grid | None, limits: TerrainLimits, team: tuple[Grid, Pose2] | None) -> str:
        """The newest of both; what is wrong with one that has come just now, "" if nothing.

        team: the merged map, in the frame of the team, and where the vehicle's own map lies in that.
        """
        if handed is not None and (limits != self._limits or (handed is not self._handed and handed != self._handed)):
            self._handed, self._limits = handed, limits
            try:
                cells = terrain_obstacles(heights_of(handed), handed.cell_size.x, limits) if has_heights(handed) else as_map(handed).cells
            except BadInput as error:
                return str(error)
            self.lent = SharedMap(
                cells, handed.cell_size.x, compose(self._map_from_world, pose2_of(handed.pose)), outranks=has_heights(handed)
            )
            self._is_handed = True
        return "" if self._is_handed else self._take_of_team(team)

    def _take_of_team(self, team: tuple[Grid, Pose2] | None) -> str:
        before, self._team = self._team, team
        if team is None:
            self.lent = None
        elif before is None or team[0] is not before[0] or team[1] != before[1]:
            grid, team_from_map = team
            try:
                drawn = as_map(grid)
            except BadInput as error:
                self.lent = None
                return str(error)
            map_from_cells = compose(inverse(team_from_map), drawn.origin)
            self.lent = SharedMap(drawn.cells, drawn.resolution, map_from_cells, outranks=False)
        return ""


def team_map(vehicle: str, place: FrameTransform | None, maps: Mapping[str, Grid]) -> tuple[Grid, Pose2] | None:
    """The merged map of the team that a vehicle has come to, and where its own map lies in that; None while it is alone.

    place: of the vehicle's map in that of the first of its team; maps: by the first of each team.
    """
    if place is None or place.child_frame_id != f"{vehicle}/map":
        return None
    grid, team_from_map = maps.get(place.parent_frame_id.partition("/")[0]), pose2_of_frame(place)
    return None if grid is None or not all(isfinite(v) for v in team_from_map) else (grid, team_from_map)
