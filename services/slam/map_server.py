"""Saved maps and masks for those who drive by them, and the map that is being drawn for those who ask."""

import re
from collections.abc import Callable, Mapping
from pathlib import Path

from schemas import topics
from schemas.messages import FrameTransform, Grid, MapReply, MapRequest, Reply, SaveMapRequest
from uvf.maths.se2 import compose
from uvf.models.names import MAP
from uvf.models.world.map_file import GridMap
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.contract.declaration import Reads, Writes, optional, replies, request, topic
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import pose2_of_frame
from uvf.runtime.messages.maps.grids import as_map, as_message

Save = Callable[[GridMap, str, str], Path]
"""Writes a map under a name, in a mode of map_server. Raises BadInput."""
DRAWN = "grid"


class MapServer(Service):
    """Publishes the map layers of the mission once, latched, and answers requests for them and for the vehicle's own map."""

    name = "map_server"
    hz = 2.0

    class Inputs(Reads):
        """The vehicle's own map, that of its team, and requests."""

        map: Grid | None = optional(topics.MAP)
        team: Grid | None = optional(topics.TEAM_MAP)
        placing: FrameTransform | None = optional(topics.TF_WORLD)
        save: list[SaveMapRequest] = request(topics.SAVE_MAP)
        get: list[MapRequest] = request(topics.GET_MAP)

    class Outputs(Writes):
        """Map layers and replies."""

        known: Grid | None = topic(topics.KNOWN_MAP)
        keepout: Grid | None = topic(topics.KEEP_OUT)
        speed: Grid | None = topic(topics.SPEED_MAP)
        save: list[Reply] = replies(topics.SAVE_MAP)
        get: list[MapReply] = replies(topics.GET_MAP)

    def __init__(self, layers: Mapping[str, GridMap], save: Save) -> None:
        """layers: by the names of the outputs, world frame."""
        self._layers = layers
        self._save = save
        self._served: dict[str, Grid] = {}

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s, simulation]: publishes the layers at the first one, and answers requests."""
        fresh = not self._served
        self._served = self._served or {name: as_message(layer, "world", t) for name, layer in self._layers.items()}
        layers = self._served if fresh else {}
        return self.Outputs(
            **layers,
            save=[self._saved(request, now) for request in now.save],
            get=[self._found(request, now.map) for request in now.get],
        )

    def _saved(self, request: SaveMapRequest, now: Inputs) -> Reply:
        layers, layer = {DRAWN: now.map, "team": now.team}, request.layer or DRAWN
        if layer not in layers:
            return Reply(reason=f"no layer '{layer}' is saved; {nearest(layer, layers)}")
        map, placing = layers[layer], now.placing
        if not re.fullmatch(MAP, request.name):
            return Reply(reason=f"a map cannot be called '{request.name}'; use letters, digits, - and _")
        if map is None or placing is None:
            wait = "wait for the first scan" if layer == DRAWN else "the first vehicle of a team has it, once two maps fit together"
            return Reply(reason=f"there is no map yet; {wait}")
        try:
            self._save(in_world(as_map(map), placing), request.name, request.mode or "trinary")
        except BadInput as error:
            return Reply(reason=str(error))
        return Reply(accepted=True)

    def _found(self, request: MapRequest, map: Grid | None) -> MapReply:
        layer = request.layer or DRAWN
        known = (DRAWN, *self.outputs)
        if layer not in known:
            return MapReply(reason=f"no layer '{layer}'; {nearest(layer, known)}")
        grid = map if layer == DRAWN else self._served.get(layer)
        if grid is None:
            return MapReply(reason="there is no map yet" if layer == DRAWN else f"the mission gives no {layer} under 'maps:'")
        return MapReply(accepted=True, grid=grid)


def in_world(grid: GridMap, world_from_map: FrameTransform) -> GridMap:
    """A vehicle's map placed in the world frame."""
    return GridMap(grid.cells, grid.resolution, compose(pose2_of_frame(world_from_map), grid.origin))
