"""Who a vehicle says it is: a PX4-compatible interface that says it is not PX4."""

import hashlib
import re
import tomllib
from importlib.metadata import version

from schemas.messages import Kind
from services.autopilot.mavlink.connection.facts import VehicleInfo, VehicleState
from uvf.mavlink import dialect as mav
from uvf.models.scenario import ROOT
from uvf.runtime.mavlink.modes import row_of

EMULATED_PX4 = (1, 16, 0)
"""Interface level whose behaviour is emulated; ground stations decide by it what a PX4 vehicle can do."""

CAPABILITIES = (
    mav.MAV_PROTOCOL_CAPABILITY_MISSION_INT
    | mav.MAV_PROTOCOL_CAPABILITY_COMMAND_INT
    | mav.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE
    | mav.MAV_PROTOCOL_CAPABILITY_FTP
    | mav.MAV_PROTOCOL_CAPABILITY_MISSION_FENCE
    | mav.MAV_PROTOCOL_CAPABILITY_MISSION_RALLY
    | mav.MAV_PROTOCOL_CAPABILITY_MAVLINK2
    | mav.MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_LOCAL_NED
    | mav.MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_GLOBAL_INT
)

TYPE = {Kind.KIND_GROUND: mav.MAV_TYPE_GROUND_ROVER, Kind.KIND_FIXED_WING: mav.MAV_TYPE_FIXED_WING}
XML_COMMIT = bytes.fromhex("de1e078a3a7c53c9")


def _own_version() -> tuple[int, int, int]:
    """Of the checkout that runs, or of the installed package."""
    project = ROOT / "pyproject.toml"
    text = tomllib.loads(project.read_text())["project"]["version"] if project.is_file() else version("uvf")
    major, minor, patch = (int(number) for number in re.findall(r"\d+", text)[:3])
    return major, minor, patch


VERSION = _own_version()
VENDOR = 0x5556
PRODUCT = {Kind.KIND_FIXED_WING: 1, Kind.KIND_GROUND: 2}


def greeting(facts: VehicleInfo) -> str:
    """The text that introduces the vehicle to a new ground station."""
    interface = "generic MAVLink" if facts.generic else "PX4-compatible MAVLink, not PX4"
    return f"UVF {'.'.join(map(str, VERSION))} simulated autopilot ({interface})"


def heartbeat(facts: VehicleInfo, latest: VehicleState) -> mav.MAVLink_heartbeat_message:
    """HEARTBEAT. The HIL flag is always set: it is true, and it keeps sensor calibration pages away."""
    flags = mav.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | mav.MAV_MODE_FLAG_HIL_ENABLED
    status = latest.status
    row = row_of(status.mode) if status is not None else None
    flags |= row.flags if row else 0
    if status is not None and status.armed:
        flags |= mav.MAV_MODE_FLAG_SAFETY_ARMED
    custom = row.custom if row else 0
    autopilot = mav.MAV_AUTOPILOT_GENERIC if facts.generic else mav.MAV_AUTOPILOT_PX4
    return mav.MAVLink_heartbeat_message(TYPE[facts.kind], autopilot, flags, custom, _system_status(latest), 3)


def _system_status(latest: VehicleState) -> int:
    if latest.status is None:
        return int(mav.MAV_STATE_BOOT)
    if latest.is_silent or latest.status.stopped or latest.is_gliding:
        return int(mav.MAV_STATE_CRITICAL)
    return int(mav.MAV_STATE_ACTIVE if latest.status.armed else mav.MAV_STATE_STANDBY)


def autopilot_version(facts: VehicleInfo) -> mav.MAVLink_autopilot_version_message:
    """AUTOPILOT_VERSION of type DEV (0): an official one is compared with the newest PX4. Own version in the custom bytes, reversed."""
    major, minor, patch = VERSION if facts.generic else EMULATED_PX4
    own = VERSION[0] << 24 | VERSION[1] << 16 | VERSION[2] << 8
    custom = (VERSION[2], VERSION[1], VERSION[0], 0, 0, 0, 0, 0)
    digest = hashlib.sha256(f"{facts.name}/{facts.system_id}".encode()).digest()
    uid = int.from_bytes(digest[:8], "little") or 1
    return mav.MAVLink_autopilot_version_message(
        CAPABILITIES | (0 if facts.is_ground else mav.MAV_PROTOCOL_CAPABILITY_SET_ATTITUDE_TARGET),
        major << 24 | minor << 16 | patch << 8,
        own,
        0,
        0,
        custom,
        custom,
        (0,) * 8,
        VENDOR,
        PRODUCT[facts.kind],
        uid,
        tuple(digest[:18]),
    )


def protocol_version() -> mav.MAVLink_protocol_version_message:
    """PROTOCOL_VERSION: if it were refused, an older QGroundControl would assume MAVLink 1 and skip parts of the connection."""
    return mav.MAVLink_protocol_version_message(200, 100, 200, tuple(XML_COMMIT), (0,) * 8)


def current_mode(latest: VehicleState) -> mav.MAVLink_current_mode_message | None:
    """CURRENT_MODE; None before the first status, and for an unknown mode."""
    row = row_of(latest.status.mode) if latest.status is not None else None
    return mav.MAVLink_current_mode_message(row.standard, row.custom, latest.intended_custom_mode) if row else None
