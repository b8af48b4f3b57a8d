"""``uvf mavlink-bridge``: autopilots at a MAVLink address as vehicles on the bus, until Ctrl-C."""

import socket
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass

from launch import settings
from launch.processes import open_bus
from launch.worker import worker
from schemas.messages import ExternalVehicle
from services.mavlink_bridge.discovery import Discovery, Names, names_from
from services.mavlink_bridge.frame import BridgeOrigin
from services.mavlink_bridge.service import BridgedVehicle
from services.mavlink_bridge.station import Station
from services.mavlink_bridge.status import KIND
from uvf.maths.geodesy import LocalTangent
from uvf.mavlink import dialect as mav
from uvf.mavlink.endpoint import UdpLink
from uvf.models.scenario import ROOT, Scenario, load_scenario
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.bus.address import peer
from uvf.runtime.bus.zenoh_bus import ZenohBus
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.time.live import Live

EXAMPLE = "udpin:127.0.0.1:14550"
LISTENING = ("udp", "udpin")
CALLING = ("udpout",)
VEHICLES = ROOT / "vehicles"


@dataclass(frozen=True)
class BridgeOptions:
    """Options of ``uvf mavlink-bridge``. names: ``NAME`` or ``NAME=SYSTEM``; mission: the one whose world is used, if any."""

    address: str
    names: tuple[str, ...] = ()
    model: str = ""
    mission: str = ""


def open_address(text: str) -> UdpLink:
    """Opens ``udp:``, ``udpin:`` (listen) or ``udpout:`` (call) followed by host:port, perhaps with MAVSDK's ``//``. Raises BadInput."""
    way, _, place = text.partition(":")
    if way not in (*LISTENING, *CALLING):
        raise BadInput(f"'{text}': no such kind of address; {nearest(way, [*LISTENING, *CALLING])}, as in {EXAMPLE}")
    host, port = peer(place.removeprefix("//"), f"'{text}'", "127.0.0.1:14550")
    try:
        numeric = socket.gethostbyname(host), port
        return UdpLink([numeric]) if way in CALLING else UdpLink([], numeric)
    except OSError as error:
        mend = (
            "is a ground station running there? have the autopilot send to another port too" if way in LISTENING else "is the name right?"
        )
        raise BadInput(f"'{text}': {error.strerror or error}: {mend}") from error


def bridge(wanted: BridgeOptions) -> None:
    """Runs the bridge until told to stop. Raises BadInput before anything is opened."""
    names = names_from(wanted.names)
    if wanted.model:
        load_vehicle(VEHICLES, wanted.model)
    site = load_scenario(settings.mission_path(wanted.mission)) if wanted.mission else None
    for name in names.asked_for:
        if site is not None and name in site.members:
            raise BadInput(f"--name {name}: {site.mission_path} has a vehicle of this name; choose another")
    link = open_address(wanted.address)
    with closing(link), worker("mavlink-bridge") as life, open_bus(life) as bus:
        _check_free(bus, names)
        Bridge(wanted, names, bus, Station(link), _origin(site), life.warn).live.run(life.stop, lambda: not life.goes_on())


def _check_free(bus: ZenohBus, names: Names) -> None:
    for name in names.asked_for:
        if is_taken(bus, name):
            raise BadInput(f"--name {name}: a vehicle of this name is on the bus; choose another")


def is_taken(bus: ZenohBus, name: str) -> bool:
    """Whether services of a vehicle of this name are running."""
    return bool(bus.tokens(f"@node/{name}/**"))


def _origin(site: Scenario | None) -> BridgeOrigin:
    if site is None:
        return BridgeOrigin()
    origin = site.world.origin
    return BridgeOrigin(LocalTangent.from_degrees(origin.latitude, origin.longitude, origin.altitude))


class Bridge:
    """The bridge's process: one reader of the address, one service for each autopilot there."""

    def __init__(
        self, wanted: BridgeOptions, names: Names, bus: ZenohBus, station: Station, origin: BridgeOrigin, warn: Callable[[str], None]
    ) -> None:
        self._wanted, self._bus, self._station, self._origin, self._warn = wanted, bus, station, origin, warn
        host = ServiceInstance(Discovery, lambda: Discovery(station, names, self._found, self._say))
        self.live = Live(f"mavlink_bridge_{names.free}", [host], bus, warn)
        self._say(f"listening for autopilots as {names.free}")

    def _say(self, line: str) -> None:
        self._warn(f"{self._wanted.address}: {line}")

    def _found(self, name: str, system: int) -> None:
        heartbeat = self._station.autopilots[system].heartbeat
        what = f"system {system}, {_enum('MAV_AUTOPILOT', heartbeat.autopilot)} {_enum('MAV_TYPE', heartbeat.type)}"
        if is_taken(self._bus, name):
            self._say(f"{what} is left alone: {name} is on the bus already; choose another --name")
            return
        external = ExternalVehicle(
            model=self._wanted.model or default_model(heartbeat.type), about=f"MAVLink {what} at {self._wanted.address}"
        )

        def make() -> Service:
            return BridgedVehicle(name, system, self._station, self._origin, external)

        self.live.join(ServiceInstance(BridgedVehicle, make, name))
        self._say(f"{what} is {name}")


def default_model(type_: int) -> str:
    """The display model of a MAV_TYPE: the first in vehicles/ of the same kind, or the first of all."""
    kinds = {1: "ground", 2: "fixed_wing"}
    names = sorted(folder.name for folder in VEHICLES.iterdir() if (folder / "vehicle.yaml").is_file())
    kind = kinds.get(KIND.get(type_, 0), "fixed_wing")
    return next((name for name in names if load_vehicle(VEHICLES, name).kind == kind), names[0])


def _enum(enum: str, number: int) -> str:
    """As the dialect calls it, in small letters."""
    entry = mav.enums[enum].get(number)
    return entry.name.removeprefix(f"{enum}_").lower().replace("_", " ") if entry is not None else f"{enum} {number}"
