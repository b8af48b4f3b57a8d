"""The ground station: what all vehicles say onto a page, what people ask on the page to the vehicles."""

from collections.abc import Mapping, Sequence
from typing import Any

from google.protobuf.message import Message

from schemas import topics
from schemas.messages import (
    ArmRequest,
    CancelRequest,
    Clock,
    ClockRequest,
    CompressedImage,
    Detections,
    DriveCommand,
    EstimateQuality,
    Event,
    ExternalVehicle,
    Fence,
    FenceRequest,
    FrameTransform,
    FrameTransforms,
    GimbalCommand,
    GoalRequest,
    Grid,
    Health,
    JointStates,
    LaserScan,
    LaunchRequest,
    MapFix,
    MappingRequest,
    Mission,
    MissionProgress,
    MissionRequest,
    ModeRequest,
    MovingObstacles,
    NavState,
    NavStatus,
    OctreeMap,
    Odometry,
    PlaceRequest,
    PoseInFrame,
    PosesInFrame,
    PreviewReply,
    PreviewRequest,
    Processes,
    RallyPoints,
    RallyRequest,
    RelocalizeRequest,
    Reply,
    SaveMapRequest,
    SetCurrentRequest,
    SimObjects,
    StopCommand,
    Tasks,
    VehicleCommandRequest,
    VehicleStatus,
    WindRequest,
)
from services.gcs.export import Exporter
from services.gcs.listening import BusListening
from services.gcs.orders.commands import Commander
from services.gcs.orders.offers import SOURCE
from services.gcs.orders.time_travel import TimeTravel
from services.gcs.state import past
from services.gcs.state.history import CLOCK, OBJECTS, WINDSOCKS, RecentHistory
from services.gcs.state.state import Model
from services.gcs.surveying import SurveyPlanner
from services.gcs.view.composer import Composer
from services.gcs.view.drawing import Page
from services.gcs.view.panels.timeline import TimeBar
from services.gcs.watch import BusWatch
from uvf.models.scenario import Scenario
from uvf.runtime.contract.declaration import Reads, Writes, answers, call, each_vehicle, every, optional, stop_all, topic
from uvf.runtime.contract.service import Answer, Service
from uvf.runtime.state.stop_all import StopStatus

NEWEST = (
    "nav",
    "pose",
    "odometry",
    "truth",
    "status",
    "nav_status",
    "path",
    "mission",
    "progress",
    "fence",
    "scan",
    "image",
    "chase",
    "gimbal",
    "gimbal_joints",
    "joints",
    "grid",
    "team_map",
    "world_from_map",
    "fix",
    "quality",
    "particles",
    "obstacles",
    "detections",
    "costmap",
    "local_costs",
    "octree",
    "map_from_odom",
    "tf_static",
    "rally",
)
"""Inputs by vehicle that are kept under their names as the newest of their kind."""
ALONE_PERIOD = 1.0
"""Seconds between two pictures while no browser looks; who comes finds a scene that stands, and the picture of that step."""


class GroundStation(Service):
    """Shows the vehicles of a mission on a page, and sends the requests made there."""

    name = "gcs"
    hz = 20.0
    scope = "world"
    clock = "wall"

    class Inputs(Reads):
        """Messages of the vehicles and of the system, and answers to requests."""

        clock: Clock | None = optional(topics.CLOCK)
        tasks: Tasks | None = optional(topics.TASKS)
        processes: list[Processes] = optional(every(topics.PROCESSES.by("*")))
        objects: SimObjects | None = optional(topics.OBJECTS)
        aircraft: SimObjects | None = optional(topics.AIR_OBJECTS)
        windsocks: FrameTransforms | None = optional(topics.WINDSOCKS)
        health: list[Health] = optional(every(topics.HEALTH.by("*")))
        stop: StopStatus = stop_all()
        external: dict[str, ExternalVehicle] = each_vehicle(topics.EXTERNAL_VEHICLE)
        nav: dict[str, NavState] = each_vehicle(topics.NAV_STATE)
        pose: dict[str, PoseInFrame] = each_vehicle(topics.POSE)
        odometry: dict[str, Odometry] = each_vehicle(topics.ODOMETRY)
        truth: dict[str, NavState] = each_vehicle(topics.TRUTH)
        status: dict[str, VehicleStatus] = each_vehicle(topics.STATUS)
        nav_status: dict[str, NavStatus] = each_vehicle(topics.NAV_STATUS)
        path: dict[str, PosesInFrame] = each_vehicle(topics.PATH)
        mission: dict[str, Mission] = each_vehicle(topics.MISSION)
        progress: dict[str, MissionProgress] = each_vehicle(topics.PROGRESS)
        fence: dict[str, Fence] = each_vehicle(topics.FENCE)
        scan: dict[str, LaserScan] = each_vehicle(topics.SCAN)
        other_scans: dict[str, list[LaserScan]] = each_vehicle(every(topics.OTHER_SCANS))
        image: dict[str, CompressedImage] = each_vehicle(topics.IMAGE)
        chase: dict[str, CompressedImage] = each_vehicle(topics.VIEW.by("chase"))
        gimbal: dict[str, CompressedImage] = each_vehicle(topics.VIEW.by("gimbal"))
        gimbal_joints: dict[str, JointStates] = each_vehicle(topics.GIMBAL_JOINTS)
        joints: dict[str, JointStates] = each_vehicle(topics.JOINTS)
        grid: dict[str, Grid] = each_vehicle(topics.MAP)
        team_map: dict[str, Grid] = each_vehicle(topics.TEAM_MAP)
        world_from_map: dict[str, FrameTransform] = each_vehicle(topics.TF_WORLD)
        fix: dict[str, MapFix] = each_vehicle(topics.MAP_POSE)
        quality: dict[str, EstimateQuality] = each_vehicle(topics.QUALITY)
        particles: dict[str, PosesInFrame] = each_vehicle(topics.PARTICLES)
        obstacles: dict[str, MovingObstacles] = each_vehicle(topics.OBSTACLES)
        detections: dict[str, Detections] = each_vehicle(topics.DETECTIONS)
        costmap: dict[str, Grid] = each_vehicle(topics.COSTMAP)
        local_costs: dict[str, Grid] = each_vehicle(topics.LOCAL_COSTS)
        octree: dict[str, OctreeMap] = each_vehicle(topics.OCTREE)
        map_from_odom: dict[str, FrameTransform] = each_vehicle(topics.TF_MAP)
        tf_static: dict[str, FrameTransforms] = each_vehicle(topics.TF_STATIC)
        rally: dict[str, RallyPoints] = each_vehicle(topics.RALLY)
        events: dict[str, list[Event]] = each_vehicle(every(topics.EVENTS.by("*")))
        goal: list[Answer[GoalRequest, Reply]] = answers(topics.GOAL)
        cancel: list[Answer[CancelRequest, Reply]] = answers(topics.CANCEL)
        arm: list[Answer[ArmRequest, Reply]] = answers(topics.ARM)
        mode: list[Answer[ModeRequest, Reply]] = answers(topics.SET_MODE)
        vehicle_command: list[Answer[VehicleCommandRequest, Reply]] = answers(topics.VEHICLE_COMMAND)
        preview: list[Answer[PreviewRequest, PreviewReply]] = answers(topics.PREVIEW)
        set_mission: list[Answer[MissionRequest, Reply]] = answers(topics.SET_MISSION)
        set_fence: list[Answer[FenceRequest, Reply]] = answers(topics.SET_FENCE)
        set_rally: list[Answer[RallyRequest, Reply]] = answers(topics.SET_RALLY)
        current: list[Answer[SetCurrentRequest, Reply]] = answers(topics.SET_CURRENT)
        save_map: list[Answer[SaveMapRequest, Reply]] = answers(topics.SAVE_MAP)
        place: list[Answer[PlaceRequest, Reply]] = answers(topics.PLACE)
        mapping: list[Answer[MappingRequest, Reply]] = answers(topics.MAPPING)
        relocalize: list[Answer[RelocalizeRequest, Reply]] = answers(topics.RELOCALIZE)
        clock_request: list[Answer[ClockRequest, Reply]] = answers(topics.CLOCK_REQUEST)
        wind: list[Answer[WindRequest, Reply]] = answers(topics.WIND)
        launch: list[Answer[LaunchRequest, Reply]] = answers(topics.LAUNCH)

    class Outputs(Writes):
        """Commands and requests to the vehicles."""

        stop: StopCommand | None = topic(topics.STOP.by(SOURCE))
        drive: dict[str, DriveCommand] | None = topic(topics.DRIVE.by(SOURCE))
        gimbal: dict[str, GimbalCommand] | None = topic(topics.GIMBAL.by(SOURCE))
        goal: list[GoalRequest] = call(topics.GOAL)
        cancel: list[CancelRequest] = call(topics.CANCEL)
        arm: list[ArmRequest] = call(topics.ARM)
        mode: list[ModeRequest] = call(topics.SET_MODE)
        vehicle_command: list[VehicleCommandRequest] = call(topics.VEHICLE_COMMAND)
        preview: list[PreviewRequest] = call(topics.PREVIEW)
        set_mission: list[MissionRequest] = call(topics.SET_MISSION)
        set_fence: list[FenceRequest] = call(topics.SET_FENCE)
        set_rally: list[RallyRequest] = call(topics.SET_RALLY)
        current: list[SetCurrentRequest] = call(topics.SET_CURRENT)
        save_map: list[SaveMapRequest] = call(topics.SAVE_MAP)
        place: list[PlaceRequest] = call(topics.PLACE)
        mapping: list[MappingRequest] = call(topics.MAPPING)
        relocalize: list[RelocalizeRequest] = call(topics.RELOCALIZE)
        clock_request: list[ClockRequest] = call(topics.CLOCK_REQUEST)
        wind: list[WindRequest] = call(topics.WIND)
        launch: list[LaunchRequest] = call(topics.LAUNCH)

    def __init__(self, site: Scenario, page: Page, watch: BusWatch, exporter: Exporter, surveys: SurveyPlanner) -> None:
        self._page = page
        self._model = Model(site)
        self._exporter, self._surveys = exporter, surveys
        self._history = RecentHistory()
        self._logged = 0
        self._drawn = -ALONE_PERIOD
        time = TimeTravel(self._model, self._history, exporter)
        self._commander = Commander(self._model, time, surveys)
        self._listening = BusListening(self._model, watch)
        self._composer = Composer(self._model, self._commander.by_hand, TimeBar(self._history, exporter, time.models))

    def step(self, t: float, now: Inputs) -> Outputs:
        """One refresh of the page at ``t`` [s, wall]."""
        newest: Mapping[str, Mapping[str, Message]] = {name: getattr(now, name) for name in NEWEST}
        self._hear_system(t, now.clock, now.processes, now.health)
        self._model.tasks = now.tasks
        self._model.hear_windsocks(now.windsocks)
        self._hear_others(t, now.external, now.stop, (now.objects, now.aircraft), now.truth)
        self._keep(t, now, newest)
        self._model.hear_other_scans(now.other_scans)
        return self._act(t, newest, now.events, [one for name in self.calls for one in getattr(now, name)])

    def _hear_system(self, t: float, clock: Clock | None, processes: Sequence[Processes], health: Sequence[Health]) -> None:
        self._model.hear_clock(t, clock)
        self._model.processes.hear(t, processes)
        self._model.processes.hear_health(t, health)

    def _keep(self, t: float, now: Inputs, newest: Mapping[str, Mapping[str, Message]]) -> None:
        """For those who look back."""
        shown = self._model.vehicles.keys()
        for what, messages in (*newest.items(), (past.EXTERNAL, now.external)):
            self._history.hear(t, what, {name: message for name, message in messages.items() if name in shown})
        self._history.only(shown)
        objects = {(OBJECTS, "ground"): now.objects, (OBJECTS, "air"): now.aircraft}
        alone = {(CLOCK, ""): now.clock, (WINDSOCKS, ""): now.windsocks, **objects}
        for (what, name), message in alone.items():
            if message is not None:
                self._history.hear(t, what, {name: message})

    def _hear_others(
        self,
        t: float,
        external: Mapping[str, ExternalVehicle],
        stop: StopStatus,
        things: Sequence[SimObjects | None],
        truth: Mapping[str, NavState],
    ) -> None:
        self._model.hear_external_vehicles(t, external)
        self._model.hear_objects(things, truth)
        self._model.hear_stop(stop)

    def _act(
        self, t: float, newest: Mapping[str, Mapping[str, Any]], events: Mapping[str, Sequence[Event]], answers: Sequence[Answer[Any, Any]]
    ) -> Outputs:
        """Takes in what the vehicles say, does what people have asked on the page, and shows how things stand."""
        self._model.hear_newest(t, newest, events)
        for v in self._model.vehicles.values():
            if v.place is not None:
                self._history.go(t, v.name, v.place.position, v.track.spacing)
        self._commander.hear(t, answers)
        out = self._commander.act(t, self._page.actions())
        self._commander.expire(t)
        self._commander.advance()
        self._listening.step(t)
        self._history.note(t, self._model.log.since(self._logged))
        self._logged = self._model.log.count
        self._commander.time.step(t)
        if self._model.sessions or t >= self._drawn + ALONE_PERIOD:
            self._drawn = t
            self._page.show(self._composer.picture(t))
        outputs = self.Outputs()
        outputs.update(out.said())
        return outputs

    def close(self) -> None:
        """Stops the page's server and the watch."""
        self._listening.close()
        self._exporter.close()
        self._surveys.close()
        self._page.close()
