"""An outside program drives a rover through waypoints over MAVLink alone, as it would a PX4 rover. Start ``./uvf up`` first.

    ./uvf mode burger hold
    .venv/bin/python examples/09_waypoints_mavlink.py 2.6,1.5 2.2,1.2

It drives straight, around nothing: the first line keeps the rover, which explores the house, in the room where it starts.
"""

import os
import sys
from math import atan2, cos, hypot, remainder, tau

from pymavlink import mavutil
from pymavlink.dialects.v20 import common as mav

ROVER = 2  # its system id
VELOCITY_AND_RATE = 0b0101_1100_0111  # the type mask: all but vx, vy, vz and the yaw rate are left out
link = mavutil.mavlink_connection("udpout:" + os.environ.get("UVF_MAVLINK_LISTEN", "127.0.0.1:14580"), source_system=250, dialect="common")


def read(kind: str):
    """The rover's next message of a kind; says at the same time that this program is alive."""
    link.mav.heartbeat_send(mav.MAV_TYPE_ONBOARD_CONTROLLER, mav.MAV_AUTOPILOT_INVALID, 0, 0, 0)
    message = link.recv_match(type=kind, condition=f"{kind}.get_srcSystem() == {ROVER}", blocking=True, timeout=5.0)
    return message or sys.exit(f"no {kind} from system {ROVER}: does ./uvf up run?")


def drive(speed: float, turn: float) -> None:
    """Velocity ahead [m/s] and turn rate to the left [rad/s]."""
    link.mav.set_position_target_local_ned_send(
        0, ROVER, 1, mav.MAV_FRAME_BODY_FRD, VELOCITY_AND_RATE, 0, 0, 0, speed, 0, 0, 0, 0, 0, 0, -turn
    )


read("HEARTBEAT")
drive(0.0, 0.0)
link.mav.command_long_send(ROVER, 1, mav.MAV_CMD_DO_SET_MODE, 0, mav.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, 6, 0, 0, 0, 0, 0)  # PX4's Offboard
for text in sys.argv[1:]:
    x, y = map(float, text.split(","))
    left = 1.0
    while left > 0.1:
        here, attitude = read("LOCAL_POSITION_NED"), read("ATTITUDE")
        east, north, yaw = here.y, here.x, tau / 4 - attitude.yaw
        left, off = hypot(x - east, y - north), remainder(atan2(y - north, x - east) - yaw, tau)
        drive(min(0.6 * left, 0.2) * max(cos(off), 0.0) ** 3, max(min(1.5 * off, 1.0), -1.0))
    print(f"at ({x:g}, {y:g})")
link.mav.command_long_send(ROVER, 1, mav.MAV_CMD_DO_SET_MODE, 0, mav.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, 4, 4, 0, 0, 0, 0)  # its Mission
