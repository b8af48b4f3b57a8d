"""QGroundControl's plan files, and the mission items that it makes of them.

After the file format in QGroundControl's developer guide, and ``LandingComplexItem.cc``, ``CameraSection.cc`` for what a landing
pattern becomes.
"""

import json
import math
from pathlib import Path

from uvf.mavlink import dialect as mav

PLANS = Path(__file__).parent / "plans"
MISSION_FRAME, RELATIVE = 2, 3
NAN = math.nan


def items_of(name, system=1):
    """MISSION_ITEM_INT messages of a plan, numbered from 0."""
    plan = json.loads((PLANS / f"{name}.plan").read_text())
    rows = [row for item in plan["mission"]["items"] for row in _rows(item)]
    return [_message(system, seq, *row) for seq, row in enumerate(rows)]


def _rows(item):
    """(command, frame, seven parameters) of an item of the file."""
    if item["type"] == "SimpleItem":
        return [(item["command"], item["frame"], [NAN if p is None else p for p in item["params"]])]
    if item["complexItemType"] == "survey":
        return [row for simple in item["TransectStyleComplexItem"]["Items"] for row in _rows(simple)]
    assert item["complexItemType"] == "fwLandingPattern"
    return list(_landing(item))


def _landing(item):
    yield mav.MAV_CMD_DO_LAND_START, MISSION_FRAME, [0.0] * 7
    if item["stopTakingPhotos"]:
        yield mav.MAV_CMD_DO_SET_CAM_TRIGG_DIST, MISSION_FRAME, [0.0] * 7
        yield mav.MAV_CMD_IMAGE_STOP_CAPTURE, MISSION_FRAME, [0.0, NAN, NAN, NAN, NAN, NAN, NAN]
    if item["stopVideoPhotos"]:
        yield mav.MAV_CMD_VIDEO_STOP_CAPTURE, MISSION_FRAME, [0.0, NAN, NAN, NAN, NAN, NAN, NAN]
    radius = item["loiterRadius"] * (1 if item["loiterClockwise"] else -1)
    if item["useLoiterToAlt"]:
        yield mav.MAV_CMD_NAV_LOITER_TO_ALT, RELATIVE, [1.0, radius, 0.0, 1.0, *item["landingApproachCoordinate"]]
    else:
        yield mav.MAV_CMD_NAV_WAYPOINT, RELATIVE, [0.0, 0.0, 0.0, NAN, *item["landingApproachCoordinate"]]
    yield mav.MAV_CMD_NAV_LAND, RELATIVE, [0.0] * 4 + item["landCoordinate"]


def _message(system, seq, command, frame, p):
    x, y = (0 if math.isnan(v) else round(v * (1e7 if frame != MISSION_FRAME else 1.0)) for v in p[4:6])
    return mav.MAVLink_mission_item_int_message(system, 1, seq, frame, command, int(seq == 0), 1, *p[:4], x, y, p[6], 0)
