"""Maps out of the logs of past runs."""

from pathlib import Path

from schemas import topics
from schemas.messages import FrameTransform, Grid
from services.slam.map_server import in_world
from uvf.models.world.map_file import GridMap
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.bus.interface import Sample
from uvf.runtime.bus.wire import Malformed, decode_sample
from uvf.runtime.log.run_samples import run_samples
from uvf.runtime.messages.maps.grids import as_map

LAYERS = {"grid": topics.MAP, "team": topics.TEAM_MAP}


def recorded_map(run: Path, vehicle: str | None, layer: str, own_frame: bool) -> tuple[str, GridMap]:
    """The last map of a vehicle in a run's logs: (vehicle, map in the world frame or in its own). Raises BadInput."""
    if layer not in LAYERS:
        raise BadInput(f"no layer '{layer}'; {nearest(layer, LAYERS)}")
    last: dict[str, Sample] = {}
    for sample in run_samples(run, (LAYERS[layer].at("*"), topics.TF_WORLD.at("*"))):
        last[sample.key] = sample
    owners = sorted(key.split("/")[1] for key in last if key.endswith(f"/map/{layer}"))
    if not owners:
        raise BadInput(f"{run}: there is no map in this log" + (" of a team" if layer == "team" else ""))
    if vehicle is None and len(owners) > 1:
        raise BadInput(f"{run}: {len(owners)} vehicles have drawn maps; choose one by --vehicle: {', '.join(owners)}")
    owner = vehicle or owners[0]
    if owner not in owners:
        raise BadInput(f"{run}: no map of '{owner}'; {nearest(owner, owners)}")
    try:
        grid = as_map(decode_sample(last[LAYERS[layer].at(owner)], Grid))
        place = last.get(topics.TF_WORLD.at(owner))
        if own_frame:
            return owner, grid
        if place is None:
            raise BadInput(f"{run}: the log does not say where the map of {owner} lies in the world; save it with --own-frame")
        return owner, in_world(grid, decode_sample(place, FrameTransform))
    except Malformed as error:
        raise BadInput(f"{run}: {error}") from error
