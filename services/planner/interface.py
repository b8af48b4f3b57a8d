"""What the planner reads and writes."""

from schemas import topics
from schemas.messages import (
    CameraCalibration,
    CancelRequest,
    CompressedImage,
    Contact,
    Event,
    Fence,
    FollowRequest,
    FrameTransform,
    GoalRequest,
    Grid,
    LaserScan,
    Mission,
    MissionProgress,
    ModeRequest,
    NavDirective,
    NavReport,
    NavStatus,
    PoseInFrame,
    PosesInFrame,
    PreviewReply,
    PreviewRequest,
    RallyPoints,
    Range,
    Reply,
    RouteRequest,
    VehicleStatus,
)
from uvf.runtime.contract.declaration import Reads, Writes, answers, call, each_vehicle, every, optional, replies, request, topic
from uvf.runtime.contract.service import Answer


class Inputs(Reads):
    """Poses, map, all that sees or feels obstacles, the tracker's report, mission, and requests for goals."""

    pose: list[PoseInFrame] = every(topics.POSE)
    map: Grid = topic(topics.MAP)
    scan: LaserScan | None = optional(topics.SCAN)
    other_scans: list[LaserScan] = optional(every(topics.OTHER_SCANS))
    depth: list[CompressedImage] = optional(every(topics.DEPTH))
    info: CameraCalibration | None = optional(topics.CAMERA_INFO)
    sonar: list[Range] = optional(every(topics.SONAR))
    contact: list[Contact] = optional(every(topics.CONTACT))
    range: list[Range] = optional(every(topics.RANGE))
    team: dict[str, PoseInFrame] = each_vehicle(optional(topics.POSE))
    team_path: dict[str, PosesInFrame] = each_vehicle(optional(topics.PATH))
    team_nav: dict[str, NavStatus] = each_vehicle(optional(topics.NAV_STATUS))
    report: NavReport | None = optional(topics.NAV_REPORT)
    keep_out: Grid | None = optional(topics.KEEP_OUT)
    shared: Grid | None = optional(topics.SHARED_MAP)
    team_map: dict[str, Grid] = each_vehicle(optional(topics.TEAM_MAP))
    team_place: FrameTransform | None = optional(topics.TEAM_PLACE)
    status: VehicleStatus | None = optional(topics.STATUS)
    mission: Mission | None = optional(topics.MISSION)
    progress: MissionProgress | None = optional(topics.PROGRESS)
    bounds: Fence | None = optional(topics.FENCE)
    rally: RallyPoints | None = optional(topics.RALLY)
    goal: list[GoalRequest] = request(topics.GOAL)
    route: list[RouteRequest] = request(topics.ROUTE)
    follow: list[FollowRequest] = request(topics.FOLLOW)
    cancel: list[CancelRequest] = request(topics.CANCEL)
    preview: list[PreviewRequest] = request(topics.PREVIEW)
    set_mode: list[Answer[ModeRequest, Reply]] = answers(topics.SET_MODE)

    @property
    def scans(self) -> list[LaserScan]:
        """Of all lidars."""
        return [*([self.scan] if self.scan is not None else []), *self.other_scans]


class Outputs(Writes):
    """Directive and path, status, and replies."""

    directive: NavDirective | None = topic(topics.NAV_DIRECTIVE)
    path: PosesInFrame | None = topic(topics.PATH)
    nav_status: NavStatus | None = topic(topics.NAV_STATUS)
    costmap: Grid | None = topic(topics.COSTMAP)
    events: list[Event] | None = topic(topics.EVENTS.by("planner"))
    goal: list[Reply] = replies(topics.GOAL)
    route: list[Reply] = replies(topics.ROUTE)
    follow: list[Reply] = replies(topics.FOLLOW)
    cancel: list[Reply] = replies(topics.CANCEL)
    preview: list[PreviewReply] = replies(topics.PREVIEW)
    set_mode: list[ModeRequest] = call(topics.SET_MODE)


class Recalls(Reads):
    """Latched status from which a restarted instance resumes."""

    nav_status: NavStatus | None = topic(topics.NAV_STATUS)
