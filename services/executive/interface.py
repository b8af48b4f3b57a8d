"""What the mission's executive reads and writes."""

from schemas import topics
from schemas.messages import (
    ArmRequest,
    CancelRequest,
    Detections,
    DriveCommand,
    Event,
    FollowRequest,
    FrameTransform,
    GoalRequest,
    Grid,
    MapReply,
    MapRequest,
    MissionProgress,
    ModeRequest,
    NavStatus,
    PoseInFrame,
    PreviewReply,
    PreviewRequest,
    Reply,
    RouteRequest,
    SaveMapRequest,
    Tasks,
    VehicleStatus,
)
from uvf.runtime.contract.declaration import Reads, Writes, answers, call, each_vehicle, every, topic
from uvf.runtime.contract.service import Answer

SOURCE = "executive"


class Inputs(Reads):
    """What each vehicle says of itself, and answers to what was asked of them."""

    pose: dict[str, PoseInFrame] = each_vehicle(topics.POSE)
    status: dict[str, VehicleStatus] = each_vehicle(topics.STATUS)
    nav: dict[str, NavStatus] = each_vehicle(topics.NAV_STATUS)
    map_place: dict[str, FrameTransform] = each_vehicle(topics.TEAM_PLACE)
    detections: dict[str, Detections] = each_vehicle(topics.DETECTIONS)
    progress: dict[str, MissionProgress] = each_vehicle(topics.PROGRESS)
    told: dict[str, list[Event]] = each_vehicle(every(topics.EVENTS.by("planner")))
    arm: list[Answer[ArmRequest, Reply]] = answers(topics.ARM)
    mode: list[Answer[ModeRequest, Reply]] = answers(topics.SET_MODE)
    goal: list[Answer[GoalRequest, Reply]] = answers(topics.GOAL)
    route: list[Answer[RouteRequest, Reply]] = answers(topics.ROUTE)
    follow: list[Answer[FollowRequest, Reply]] = answers(topics.FOLLOW)
    preview: list[Answer[PreviewRequest, PreviewReply]] = answers(topics.PREVIEW)
    save_map: list[Answer[SaveMapRequest, Reply]] = answers(topics.SAVE_MAP)
    get_map: list[Answer[MapRequest, MapReply]] = answers(topics.GET_MAP)
    cancel: list[Answer[CancelRequest, Reply]] = answers(topics.CANCEL)


class Outputs(Writes):
    """How far the tasks are, requests to vehicles, velocities of recorded drives, and maps that are handed over."""

    tasks: Tasks | None = topic(topics.TASKS)
    events: list[Event] | None = topic(topics.SYSTEM_EVENTS.by(SOURCE))
    drive: dict[str, DriveCommand] | None = topic(topics.DRIVE.by(SOURCE))
    shared: dict[str, Grid] | None = topic(topics.SHARED_MAP)
    arm: dict[str, ArmRequest] | None = call(topics.ARM)
    mode: dict[str, ModeRequest] | None = call(topics.SET_MODE)
    goal: dict[str, GoalRequest] | None = call(topics.GOAL)
    route: dict[str, RouteRequest] | None = call(topics.ROUTE)
    follow: dict[str, FollowRequest] | None = call(topics.FOLLOW)
    preview: dict[str, list[PreviewRequest]] | None = call(topics.PREVIEW)
    save_map: dict[str, SaveMapRequest] | None = call(topics.SAVE_MAP)
    get_map: dict[str, MapRequest] | None = call(topics.GET_MAP)
    cancel: dict[str, CancelRequest] | None = call(topics.CANCEL)
