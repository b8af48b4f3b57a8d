"""MISSION_ITEM, whose places are floats, as older partners send it."""

import math

from uvf.mavlink import dialect as mav

SCALE = 1e7  # units per deg
OUT_OF_RANGE = 2**31 - 1
"""Of a latitude or longitude that is none: it is refused as such."""


def as_int(item: mav.MAVLink_mission_item_message) -> mav.MAVLink_mission_item_int_message:
    """The MISSION_ITEM as a MISSION_ITEM_INT, with integer coordinates."""
    scale = 1.0 if item.frame == mav.MAV_FRAME_MISSION else SCALE
    place = (_whole(item.x * scale), _whole(item.y * scale), item.z)
    params = (item.param1, item.param2, item.param3, item.param4)
    head = (item.target_system, item.target_component, item.seq, item.frame, item.command, item.current, item.autocontinue)
    return mav.MAVLink_mission_item_int_message(*head, *params, *place, item.mission_type)


def _whole(value: float) -> int:
    return round(value) if math.isfinite(value) and abs(value) < OUT_OF_RANGE else OUT_OF_RANGE
