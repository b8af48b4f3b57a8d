"""Which mission a running system has: the conductor announces it, and tools that are given none ask for it."""

from urllib.parse import quote, unquote

from launch import settings
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.address import router_from
from uvf.runtime.bus.zenoh_bus import ZenohBus

TOKEN = "@mission"
TIMEOUT = 3.0  # s


def announce(bus: ZenohBus, mission: str) -> None:
    """Announces a mission, by its name in ``missions/`` or its path, until the session ends. Raises BadInput for one that is not there."""
    path = settings.mission_path(mission).resolve()
    name = path.stem if path.parent == settings.ROOT / "missions" else str(path)
    bus.token(f"{TOKEN}/{quote(name, safe='')}")


def wanted_mission(given: str | None) -> str:
    """The mission that was given, else that of the running system. Raises BadInput where neither is known."""
    if given is not None:
        return given
    with ZenohBus(router_from(), timeout=TIMEOUT) as bus:
        running = [unquote(token.partition("/")[2]) for token in bus.tokens(f"{TOKEN}/*")]
    if len(running) != 1:
        raise BadInput(f"{len(running) or 'no'} missions are announced at {router_from()}: give -m MISSION")
    return running[0]
