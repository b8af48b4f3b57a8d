"""Mission items on the wire and in the system, one for one, and what of them cannot be flown."""

import math
import struct
from dataclasses import dataclass

from schemas.messages import Mission, MissionItem, Vector3
from uvf.mavlink import dialect as mav
from uvf.mavlink.names import bad_frame, command_name
from uvf.runtime.mavlink.geo import AMSL_FRAMES, HOME_FRAMES, GeoPosition
from uvf.runtime.mavlink.limits import too_far, too_high, too_wide
from uvf.runtime.messages.convert import array
from uvf.runtime.messages.plans.plan_ids import mission_id
from uvf.runtime.messages.validation import error_in

ORIGIN = struct.Struct("<BHB4fiif")
"""Frame, command, autocontinue, param1..4, x, y, z: kept with each item and given back unchanged."""


SKIPPED = frozenset(
    {
        mav.MAV_CMD_DO_SET_ROI_LOCATION,
        mav.MAV_CMD_DO_SET_ROI_WPNEXT_OFFSET,
        mav.MAV_CMD_DO_SET_ROI_NONE,
        mav.MAV_CMD_DO_MOUNT_CONTROL,
        mav.MAV_CMD_SET_CAMERA_MODE,
        mav.MAV_CMD_IMAGE_STOP_CAPTURE,
        mav.MAV_CMD_VIDEO_START_CAPTURE,
        mav.MAV_CMD_VIDEO_STOP_CAPTURE,
        mav.MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW,
    }
)
"""Camera and gimbal items that ground stations add by themselves: they fly as a jump that is never taken."""
TRIGGERS = {
    mav.MAV_CMD_DO_DIGICAM_CONTROL: MissionItem.TRIGGER,
    mav.MAV_CMD_IMAGE_START_CAPTURE: MissionItem.TRIGGER,
    mav.MAV_CMD_DO_SET_CAM_TRIGG_DIST: MissionItem.TRIGGER_DISTANCE,
}
"""Items of the camera that aircraft fly, but for series of pictures by time; for ground vehicles they are skipped, too."""

KIND = {
    mav.MAV_CMD_NAV_WAYPOINT: MissionItem.WAYPOINT,
    mav.MAV_CMD_NAV_LOITER_UNLIM: MissionItem.ORBIT,
    mav.MAV_CMD_NAV_LOITER_TURNS: MissionItem.ORBIT,
    mav.MAV_CMD_NAV_LOITER_TIME: MissionItem.WAYPOINT,
    mav.MAV_CMD_NAV_LOITER_TO_ALT: MissionItem.ORBIT,
    mav.MAV_CMD_NAV_RETURN_TO_LAUNCH: MissionItem.RETURN,
    mav.MAV_CMD_NAV_LAND: MissionItem.LAND,
    mav.MAV_CMD_NAV_TAKEOFF: MissionItem.TAKEOFF,
    mav.MAV_CMD_DO_JUMP: MissionItem.JUMP,
    mav.MAV_CMD_DO_CHANGE_SPEED: MissionItem.SPEED,
    mav.MAV_CMD_DO_LAND_START: MissionItem.LAND_START,
    mav.MAV_CMD_DO_SET_HOME: MissionItem.SET_HOME,
    mav.MAV_CMD_NAV_DELAY: MissionItem.WAYPOINT,
    **dict.fromkeys(SKIPPED, MissionItem.JUMP),
    **TRIGGERS,
}
REFUSED = {mav.MAV_CMD_CONDITION_YAW: "CONDITION_YAW: it points where it goes"}
"""Commands that change what is flown and that cannot be done."""
WITH_PLACE = frozenset({MissionItem.WAYPOINT, MissionItem.ORBIT, MissionItem.LAND, MissionItem.TAKEOFF})
OF_AIRCRAFT = frozenset({MissionItem.ORBIT, MissionItem.LAND, MissionItem.LAND_START, MissionItem.TAKEOFF})
NO_CHANGE, CRUISE = -1.0, -2.0  # of DO_CHANGE_SPEED
HERE = 1.0  # of DO_SET_HOME
SAME_PLACE = 0.5  # m


@dataclass
class BadItem(Exception):
    """A refused item: the MAV_MISSION_RESULT and the reason in words."""

    result: int
    reason: str


def is_skipped(command: int, pictures: float, facts: GeoPosition) -> bool:
    """Whether an item is kept in the plan but nothing is done for it. pictures: its param3, the number of pictures [-]."""
    series = command == mav.MAV_CMD_IMAGE_START_CAPTURE and pictures != 1
    return command in SKIPPED or series or (facts.is_ground and command in TRIGGERS)


def from_wire(item: mav.MAVLink_mission_item_int_message, facts: GeoPosition, home_z: float) -> MissionItem:
    """Mission item of one on the wire. home_z: height of home [m, world]. Raises BadItem."""
    kind = KIND.get(item.command)
    if item.command in REFUSED:
        raise BadItem(mav.MAV_MISSION_UNSUPPORTED, REFUSED[item.command])
    if kind is None:
        raise BadItem(mav.MAV_MISSION_UNSUPPORTED, f"{command_name(item.command)} is not supported: leave it out")
    params = (item.param1, item.param2, item.param3, item.param4)
    if facts.is_ground and kind in OF_AIRCRAFT:
        raise BadItem(mav.MAV_MISSION_UNSUPPORTED, f"{MissionItem.Kind.Name(kind)} is not for a ground vehicle")
    if any(math.isinf(v) for v in (*params, item.z)):
        raise BadItem(mav.MAV_MISSION_INVALID, f"a parameter of {command_name(item.command)} is infinite")
    result = MissionItem(kind=kind, origin=packed(item))
    if _has_place(item, kind):
        result.position.CopyFrom(place_of(item, facts, home_z))
    if is_skipped(item.command, item.param3, facts) or (kind == MissionItem.SPEED and not (item.param2 > 0 or item.param2 == CRUISE)):
        result.kind = MissionItem.JUMP  # that is never taken
    _fill(result, item.command, tuple(0.0 if math.isnan(p) else p for p in params))
    return result


def _has_place(item: mav.MAVLink_mission_item_int_message, kind: "MissionItem.Kind") -> bool:
    if kind == MissionItem.SET_HOME:
        return bool(item.param1 != HERE)
    return kind in WITH_PLACE and item.command != mav.MAV_CMD_NAV_DELAY


def packed(item: mav.MAVLink_mission_item_int_message) -> bytes:
    """Bytes of a wire item, in the format ``ORIGIN``."""
    params = (item.param1, item.param2, item.param3, item.param4)
    return ORIGIN.pack(item.frame, item.command, item.autocontinue, *params, item.x, item.y, item.z)


def unpacked(origin: bytes) -> "Body":
    """Body of a wire item from its bytes in the format ``ORIGIN``."""
    frame, command, autocontinue, p1, p2, p3, p4, x, y, z = ORIGIN.unpack(origin)
    return frame, command, autocontinue, p1, p2, p3, p4, x, y, z


def place_of(item: mav.MAVLink_mission_item_int_message, facts: GeoPosition, home_z: float) -> Vector3:
    """Place (x, y, z) [m, world] of a wire item. home_z: height of home [m, world]. Raises BadItem."""
    if item.frame not in HOME_FRAMES + AMSL_FRAMES:
        raise BadItem(mav.MAV_MISSION_UNSUPPORTED_FRAME, bad_frame(item.frame))
    if abs(item.x) > 900_000_000:
        raise BadItem(mav.MAV_MISSION_INVALID_PARAM5_X, "latitude is out of range")
    if abs(item.y) > 1_800_000_000:
        raise BadItem(mav.MAV_MISSION_INVALID_PARAM6_Y, "longitude is out of range")
    if not math.isfinite(item.z):
        raise BadItem(mav.MAV_MISSION_INVALID_PARAM7, "altitude is missing")
    base = home_z + facts.origin.altitude if item.frame in HOME_FRAMES else 0.0
    place = facts.world(item.x * 1e-7, item.y * 1e-7, base + item.z)
    if reason := too_far(place):
        raise BadItem(mav.MAV_MISSION_INVALID_PARAM5_X, reason)
    if reason := too_high(place):
        raise BadItem(mav.MAV_MISSION_INVALID_PARAM7, reason)
    return place


def _fill(item: MissionItem, command: int, p: tuple[float, ...]) -> None:
    """What the parameters ``p`` (from param1 on) mean for the command. Raises BadItem."""
    if command in (mav.MAV_CMD_NAV_WAYPOINT, mav.MAV_CMD_NAV_LOITER_TIME, mav.MAV_CMD_NAV_DELAY):
        item.hold = _not_negative(p[0], mav.MAV_MISSION_INVALID_PARAM1, "hold time")
    if command == mav.MAV_CMD_NAV_WAYPOINT:
        item.acceptance_radius = _not_negative(p[1], mav.MAV_MISSION_INVALID_PARAM2, "acceptance radius")
        if p[3] != 0:  # as ground stations send it who mean nothing by it; north is 360 degrees
            item.course = math.remainder(math.pi / 2 - math.radians(p[3]), math.tau)
    if command == mav.MAV_CMD_NAV_LOITER_TO_ALT:
        item.radius, item.to_altitude = _radius(p[1], mav.MAV_MISSION_INVALID_PARAM2), True
    if command == mav.MAV_CMD_DO_SET_CAM_TRIGG_DIST:
        item.distance = _not_negative(p[0], mav.MAV_MISSION_INVALID_PARAM1, "distance between pictures")
    if command in (mav.MAV_CMD_NAV_LOITER_UNLIM, mav.MAV_CMD_NAV_LOITER_TURNS, mav.MAV_CMD_NAV_LOITER_TIME):
        item.radius = _radius(p[2], mav.MAV_MISSION_INVALID_PARAM3)
    if command == mav.MAV_CMD_NAV_LOITER_TURNS:
        item.turns = _not_negative(p[0], mav.MAV_MISSION_INVALID_PARAM1, "number of turns")
    if command == mav.MAV_CMD_DO_JUMP:
        item.jump_to = int(_not_negative(p[0], mav.MAV_MISSION_INVALID_PARAM1, "item to jump to"))
        item.repeat = _count(p[1])
    if command == mav.MAV_CMD_DO_CHANGE_SPEED and p[1] > 0:
        item.speed = _not_negative(p[1], mav.MAV_MISSION_INVALID_PARAM2, "speed")


def _not_negative(value: float, result: int, what: str) -> float:
    if not 0 <= value <= 1e6:
        raise BadItem(result, f"{what} {value:g} is out of range")
    return value


def _radius(value: float, result: int) -> float:
    if reason := too_wide(value):
        raise BadItem(result, reason)
    return value


def _count(value: float) -> int:
    if abs(value) > 1e6:
        raise BadItem(mav.MAV_MISSION_INVALID_PARAM2, f"number of repetitions {value:g} is out of range")
    return int(value)


def check_whole(items: list[MissionItem]) -> None:
    """Checks what only the whole plan shows; a delay takes the place of the item before it. Raises BadItem."""
    before: MissionItem | None = None
    for index, item in enumerate(items):
        if item.kind in WITH_PLACE and not item.HasField("position"):
            if before is None:
                raise BadItem(mav.MAV_MISSION_INVALID_SEQUENCE, f"item {index}: a delay needs a place before it")
            item.position.CopyFrom(before.position)
        before = item if item.kind in WITH_PLACE else before
        if item.kind == MissionItem.JUMP and item.jump_to >= len(items):
            raise BadItem(mav.MAV_MISSION_INVALID_PARAM1, f"item {index}: jump to item {item.jump_to} of {len(items)}")


def mission_of(items: list[MissionItem]) -> Mission:
    """Mission of these items with the id of its content: CRC-32, not 0 unless empty."""
    return Mission(items=items, id=mission_id(items))


Body = tuple[int, int, int, float, float, float, float, int, int, float]


def as_item(body: Body) -> mav.MAVLink_mission_item_int_message:
    """Wire item of a body, addressed to nobody in particular."""
    frame, command, autocontinue, p1, p2, p3, p4, x, y, z = body
    return mav.MAVLink_mission_item_int_message(0, 0, 0, frame, command, 0, autocontinue, p1, p2, p3, p4, x, y, z)


def is_nowhere(item: MissionItem) -> bool:
    """Whether the item is of a kind that needs a place and has none."""
    return item.kind in WITH_PLACE and not item.HasField("position")


def is_same_place(one: Vector3, other: Vector3, ignore_height: bool = False) -> bool:
    """Whether two places (x, y, z) [m, world] are the same but for rounding, along each axis; ``ignore_height``: in x and y alone."""
    apart = abs(one.x - other.x), abs(one.y - other.y), 0.0 if ignore_height else abs(one.z - other.z)
    return max(apart) < SAME_PLACE


def means_the_same(item: MissionItem, facts: GeoPosition, home_z: float) -> bool:
    """Whether the item's wire form still says what the item does, place included; home_z: height of home [m, world].

    With another home, or when somebody has changed the item, it does not.
    """
    return _means(unpacked(item.origin), item, facts, home_z)


def _means(body: Body, item: MissionItem, facts: GeoPosition, home_z: float) -> bool:
    try:
        read = from_wire(as_item(body), facts, home_z)
    except BadItem:
        return item.kind == MissionItem.JUMP  # one that the system has no word for
    if item.kind == MissionItem.JUMP:
        return read.kind == MissionItem.JUMP or is_nowhere(read) or bool(error_in(read))
    if read.HasField("position") and not is_same_place(read.position, item.position):
        return False
    own = MissionItem()
    own.CopyFrom(item)
    for each in (read, own):
        each.ClearField("position")
        each.ClearField("origin")
    return read == own


def lifted(body: Body, z: float, home_z: float) -> Body:
    """The same wire item at the height ``z`` [m, world] where its frame counts from home, which is now at ``home_z`` [m, world]."""
    return (*body[:9], z - home_z) if body[0] in HOME_FRAMES else body


def _remembered(item: MissionItem, facts: GeoPosition, home_z: float) -> Body | None:
    """What an item came from over the wire, where that says what is flown; with another home, its height over that."""
    if len(item.origin) != ORIGIN.size:
        return None
    body = unpacked(item.origin)
    if _means(body, item, facts, home_z):
        return body
    body = lifted(body, item.position.z, home_z)
    return body if _means(body, item, facts, home_z) else None


def to_wire(item: MissionItem, facts: GeoPosition, home_z: float) -> Body:
    """Body of an item: what came over the wire, as long as it means the same, or the nearest to an item of a mission file.

    The latter with altitudes above home (``home_z`` [m, world]): MAVSDK takes no others.
    """
    if (remembered := _remembered(item, facts, home_z)) is not None:
        return remembered
    nan = math.nan
    commands: dict[int, tuple[int, float, float, float, float]] = {
        MissionItem.WAYPOINT: (mav.MAV_CMD_NAV_WAYPOINT, item.hold, item.acceptance_radius, 0.0, _yaw(item)),
        MissionItem.ORBIT: (mav.MAV_CMD_NAV_LOITER_UNLIM, 0.0, 0.0, item.radius, nan),
        MissionItem.RETURN: (mav.MAV_CMD_NAV_RETURN_TO_LAUNCH, 0.0, 0.0, 0.0, 0.0),
        MissionItem.JUMP: (mav.MAV_CMD_DO_JUMP, item.jump_to, item.repeat, 0.0, 0.0),
        MissionItem.SPEED: (mav.MAV_CMD_DO_CHANGE_SPEED, 1.0 if facts.is_ground else 0.0, item.speed or CRUISE, -1.0, 0.0),
        MissionItem.TAKEOFF: (mav.MAV_CMD_NAV_TAKEOFF, 0.0, 0.0, 0.0, nan),
        MissionItem.LAND: (mav.MAV_CMD_NAV_LAND, 0.0, 0.0, 0.0, nan),
        MissionItem.LAND_START: (mav.MAV_CMD_DO_LAND_START, 0.0, 0.0, 0.0, 0.0),
        MissionItem.SET_HOME: (mav.MAV_CMD_DO_SET_HOME, float(not item.HasField("position")), 0.0, 0.0, 0.0),
        MissionItem.TRIGGER: (mav.MAV_CMD_DO_DIGICAM_CONTROL, 0.0, 0.0, 0.0, 0.0),
        MissionItem.TRIGGER_DISTANCE: (mav.MAV_CMD_DO_SET_CAM_TRIGG_DIST, item.distance, 0.0, 0.0, 0.0),
    }
    command, p1, p2, p3, p4 = commands[item.kind]
    if item.kind == MissionItem.ORBIT and item.turns > 0:
        command, p1 = mav.MAV_CMD_NAV_LOITER_TURNS, item.turns
    if item.kind == MissionItem.ORBIT and item.to_altitude:
        command, p1, p2, p3 = mav.MAV_CMD_NAV_LOITER_TO_ALT, 0.0, item.radius, 0.0
    if item.kind not in WITH_PLACE and not (item.kind == MissionItem.SET_HOME and item.HasField("position")):
        return mav.MAV_FRAME_MISSION, command, 1, p1, p2, p3, p4, 0, 0, 0.0
    latitude, longitude, _ = facts.geodetic(array(item.position))
    z = item.position.z - home_z
    return mav.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, command, 1, p1, p2, p3, p4, round(latitude * 1e7), round(longitude * 1e7), z


def _yaw(item: MissionItem) -> float:
    """deg clockwise from north, 0 < yaw <= 360; NaN for any."""
    return 360.0 - (math.degrees(item.course) - 90.0) % 360.0 if item.HasField("course") else math.nan


def remembered_point(body: Body, point: Vector3, facts: GeoPosition, home_z: float) -> Body:
    """Body of a place that came over the wire, at ``point`` (x, y, z) [m, world] even if home, now at ``home_z`` [m, world], has moved."""
    try:
        stays = is_same_place(place_of(as_item(body), facts, home_z), point)
    except BadItem:
        stays = False
    return body if stays else lifted(body, point.z, home_z)


def point_body(command: int, point: Vector3, facts: GeoPosition, home_z: float) -> Body:
    """Body of an item that is only a place (rally point, return point): ``point`` (x, y, z) [m, world], above ``home_z`` [m, world]."""
    latitude, longitude, _ = facts.geodetic(array(point))
    where = round(latitude * 1e7), round(longitude * 1e7), point.z - home_z
    return mav.MAV_FRAME_GLOBAL_RELATIVE_ALT, command, 1, 0.0, 0.0, 0.0, 0.0, *where
