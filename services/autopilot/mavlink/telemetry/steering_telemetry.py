"""What is told of sticks and circles: RC_CHANNELS while channels are overridden, ORBIT_EXECUTION_STATUS while it orbits."""

from schemas.messages import Mode
from services.autopilot.mavlink.connection.facts import VehicleInfo, VehicleState
from services.autopilot.mavlink.telemetry.navigation import boot_ms
from uvf.mavlink import dialect as mav
from uvf.mavlink.scaling import I32, whole
from uvf.runtime.messages.convert import array

Message = mav.MAVLink_message | None
UNUSED, UNKNOWN_STRENGTH = 0xFFFF, 255


def rc_channels(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """RC_CHANNELS [us] at ``t`` [s]; released channels are marked unused. None while no channel is overridden."""
    if not latest.rc_channels:
        return None
    raw = [us or UNUSED for us in latest.rc_channels]
    count = max(i + 1 for i, us in enumerate(latest.rc_channels) if us) if any(latest.rc_channels) else 0
    fields = [boot_ms(t), count, *raw, UNKNOWN_STRENGTH]
    return mav.MAVLink_rc_channels_message(*fields)


def orbit_status(facts: VehicleInfo, latest: VehicleState, t: float) -> Message:
    """ORBIT_EXECUTION_STATUS at ``t`` [s]: radius [m] positive clockwise, centre [deg, m AMSL]; None in other modes than Orbit."""
    status = latest.status
    if status is None or status.mode != Mode.MODE_ORBIT or not status.HasField("circle"):
        return None
    latitude, longitude, altitude = facts.geodetic(array(status.circle.centre))
    place = whole(latitude * 1e7, I32), whole(longitude * 1e7, I32), altitude
    return mav.MAVLink_orbit_execution_status_message(whole(t * 1e6, (0, 2**63)), status.circle.radius, mav.MAV_FRAME_GLOBAL_INT, *place)
