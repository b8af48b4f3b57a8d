"""The other vehicles of the mission, as traffic that an ADS-B receiver would see."""

import hashlib
import math
import re

import numpy as np

from services.autopilot.mavlink.connection.facts import VehicleInfo, VehicleState
from uvf.mavlink import dialect as mav
from uvf.mavlink.scaling import I16, I32, U16, compass, heading_degrees, whole
from uvf.runtime.messages.convert import array, yaw_of

CALLSIGN = 8  # characters
STANDS = 0.2  # m/s, below which a vehicle goes where it looks
FLAGS = (
    mav.ADSB_FLAGS_VALID_COORDS
    | mav.ADSB_FLAGS_VALID_ALTITUDE
    | mav.ADSB_FLAGS_VALID_HEADING
    | mav.ADSB_FLAGS_VALID_VELOCITY
    | mav.ADSB_FLAGS_VERTICAL_VELOCITY_VALID
    | mav.ADSB_FLAGS_VALID_CALLSIGN
    | mav.ADSB_FLAGS_SIMULATED
)


def traffic(facts: VehicleInfo, latest: VehicleState, t: float) -> list[mav.MAVLink_message]:
    """ADSB_VEHICLE messages with the other vehicles' estimated positions; a silent one is left out; ``t`` [s] is not used."""
    return [one for other, known in latest.others if (one := seen(other, known)) is not None]


def seen(facts: VehicleInfo, latest: VehicleState) -> mav.MAVLink_adsb_vehicle_message | None:
    """ADSB_VEHICLE of one vehicle; None when it is silent or its position is not known."""
    nav = latest.nav
    if nav is None or latest.is_silent or not np.isfinite([*array(nav.position), *array(nav.velocity)]).all():
        return None
    latitude, longitude, amsl = facts.geodetic(array(nav.position))
    v = array(nav.velocity)
    speed = math.hypot(v[0], v[1])
    course = compass(v) if speed > STANDS else heading_degrees(yaw_of(nav.orientation))
    return mav.MAVLink_adsb_vehicle_message(
        address(facts),
        whole(latitude * 1e7, I32),
        whole(longitude * 1e7, I32),
        mav.ADSB_ALTITUDE_TYPE_GEOMETRIC,
        whole(amsl * 1e3, I32),
        whole(course * 100, U16) % 36000,
        whole(speed * 100, U16),
        whole(v[2] * 100, I16),
        callsign(facts).encode(),
        mav.ADSB_EMITTER_TYPE_SERVICE_SURFACE if facts.is_ground else mav.ADSB_EMITTER_TYPE_UAV,
        0,
        FLAGS,
        0,
    )


def address(facts: VehicleInfo) -> int:
    """ICAO address of 24 bits: the system id in the last byte keeps the vehicles of a mission apart."""
    return int.from_bytes(hashlib.sha256(facts.name.encode()).digest()[:2], "big") << 8 | facts.system_id


def callsign(facts: VehicleInfo) -> str:
    """Call sign: letters and digits of the name; a long name is cut, and the system id appended."""
    name = re.sub("[^A-Z0-9]", "", facts.name.upper())
    number = str(facts.system_id)
    return name if len(name) <= CALLSIGN else name[: CALLSIGN - len(number)] + number
