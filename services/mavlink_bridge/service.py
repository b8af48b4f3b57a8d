"""A vehicle that a MAVLink autopilot flies elsewhere: its state onto the bus, what the bus asks of it to the autopilot."""

from collections.abc import Sequence
from typing import Any

from google.protobuf.message import Message

from schemas import topics
from schemas.messages import (
    ArmRequest,
    Battery,
    CancelRequest,
    Clock,
    Event,
    ExternalVehicle,
    Fence,
    FenceRequest,
    FrameTransform,
    Gnss,
    GoalRequest,
    GoAroundRequest,
    Mission,
    MissionProgress,
    MissionRequest,
    ModeRequest,
    NavState,
    OrbitRequest,
    ParamReply,
    ParamRequest,
    Pose,
    PoseInFrame,
    RallyPoints,
    RallyRequest,
    Reply,
    SetCurrentRequest,
    Vector3,
    VehicleCommandRequest,
    VehicleStatus,
)
from services.mavlink_bridge.autopilot import Autopilot
from services.mavlink_bridge.frame import BridgeOrigin
from services.mavlink_bridge.requests import Requests
from services.mavlink_bridge.station import Station
from services.mavlink_bridge.stopping import Stopping
from uvf.mavlink.names import enum_name
from uvf.runtime.contract.declaration import Reads, Writes, optional, replies, request, stop_all, topic
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import stamp
from uvf.runtime.state.stop_all import StopStatus
from uvf.sensors.sampling import Due

SOURCE = "mavlink_bridge"
Asked = Sequence[Any]


class BridgedVehicle(Service):
    """A vehicle with an autopilot at the far end.

    It runs on wall time, as its autopilot does; stamps are simulation time where there is a clock, else time since the start.
    """

    name = "mavlink_bridge"
    hz = 50.0
    clock = "wall"

    class Inputs(Reads):
        """Requests, STOP ALL and the clock."""

        clock: Clock | None = optional(topics.CLOCK)
        stop: StopStatus = stop_all()
        arm: list[ArmRequest] = request(topics.ARM)
        set_mode: list[ModeRequest] = request(topics.SET_MODE)
        set_mission: list[MissionRequest] = request(topics.SET_MISSION)
        set_current: list[SetCurrentRequest] = request(topics.SET_CURRENT)
        set_fence: list[FenceRequest] = request(topics.SET_FENCE)
        set_rally: list[RallyRequest] = request(topics.SET_RALLY)
        goal: list[GoalRequest] = request(topics.GOAL)
        orbit: list[OrbitRequest] = request(topics.ORBIT)
        go_around: list[GoAroundRequest] = request(topics.GO_AROUND)
        order: list[VehicleCommandRequest] = request(topics.VEHICLE_COMMAND)
        cancel: list[CancelRequest] = request(topics.CANCEL)
        param: list[ParamRequest] = request(topics.PARAM.by("autopilot"))

    class Outputs(Writes):
        """The vehicle's messages, and replies."""

        nav_state: NavState | None = topic(topics.NAV_STATE)
        pose: PoseInFrame | None = topic(topics.POSE)
        body_frame: FrameTransform | None = topic(topics.TF_BODY)
        status: VehicleStatus | None = topic(topics.STATUS)
        gnss: Gnss | None = topic(topics.GNSS)
        battery: Battery | None = topic(topics.BATTERY)
        mission: Mission | None = topic(topics.MISSION)
        fence: Fence | None = topic(topics.FENCE)
        rally: RallyPoints | None = topic(topics.RALLY)
        progress: MissionProgress | None = topic(topics.PROGRESS)
        events: list[Event] | None = topic(topics.EVENTS.by(SOURCE))
        external: ExternalVehicle | None = topic(topics.EXTERNAL_VEHICLE)
        arm: list[Reply] = replies(topics.ARM)
        set_mode: list[Reply] = replies(topics.SET_MODE)
        set_mission: list[Reply] = replies(topics.SET_MISSION)
        set_current: list[Reply] = replies(topics.SET_CURRENT)
        set_fence: list[Reply] = replies(topics.SET_FENCE)
        set_rally: list[Reply] = replies(topics.SET_RALLY)
        goal: list[Reply] = replies(topics.GOAL)
        orbit: list[Reply] = replies(topics.ORBIT)
        go_around: list[Reply] = replies(topics.GO_AROUND)
        order: list[Reply] = replies(topics.VEHICLE_COMMAND)
        cancel: list[Reply] = replies(topics.CANCEL)
        param: list[ParamReply] = replies(topics.PARAM.by("autopilot"))

    def __init__(self, vehicle: str, system: int, station: Station, origin: BridgeOrigin, external: ExternalVehicle) -> None:
        """external: how others may draw it."""
        self._vehicle = vehicle
        self._system, self._origin = system, origin
        self._station = station
        self._meet()
        self._stop = StopStatus()
        self._announced: ExternalVehicle | None = external
        self._epoch = 0
        self._status_due, self._progress_due = Due(topics.STATUS.hz), Due(topics.PROGRESS.hz)

    def _meet(self) -> None:
        """Begins with the autopilot that speaks there now."""
        heard = self._station.autopilots[self._system]
        self._identity = heard.identity
        self._autopilot = Autopilot(self._system, heard.component, heard.heartbeat, self._origin)
        self._requests = Requests(self._autopilot)
        self._stopping = Stopping(self._autopilot)

    def _meet_another(self, t: float) -> None:
        """Nothing that was meant for the one before goes to this one: its modes and parameters have other numbers."""
        before = self._autopilot
        before.give_up("another autopilot speaks with its id now")
        self._meet()
        self._autopilot.wire.t = t
        component, autopilot, type_ = self._identity
        firmware, kind = enum_name("MAV_AUTOPILOT", autopilot) or autopilot, enum_name("MAV_TYPE", type_) or type_
        words = f"system {self._system} is another autopilot now: {firmware}, {kind}, component {component}"
        self._autopilot.events = [*before.events, (Event.WARNING, words)]

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s]: wall time since the start."""
        sim_time = now.clock.t_ns * 1e-9 if now.clock is not None else t
        if now.clock is not None and now.clock.epoch != self._epoch:
            self._epoch = now.clock.epoch
            self._autopilot.plans.tell_again()
        if self._station.autopilots[self._system].identity != self._identity:
            self._meet_another(t)
        self._autopilot.step(t, self._station.fetch(self._system))
        self._stop = now.stop
        self._stopping.heed(now.stop)
        self._requests.stopped = now.stop.who
        replies = {name: [self._requests.ask(one) for one in getattr(now, name)] for name in self.requests}
        self._requests.tick()
        self._station.send(self._system, self._autopilot.wire.take_out())
        out = self.Outputs()
        out.update(replies)
        out.update(self._told(t, sim_time))
        return out

    def _told(self, t: float, now: float) -> dict[str, Any]:
        """What there is to say, each stamped with ``now`` [s]."""
        told: dict[str, Any] = dict(self._autopilot.plans.take_news())
        chart, telemetry = self._autopilot.chart, self._autopilot.telemetry
        if chart is not None and (nav := telemetry.nav(chart)) is not None:
            told["nav_state"] = nav
        told |= {name: message for name, message in (("gnss", telemetry.gnss()), ("battery", telemetry.battery())) if message is not None}
        if self._status_due.at(t):
            told["status"] = self._autopilot.status()
            told["status"].stopped = bool(self._stop)
            told["status"].stops.extend(self._stop.engagements)
        if self._progress_due.at(t) and (progress := self._autopilot.progress()) is not None:
            told["progress"] = progress
        if self._announced is not None:
            told["external"], self._announced = self._announced, None
        for message in told.values():
            message.timestamp.CopyFrom(stamp(now))
        if "nav_state" in told:
            told |= self._frames(told["nav_state"])
        return told | self._events(now)

    def _frames(self, nav: NavState) -> dict[str, Message]:
        """The same pose as displays take it."""
        pose = PoseInFrame(timestamp=nav.timestamp, frame_id="world", pose=Pose(position=nav.position, orientation=nav.orientation))
        child = f"{self._vehicle}/base_link"
        frame = FrameTransform(timestamp=nav.timestamp, parent_frame_id="world", child_frame_id=child, rotation=nav.orientation)
        frame.translation.CopyFrom(Vector3(x=nav.position.x, y=nav.position.y, z=nav.position.z))
        return {"pose": pose, "body_frame": frame}

    def _events(self, now: float) -> dict[str, list[Event]]:
        said, self._autopilot.events = self._autopilot.events, []
        events = [Event(timestamp=stamp(now), severity=severity, text=text, source=SOURCE) for severity, text in said]
        return {"events": events} if events else {}
