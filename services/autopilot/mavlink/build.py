"""The MAVLink process: one instance for all vehicles of the mission, its addresses from the environment."""

import logging
import os
import socket
import time
from collections.abc import Mapping

from services.autopilot.ground.params import GroundAutopilotParams
from services.autopilot.mavlink.connection.facts import VehicleInfo
from services.autopilot.mavlink.connection.key_store import KeyStore
from services.autopilot.mavlink.connection.signing import Signing
from services.autopilot.mavlink.connection.targets import DEFAULT_LISTEN, DEFAULT_TARGETS, LISTEN, TARGETS, reserved, targets_from
from services.autopilot.mavlink.parameters.parameter_store import FileStore
from services.autopilot.mavlink.service import MavlinkService
from uvf.maths.geodesy import LocalTangent
from uvf.mavlink.endpoint import Peer, UdpLink
from uvf.models.params import Params
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.vehicle.flight_params import FIXED, AirParams
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.bus.address import peer
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.state.state_folder import state_folder

IDENTITY = "UVF_MAVLINK_IDENTITY"
REQUIRE_SIGNING = "UVF_MAVLINK_REQUIRE_SIGNING"
IDENTITIES = {"px4": False, "generic": True}
SWITCH = {"0": False, "1": True}
KEYS = "mavlink-keys.json"
AIR, GROUND = "autopilot_air", "autopilot_ground"
EXAMPLE = "127.0.0.1:14550"

log = logging.getLogger(__name__)


def build(site: Scenario) -> list[ServiceInstance]:
    """The MAVLink service of a mission. Raises BadInput for an address, a vehicle name or a choice in the environment that is wrong."""
    targets = targets_from(os.environ.get(TARGETS, DEFAULT_TARGETS), TARGETS, [m.entry.system_id for m in site.members.values()])
    where = os.environ.get(LISTEN, DEFAULT_LISTEN)
    listen = peer(where, LISTEN, EXAMPLE) if where.strip() else None
    generic = chosen(IDENTITY, IDENTITIES, "px4", os.environ)
    required = chosen(REQUIRE_SIGNING, SWITCH, "0", os.environ)

    stores = {name: store_of(site, name) for name in site.members}

    def make() -> MavlinkService:
        started = time.time()
        link = open_link([target.peer for target in targets], listen)
        return MavlinkService(facts_of(site, generic, started), link, stores, open_keys(started, required), reserved(targets))

    return [ServiceInstance(MavlinkService, make, writes_for=tuple(site.members))]


def chosen(name: str, choices: Mapping[str, bool], default: str, environment: Mapping[str, str]) -> bool:
    """The value of an environment variable that offers a choice. Raises BadInput for another word."""
    text = environment.get(name, default)
    if text not in choices:
        raise BadInput(f"{name}={text}: {nearest(text, choices)}")
    return choices[text]


def facts_of(site: Scenario, generic: bool = False, started: float = 0.0) -> list[VehicleInfo]:
    """The static facts of every vehicle of a mission; started: Unix time [s] of the link's start, 0 = unknown."""
    origin = site.world.origin
    tangent = LocalTangent.from_degrees(origin.latitude, origin.longitude, origin.altitude)
    own = {m.name: own_of(m) for m in site.members.values()}
    return [VehicleInfo(m.name, m.entry.system_id, m.file, tangent, *own[m.name], generic, started) for m in site.members.values()]


def open_keys(started: float, required: bool) -> Signing:
    """Message signing with the stored keys; started: Unix time [s] at t = 0.

    A broken key file is put aside: without its keys every peer is unknown, and ``required`` refuses it.
    """
    path = state_folder() / KEYS
    try:
        return Signing(KeyStore(path), started, required)
    except ValueError as error:
        path.replace(path.with_suffix(".broken"))
        log.warning("mavlink: %s (it is put aside)", error)
        return Signing(KeyStore(path), started, required)


def own_of(member: MissionVehicle) -> tuple[Params, frozenset[str]]:
    """The autopilot's parameters as the vehicle's file sets them, and those that it reads only when it starts."""
    if member.file.kind == "ground":
        return member.params(GROUND, GroundAutopilotParams), frozenset()
    return member.params(AIR, AirParams), FIXED


def store_of(site: Scenario, vehicle: str) -> FileStore:
    """The parameter file of one vehicle of one mission; each mission has its own."""
    return FileStore(state_folder() / "parameters" / site.mission_path.stem / f"{vehicle}.json")


def open_link(targets: list[Peer], listen: Peer | None) -> UdpLink:
    """Opens the UDP link, host names resolved; without the listening port when it is taken, and without unresolvable targets."""
    numeric = [peer for peer in map(_looked_up, targets) if peer is not None]
    try:
        return UdpLink(numeric, listen)
    except OSError as error:
        log.warning("mavlink: cannot listen on %s (%s); going on without it, set %s to another port", listen, error, LISTEN)
        return UdpLink(numeric)


def _looked_up(peer: Peer) -> Peer | None:
    try:
        return socket.gethostbyname(peer[0]), peer[1]
    except OSError as error:
        log.warning("mavlink: no ground station at %s:%d: %s", *peer, error)
        return None
