"""A vehicle that a MAVLink autopilot flies elsewhere: its state onto the bus, what the bus asks of it to the autopilot."""

from collections.abc import Sequence
from typing import Any

from google.protobuf.message import Message

from schemas import topics
from schemas.messages import (
    ArmRequest,
    CancelRequest,
    Clock,
    Event,
    FenceRequest,
    FrameTransform,
    GoalRequest,
    GoAroundRequest,
    Guest,
    MissionRequest,
    ModeRequest,
    NavState,
    OrbitRequest,
    OrderRequest,
    ParamRequest,
    Pose,
    PoseInFrame,
    RallyRequest,
    SetCurrentRequest,
    Vector3,
)
from services.mavlink_bridge.autopilot import Autopilot
from services.mavlink_bridge.frame import Origin
from services.mavlink_bridge.requests import Requests
from services.mavlink_bridge.station import Station
from services.mavlink_bridge.stopping import Stopping
from uvf.mavlink.names import enum_name
from uvf.runtime.contract.service import Later, Service, optional, stop_all
from uvf.runtime.messages.convert import stamp
from uvf.runtime.messages.outputs import Outputs
from uvf.runtime.state.stop_all import StopStatus
from uvf.sensors.sampling import Due

SOURCE = "mavlink_bridge"
Asked = Sequence[Any]


class BridgedVehicle(Service):
    """Runs on wall time, as its autopilot does; stamps are simulation time where somebody keeps it, else time since the start."""

    name = "mavlink_bridge"
    hz = 50.0
    clock = "wall"
    inputs = {"clock": optional(topics.CLOCK), "stop": stop_all()}
    outputs = {
        "nav_state": topics.NAV_STATE,
        "pose": topics.POSE,
        "body_frame": topics.TF_BODY,
        "status": topics.STATUS,
        "gnss": topics.GNSS,
        "battery": topics.BATTERY,
        "mission": topics.MISSION,
        "fence": topics.FENCE,
        "rally": topics.RALLY,
        "progress": topics.PROGRESS,
        "events": topics.EVENTS.by(SOURCE),
        "guest": topics.GUEST,
    }
    requests = {
        "arm": topics.ARM,
        "set_mode": topics.SET_MODE,
        "set_mission": topics.SET_MISSION,
        "set_current": topics.SET_CURRENT,
        "set_fence": topics.SET_FENCE,
        "set_rally": topics.SET_RALLY,
        "goal": topics.GOAL,
        "orbit": topics.ORBIT,
        "go_around": topics.GO_AROUND,
        "order": topics.ORDER,
        "cancel": topics.CANCEL,
        "param": topics.PARAM.by("autopilot"),
    }

    def __init__(self, vehicle: str, system: int, station: Station, origin: Origin, guest: Guest) -> None:
        """guest: how others may draw it."""
        self._vehicle = vehicle
        self._system, self._origin = system, origin
        self._station = station
        self._meet()
        self._stop = StopStatus()
        self._guest: Guest | None = guest
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

    def step(
        self,
        t: float,
        clock: Clock | None,
        stop: StopStatus,
        arm: Sequence[ArmRequest],
        set_mode: Sequence[ModeRequest],
        set_mission: Sequence[MissionRequest],
        set_current: Sequence[SetCurrentRequest],
        set_fence: Sequence[FenceRequest],
        set_rally: Sequence[RallyRequest],
        goal: Sequence[GoalRequest],
        orbit: Sequence[OrbitRequest],
        go_around: Sequence[GoAroundRequest],
        order: Sequence[OrderRequest],
        cancel: Sequence[CancelRequest],
        param: Sequence[ParamRequest],
    ) -> Outputs:
        """``t`` [s]: wall time since the start."""
        now = clock.t_ns * 1e-9 if clock is not None else t
        if clock is not None and clock.epoch != self._epoch:
            self._epoch = clock.epoch
            self._autopilot.plans.tell_again()
        if self._station.autopilots[self._system].identity != self._identity:
            self._meet_another(t)
        self._autopilot.step(t, self._station.fetch(self._system))
        self._stop = stop
        self._stopping.heed(stop)
        self._requests.stopped = stop.who
        asked: dict[str, Asked] = {"arm": arm, "set_mode": set_mode, "set_mission": set_mission, "set_current": set_current}
        asked |= {"set_fence": set_fence, "set_rally": set_rally, "goal": goal, "orbit": orbit, "go_around": go_around}
        asked |= {"order": order, "cancel": cancel, "param": param}
        replies: dict[str, list[Later[Any]]] = {name: [self._requests.ask(one) for one in each] for name, each in asked.items()}
        self._requests.tick()
        self._station.send(self._system, self._autopilot.wire.take_out())
        return {**replies, **self._told(t, now)}

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
        if self._guest is not None:
            told["guest"], self._guest = self._guest, None
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
