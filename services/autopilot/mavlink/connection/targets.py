"""Where the vehicles send to: ports that hear all of them, and ports of one vehicle alone.

Programs that take the first vehicle they hear for the only one, as MAVSDK 3 does, need a port of one vehicle.
"""

import socket
from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple

from uvf.mavlink.endpoint import Peer
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.address import peer

GCS = "127.0.0.1:14550"  # where a ground station of this machine listens
TARGETS, DEFAULT_TARGETS = "UVF_MAVLINK_TARGETS", f"{GCS},127.0.0.1:14540"
LISTEN, DEFAULT_LISTEN = "UVF_MAVLINK_LISTEN", "127.0.0.1:14580"
Reserved = Mapping[Peer, int]
"""Ports that hear one vehicle, and are heard by it: numeric address -> system_id."""


def where_mavlink_goes(environment: Mapping[str, str]) -> str:
    """``MAVLink: to UDP 127.0.0.1:14550, listens on UDP 127.0.0.1:14580``, or ``MAVLink: off``, in words for whoever starts a mission."""
    to = ", ".join(part.strip() for part in environment.get(TARGETS, DEFAULT_TARGETS).split(",") if part.strip())
    listen = environment.get(LISTEN, DEFAULT_LISTEN).strip()
    hint = " (QGroundControl: just start it)" if GCS in to.split(", ") else ""
    parts = [f"to UDP {to}{hint}"] * bool(to) + [f"listens on UDP {listen}"] * bool(listen)
    return f"MAVLink: {', '.join(parts) or 'off'}"


class MavlinkTarget(NamedTuple):
    """An address to send to. system_id: of the only vehicle on this port, or None for all."""

    peer: Peer
    system_id: int | None = None


def targets_from(text: str, name: str, system_ids: Collection[int]) -> list[MavlinkTarget]:
    """Parses ``host:port`` or ``host:port/system_id``, separated by commas. name: of the variable. Raises BadInput."""
    return [_target(part.strip(), name, system_ids) for part in text.split(",") if part.strip()]


def _target(text: str, name: str, system_ids: Collection[int]) -> MavlinkTarget:
    place, slash, number = text.partition("/")
    where = peer(place, name, "127.0.0.1:14550")
    if not slash:
        return MavlinkTarget(where)
    if not number.isdecimal() or int(number) not in system_ids:
        there = ", ".join(map(str, sorted(system_ids)))
        raise BadInput(f"{name}: '{text}': no vehicle has system_id '{number}'; the mission has {there}")
    return MavlinkTarget(where, int(number))


def reserved(targets: Sequence[MavlinkTarget]) -> Reserved:
    """The addresses reserved for one vehicle; unresolvable names are left out."""
    found = {}
    for (host, port), system_id in targets:
        if system_id is not None:
            try:
                found[socket.gethostbyname(host), port] = system_id
            except OSError:
                continue  # ``open_link`` tells of it
    return found
