"""Rally points as items on the wire, and back."""

from collections.abc import Sequence

from schemas.messages import RallyPoints
from uvf.mavlink import dialect as mav
from uvf.runtime.mavlink.geo import GeoPosition
from uvf.runtime.mavlink.mission_items import Body, packed, place_of, point_body, remembered_point, unpacked


def rally_of(items: Sequence[mav.MAVLink_mission_item_int_message], facts: GeoPosition, home_z: float) -> RallyPoints:
    """Rally points of wire items. home_z: height of home [m, world]. Raises BadItem."""
    points = [place_of(item, facts, home_z) for item in items]
    return RallyPoints(points=points, origin=[packed(item) for item in items])


def bodies(rally: RallyPoints, facts: GeoPosition, home_z: float) -> list[Body]:
    """Items of rally points: those that came over the wire, or new ones above home. home_z: height of home [m, world]."""
    if len(rally.origin) == len(rally.points):
        pairs = zip(rally.origin, rally.points, strict=True)
        return [remembered_point(unpacked(origin), point, facts, home_z) for origin, point in pairs]
    return [point_body(mav.MAV_CMD_NAV_RALLY_POINT, point, facts, home_z) for point in rally.points]
