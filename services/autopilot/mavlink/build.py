"""The MAVLink process: one instance for all vehicles of the mission, its addresses from the environment."""

import logging
import os
import socket

from services.autopilot.air.params import AirParams
from services.autopilot.mavlink.endpoint import Peer, UdpLink
from services.autopilot.mavlink.facts import Facts
from services.autopilot.mavlink.service import MavlinkService
from uvf.maths.geodesy import LocalTangent
from uvf.runtime.address import peer
from uvf.runtime.site import Host, Member, Site

TARGETS = "UVF_MAVLINK_TARGETS"
LISTEN = "UVF_MAVLINK_LISTEN"
DEFAULT_TARGETS = "127.0.0.1:14550,127.0.0.1:14540"
AIR = "autopilot_air"
DEFAULT_LISTEN = "127.0.0.1:14580"
LINK_ACTIONS = {"warn": 0, "hold": 1, "return": 2, "land": 3}  # of NAV_DLL_ACT
EXAMPLE = "127.0.0.1:14550"

log = logging.getLogger(__name__)


def build(site: Site) -> list[Host]:
    """Raises BadInput when an address in the environment is not ``host:port``."""
    targets = [peer(text, TARGETS, EXAMPLE) for text in os.environ.get(TARGETS, DEFAULT_TARGETS).split(",") if text.strip()]
    where = os.environ.get(LISTEN, DEFAULT_LISTEN)
    listen = peer(where, LISTEN, EXAMPLE) if where.strip() else None
    facts = facts_of(site)
    return [Host(MavlinkService, lambda: MavlinkService(facts, open_link(targets, listen)), writes_for=tuple(site.members))]


def facts_of(site: Site) -> list[Facts]:
    origin = site.world.origin
    tangent = LocalTangent.from_degrees(origin.latitude, origin.longitude, origin.altitude)
    return [Facts(m.name, m.entry.system_id, m.file, tangent, numbers_of(m)) for m in site.members.values()]


def numbers_of(member: Member) -> dict[str, float]:
    """What the parameter table may name: m, m/s; return_height above home."""
    numbers = {"system_id": float(member.entry.system_id)}
    if member.file.kind == "fixed_wing":
        air = member.params(AIR, AirParams)
        numbers["trim_airspeed"] = air.trim_airspeed
        numbers["hold_radius"] = air.hold_radius
        numbers["return_height"] = air.return_altitude
        numbers["link_timeout"] = air.link_timeout
        numbers["link_action"] = float(LINK_ACTIONS[air.link_action])
        numbers["battery_low"] = air.battery_low
        numbers["battery_critical"] = air.battery_critical
    return numbers


def open_link(targets: list[Peer], listen: Peer | None) -> UdpLink:
    """Names looked up; without the listening port when it is taken, and without targets that nobody knows."""
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
