"""REQUEST_DATA_STREAM of older ground stations (MAVProxy, Mission Planner): rates for groups of messages."""

from services.autopilot.mavlink.telemetry.streams import Schedule
from uvf.mavlink import dialect as mav
from uvf.mavlink.endpoint import Peer

GROUPS: dict[int, tuple[int, ...]] = {
    mav.MAV_DATA_STREAM_RAW_SENSORS: (mav.MAVLINK_MSG_ID_HIGHRES_IMU, mav.MAVLINK_MSG_ID_SCALED_PRESSURE),
    mav.MAV_DATA_STREAM_EXTENDED_STATUS: (
        mav.MAVLINK_MSG_ID_SYS_STATUS,
        mav.MAVLINK_MSG_ID_GPS_RAW_INT,
        mav.MAVLINK_MSG_ID_MISSION_CURRENT,
        mav.MAVLINK_MSG_ID_NAV_CONTROLLER_OUTPUT,
    ),
    mav.MAV_DATA_STREAM_RC_CHANNELS: (mav.MAVLINK_MSG_ID_SERVO_OUTPUT_RAW, mav.MAVLINK_MSG_ID_RC_CHANNELS),
    mav.MAV_DATA_STREAM_RAW_CONTROLLER: (mav.MAVLINK_MSG_ID_ATTITUDE_TARGET,),
    mav.MAV_DATA_STREAM_POSITION: (mav.MAVLINK_MSG_ID_GLOBAL_POSITION_INT, mav.MAVLINK_MSG_ID_LOCAL_POSITION_NED),
    mav.MAV_DATA_STREAM_EXTRA1: (mav.MAVLINK_MSG_ID_ATTITUDE, mav.MAVLINK_MSG_ID_ATTITUDE_QUATERNION),
    mav.MAV_DATA_STREAM_EXTRA2: (mav.MAVLINK_MSG_ID_VFR_HUD, mav.MAVLINK_MSG_ID_ALTITUDE),
    mav.MAV_DATA_STREAM_EXTRA3: (
        mav.MAVLINK_MSG_ID_BATTERY_STATUS,
        mav.MAVLINK_MSG_ID_WIND_COV,
        mav.MAVLINK_MSG_ID_VIBRATION,
        mav.MAVLINK_MSG_ID_ESTIMATOR_STATUS,
    ),
}
"""As ArduPilot shares them out (GCS_Mavlink.cpp), where we have the message. What is in none keeps its own rate."""


def set_rates(schedule: Schedule, message: mav.MAVLink_request_data_stream_message, peer: Peer) -> None:
    """Sets the rates of REQUEST_DATA_STREAM: a stopped group is not sent; 0 [1/s] = default rates; group 0 = all. Others are ignored."""
    group = message.req_stream_id
    wanted = {n for numbers in GROUPS.values() for n in numbers} if group == mav.MAV_DATA_STREAM_ALL else GROUPS.get(group, ())
    started = 1e6 / message.req_message_rate if message.req_message_rate else 0.0
    for number in wanted:
        schedule.set_interval(number, peer, started if message.start_stop else -1.0)
