"""The ground station: what all vehicles say onto a page, what people ask on the page to the vehicles."""

from collections.abc import Mapping, Sequence
from typing import Any

from google.protobuf.message import Message

from schemas import topics
from schemas.messages import (
    Clock,
    CompressedImage,
    Event,
    Fence,
    FrameTransform,
    Grid,
    Guest,
    Health,
    JointStates,
    LaserScan,
    Mission,
    MissionProgress,
    NavState,
    NavStatus,
    Odometry,
    PoseInFrame,
    PosesInFrame,
    Processes,
    SimObjects,
    VehicleStatus,
)
from services.gcs.commands import SOURCE, Commander
from services.gcs.page.page_frame import Composer
from services.gcs.state.state import Model
from services.gcs.view.drawing import Page
from uvf.models.scenario import Site
from uvf.runtime.contract.service import Answer, Service, each_vehicle, every, optional, stop_all
from uvf.runtime.messages.outputs import Outputs
from uvf.runtime.state.stop_all import StopStatus


class GroundStation(Service):
    """Shows the vehicles of one site on a page, and sends what is asked there."""

    name = "gcs"
    hz = 20.0
    scope = "world"
    clock = "wall"
    inputs = {
        "clock": optional(topics.CLOCK),
        "processes": optional(every(topics.PROCESSES.by("*"))),
        "objects": optional(topics.OBJECTS),
        "aircraft": optional(topics.AIR_OBJECTS),
        "health": optional(every(topics.HEALTH.by("*"))),
        "stop": stop_all(),
        "guests": each_vehicle(topics.GUEST),
        "nav": each_vehicle(topics.NAV_STATE),
        "pose": each_vehicle(topics.POSE),
        "odometry": each_vehicle(topics.ODOMETRY),
        "truth": each_vehicle(topics.TRUTH),
        "status": each_vehicle(topics.STATUS),
        "nav_status": each_vehicle(topics.NAV_STATUS),
        "path": each_vehicle(topics.PATH),
        "mission": each_vehicle(topics.MISSION),
        "progress": each_vehicle(topics.PROGRESS),
        "fence": each_vehicle(topics.FENCE),
        "scan": each_vehicle(topics.SCAN),
        "image": each_vehicle(topics.IMAGE),
        "chase": each_vehicle(topics.VIEW.by("chase")),
        "gimbal_view": each_vehicle(topics.VIEW.by("gimbal")),
        "gimbal_joints": each_vehicle(topics.GIMBAL_JOINTS),
        "joints": each_vehicle(topics.JOINTS),
        "grid": each_vehicle(topics.MAP),
        "team_map": each_vehicle(topics.TEAM_MAP),
        "world_from_map": each_vehicle(topics.TF_WORLD),
        "events": each_vehicle(every(topics.EVENTS.by("*"))),
    }
    outputs = {"stop": topics.STOP.by(SOURCE), "drive": topics.DRIVE.by(SOURCE), "gimbal": topics.GIMBAL.by(SOURCE)}
    calls = {"goal": topics.GOAL, "cancel": topics.CANCEL, "arm": topics.ARM, "mode": topics.SET_MODE}

    def __init__(self, site: Site, page: Page) -> None:
        self._page = page
        self._model = Model(site)
        self._commander = Commander(self._model)
        self._composer = Composer(self._model, self._commander)

    def step(
        self,
        t: float,
        clock: Clock | None,
        processes: Sequence[Processes],
        objects: SimObjects | None,
        aircraft: SimObjects | None,
        health: Sequence[Health],
        stop: StopStatus,
        events: Mapping[str, Sequence[Event]],
        goal: Sequence[Answer[Any, Any]],
        cancel: Sequence[Answer[Any, Any]],
        arm: Sequence[Answer[Any, Any]],
        mode: Sequence[Answer[Any, Any]],
        guests: Mapping[str, Guest],
        nav: Mapping[str, NavState],
        pose: Mapping[str, PoseInFrame],
        odometry: Mapping[str, Odometry],
        truth: Mapping[str, NavState],
        status: Mapping[str, VehicleStatus],
        nav_status: Mapping[str, NavStatus],
        path: Mapping[str, PosesInFrame],
        mission: Mapping[str, Mission],
        progress: Mapping[str, MissionProgress],
        fence: Mapping[str, Fence],
        scan: Mapping[str, LaserScan],
        image: Mapping[str, CompressedImage],
        chase: Mapping[str, CompressedImage],
        gimbal_view: Mapping[str, CompressedImage],
        gimbal_joints: Mapping[str, JointStates],
        joints: Mapping[str, JointStates],
        grid: Mapping[str, Grid],
        team_map: Mapping[str, Grid],
        world_from_map: Mapping[str, FrameTransform],
    ) -> Outputs:
        """One refresh of the page at ``t`` [s, wall]."""
        newest: Mapping[str, Mapping[str, Message]] = {
            "nav": nav,
            "pose": pose,
            "odometry": odometry,
            "truth": truth,
            "status": status,
            "nav_status": nav_status,
            "path": path,
            "mission": mission,
            "progress": progress,
            "fence": fence,
            "scan": scan,
            "image": image,
            "chase": chase,
            "gimbal": gimbal_view,
            "gimbal_joints": gimbal_joints,
            "joints": joints,
            "grid": grid,
            "team_map": team_map,
            "world_from_map": world_from_map,
        }
        self._hear_system(t, clock, processes, health)
        self._hear_others(t, guests, stop, (objects, aircraft), truth)
        return self._act(t, newest, events, (*goal, *cancel, *arm, *mode))

    def _hear_system(self, t: float, clock: Clock | None, processes: Sequence[Processes], health: Sequence[Health]) -> None:
        self._model.hear_clock(t, clock)
        self._model.processes.hear(t, processes)
        self._model.processes.hear_health(t, health)

    def _hear_others(
        self, t: float, guests: Mapping[str, Guest], stop: StopStatus, things: Sequence[SimObjects | None], truth: Mapping[str, NavState]
    ) -> None:
        self._model.hear_guests(t, guests)
        self._model.hear_objects(things, truth)
        self._model.hear_stop(stop)

    def _act(
        self, t: float, newest: Mapping[str, Mapping[str, Any]], events: Mapping[str, Sequence[Event]], answers: Sequence[Answer[Any, Any]]
    ) -> Outputs:
        """Takes in what the vehicles say, does what people have asked on the page, and shows how things stand."""
        self._model.hear_newest(t, newest, events)
        self._commander.hear(t, answers)
        out = self._commander.act(t, self._page.actions())
        self._commander.expire(t)
        self._page.show(self._composer.picture(t))
        return {name: getattr(out, name) for name in (*self.outputs, *self.calls)}

    def close(self) -> None:
        self._page.close()
