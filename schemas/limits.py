"""What fits into the messages of THE TABLE: sizes of whole messages, and what a field may hold where the common limits do not fit.

Everybody who hears a message checks it against these before anything else is done with it.
"""

from google.protobuf.message import Message

from schemas import messages as m

KB, MB = 1024, 1024 * 1024
SIZE = 64 * KB
"""Bytes of a message, unless it is named in ``SIZES``."""
SIZES: dict[type[Message], int] = {
    m.CompressedImage: 16 * MB,
    m.Grid: 128 * MB,
    m.MapReply: 128 * MB,
    m.MapSession: 512 * MB,
    m.OctreeMap: 128 * MB,
    m.LaserScan: 2 * MB,
    m.PosesInFrame: 8 * MB,
    m.PreviewReply: 8 * MB,
    m.FrameTransforms: MB,
    m.Clock: MB,
    m.Done: MB,
    m.Health: MB,
    m.Processes: MB,
    m.SimObjects: MB,
    m.Fence: 2 * MB,
    m.FenceRequest: 2 * MB,
    m.Mission: 2 * MB,
    m.MissionRequest: 2 * MB,
    m.ParamReply: MB,
    m.ParamValues: MB,
}

NUMBER = 1e12
"""Of any unit: beyond it squares lose the rest, and indices leave their integers."""
INTEGER = 2**53
TEXT = 2000  # characters; printable ones, line ends and tabs
ENTRIES = 10_000  # of a list or map
LENGTHS: dict[str, int] = {
    "foxglove.LaserScan.ranges": 200_000,
    "foxglove.LaserScan.intensities": 200_000,
    "foxglove.PosesInFrame.poses": 100_000,
    "uvf.v1.PreviewReply.poses": 100_000,
    "foxglove.PoseInFrame.frame_id": 100,
    "foxglove.FrameTransform.parent_frame_id": 100,
    "foxglove.FrameTransform.child_frame_id": 100,
    "uvf.v1.RouteRequest.places": 200,
    "uvf.v1.Fence.zones": 32,
    "uvf.v1.FenceZone.vertices": 128,
    "uvf.v1.Param.description": 4000,
    "uvf.v1.ParamRequest.name": 100,
    "uvf.v1.SimObjects.objects": 1000,
    "uvf.v1.Tasks.tasks": 500,
    "uvf.v1.StopState.engagements": 100,
    "uvf.v1.StopState.released": 1000,
    "uvf.v1.StopCommand.releases": 100,
}
"""Of texts, lists and maps that are not held to ``TEXT`` and ``ENTRIES``."""
RANGES: dict[str, tuple[int, int]] = {
    "uvf.v1.Link.port": (0, 65535),
    "uvf.v1.OctreeMap.depth": (0, 16),
    "uvf.v1.MissionProgress.current": (0, ENTRIES),
    "uvf.v1.MissionProgress.total": (0, ENTRIES),
    "uvf.v1.MissionProgress.reached": (-1, ENTRIES),
    "uvf.v1.VehicleStatus.waypoint": (0, ENTRIES),
    "uvf.v1.NavStatus.route_at": (0, 200),
    "uvf.v1.VehicleStatus.system_id": (0, 255),
    "uvf.v1.Gnss.satellites": (0, 255),
}
"""Of integers that are an index, a number with few values or the length of a loop."""
PLACE = 2e5  # m from the world's origin; beyond, a flat world is none, or somebody has left latitude and longitude at zero
MOST: dict[str, float] = {
    "uvf.v1.MissionItem.position": PLACE,
    "uvf.v1.GoalRequest.position": PLACE,
    "uvf.v1.PreviewRequest.position": PLACE,
    "uvf.v1.RouteRequest.places": PLACE,
    "uvf.v1.OrbitRequest.centre": PLACE,
    "uvf.v1.HomeCommand.position": PLACE,
    "uvf.v1.LineSetpoint.origin": PLACE,
    "uvf.v1.CircleSetpoint.centre": PLACE,
    "uvf.v1.FenceZone.vertices": PLACE,
    "uvf.v1.FenceZone.centre": PLACE,
    "uvf.v1.Fence.return_point": PLACE,
    "uvf.v1.RallyPoints.points": PLACE,
    "uvf.v1.Imu.angular_velocity": 1e3,
    "uvf.v1.Imu.specific_force": 1e4,
    "uvf.v1.Imu.magnetic_field": 1.0,
    "uvf.v1.Gnss.latitude": 1.5708,
    "uvf.v1.Gnss.longitude": 6.2832,
    "uvf.v1.Gnss.altitude": 1e6,
    "uvf.v1.Gnss.velocity_enu": 1e4,
}
"""Of single numbers and of the lengths of vectors: what no place and no sensor can be, and no filter could be mended from."""
OPEN: dict[str, frozenset[str]] = {
    "foxglove.LaserScan": frozenset(("ranges", "intensities")),  # no return may be written as infinite
    "uvf.v1.GoalRequest": frozenset(("yaw",)),  # NaN = any
    "uvf.v1.Param": frozenset(("min", "max")),  # infinite = no limit
}
"""Numbers of any value."""
VEHICLE = r"[a-z][a-z0-9_]{0,39}"
"""Of a vehicle, and of what is put into a simulation; whole, in files as on the bus."""
FOLDER = r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,79}"
"""Of a model or a world; whole, in files as on the bus."""
PATTERNS: dict[str, str] = {"uvf.v1.ExternalVehicle.model": f"({FOLDER})?", "uvf.v1.SimObject.model": f"({FOLDER})?"}
"""Texts that become names of files, where they are not empty."""
ITEM = 32
BYTES: dict[str, int] = {"uvf.v1.MissionItem.origin": ITEM, "uvf.v1.Fence.origin": ITEM, "uvf.v1.RallyPoints.origin": ITEM}
"""Bytes of one length, where they are not empty: an item of MAVLink's mission protocol as it came over the wire."""
GRID_SIDE = 50_000  # cells
GRID_CELL = (1e-3, 10.0)  # m, as of maps in files


def size_of(type_: type[Message]) -> int:
    """The largest size [bytes] of a message of this type."""
    return SIZES.get(type_, SIZE)
