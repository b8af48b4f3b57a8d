"""Maps from and for a running system."""

from collections.abc import Callable

import uvf.client
from launch.launcher import stop_flag
from schemas import topics
from services.slam.map_server import in_world
from uvf.models.world.map_file import GridMap, undecided_share
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.bus.address import router_from
from uvf.runtime.bus.zenoh_bus import ZenohBus
from uvf.runtime.messages.maps.grids import as_map, as_message
from uvf.slam.maps.session import MappingSession

PATIENCE = 5.0  # s
MOSTLY = 0.5


def drawn_map(vehicle: str | None, own_frame: bool) -> tuple[str, GridMap]:
    """The map that a vehicle publishes: (vehicle, map in the world frame or in its own). Raises BadInput."""
    owner = _chosen(vehicle, _writers())
    with uvf.client.connect() as run:
        try:
            grid = as_map(run.read(owner, topics.MAP, PATIENCE))
            return owner, grid if own_frame else in_world(grid, run.read(owner, topics.TF_WORLD, PATIENCE))
        except TimeoutError as error:
            raise BadInput(f"{error}: {owner} has not drawn a map yet") from error


def doubt(grid: GridMap, mode: str) -> str:
    """What to say of a map most of whose seen cells are written as unknown, else nothing."""
    share = undecided_share(grid)
    if mode != "trinary" or share <= MOSTLY:
        return ""
    return (
        f"{share:.0%} of the cells that were seen are written as unknown, for they were seen too seldom to be free or occupied: "
        "drive on and save again, or use --mode scale, which keeps each cell's value"
    )


def running_session(vehicle: str | None) -> MappingSession:
    """The mapping session that the vehicle published last. Raises BadInput."""
    owner = _chosen(vehicle, _writers())
    with uvf.client.connect() as run:
        try:
            return MappingSession.decoded(run.read(owner, topics.MAP_SESSION, PATIENCE).data, f"of {owner}")
        except TimeoutError as error:
            raise BadInput(f"{error}: {owner} has no session yet, or maps by a method that has none") from error


def serve(grid: GridMap, vehicle: str, ready: Callable[[], None]) -> None:
    """Publishes a map (world frame) as a latched message until Ctrl-C or SIGTERM. Raises BadInput."""
    stop = stop_flag()
    with uvf.client.connect() as run:
        run.send(vehicle, topics.KNOWN_MAP, as_message(grid, "world", run.time))
        ready()
        stop.wait()


def _writers() -> list[str]:
    """The vehicles whose map somebody draws."""
    with ZenohBus(router_from(), timeout=3.0) as bus:
        ends = [token.split("/") for token in bus.tokens("@ep/**")]
    return sorted({owner for _, owner, _, way, where, _ in ends if way == "pub" and where.replace("%", "/") == topics.MAP.at(owner)})


def _chosen(vehicle: str | None, owners: list[str]) -> str:
    if not owners:
        raise BadInput("no vehicle in the running system draws a map; a mission with a ground vehicle does")
    if vehicle is None and len(owners) > 1:
        raise BadInput(f"{len(owners)} vehicles draw maps; choose one by --vehicle: {', '.join(owners)}")
    if vehicle is not None and vehicle not in owners:
        raise BadInput(f"no map of '{vehicle}'; {nearest(vehicle, owners)}")
    return vehicle or owners[0]
