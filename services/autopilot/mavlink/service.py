"""MAVLink for every vehicle of the mission: the services' messages out to ground stations, their wishes in as requests."""

from collections.abc import Mapping, Sequence
from typing import Any

from google.protobuf.message import Message

from schemas import topics
from schemas.messages import (
    AirData,
    ArmRequest,
    Battery,
    Clock,
    DriveCommand,
    EstimateQuality,
    Event,
    Fence,
    FenceRequest,
    FlightSetpoint,
    Gnss,
    GoalRequest,
    GoAroundRequest,
    Imu,
    Link,
    Mission,
    MissionProgress,
    MissionRequest,
    ModeRequest,
    NavState,
    NavStatus,
    OrbitRequest,
    ParamReply,
    ParamRequest,
    ParamValues,
    RallyPoints,
    RallyRequest,
    Reply,
    SetCurrentRequest,
    SurfaceCommand,
    Targets,
    VehicleCommandRequest,
    VehicleStatus,
    WheelCommand,
)
from services.autopilot.mavlink.connection.facts import VehicleInfo
from services.autopilot.mavlink.connection.signing import Signing
from services.autopilot.mavlink.connection.targets import Reserved
from services.autopilot.mavlink.parameters.parameter_store import Store
from services.autopilot.mavlink.reception import Reception
from services.autopilot.mavlink.vehicle_link import VehicleLink
from uvf.mavlink import endpoint
from uvf.mavlink.codec import Codec
from uvf.runtime.contract.declaration import Reads, Writes, answers, call, each_vehicle, every, optional, topic
from uvf.runtime.contract.service import Answer, Service
from uvf.runtime.messages.convert import stamp
from uvf.sensors.sampling import Due

Answers = list[Answer[Any, Any]]


NEWS = (
    "nav",
    "status",
    "gnss",
    "battery",
    "imu",
    "air_data",
    "surface_command",
    "wheel_command",
    "targets",
    "quality",
    "planning",
    "params",
    "mission",
    "progress",
    "fence",
    "rally",
)
"""Inputs by vehicle that are kept under their names as the newest of their kind."""


class MavlinkService(Service):
    """MAVLink for all vehicles. It runs on wall time: heartbeats, answers and timers go on while the simulation is slow or paused."""

    name = "mavlink"
    hz = 50.0
    scope = "world"
    clock = "wall"

    class Inputs(Reads):
        """Messages of the vehicles, and answers to requests."""

        nav: dict[str, NavState] = each_vehicle(topics.NAV_STATE)
        status: dict[str, VehicleStatus] = each_vehicle(topics.STATUS)
        mission: dict[str, Mission] = each_vehicle(topics.MISSION)
        progress: dict[str, MissionProgress] = each_vehicle(topics.PROGRESS)
        fence: dict[str, Fence] = each_vehicle(topics.FENCE)
        rally: dict[str, RallyPoints] = each_vehicle(topics.RALLY)
        gnss: dict[str, Gnss] = each_vehicle(topics.GNSS)
        battery: dict[str, Battery] = each_vehicle(topics.BATTERY)
        imu: dict[str, Imu] = each_vehicle(topics.IMU)
        air_data: dict[str, AirData] = each_vehicle(topics.AIR_DATA)
        surface_command: dict[str, SurfaceCommand] = each_vehicle(topics.SURFACE_COMMAND)
        wheel_command: dict[str, WheelCommand] = each_vehicle(topics.WHEEL_COMMAND)
        targets: dict[str, Targets] = each_vehicle(topics.TARGETS)
        quality: dict[str, EstimateQuality] = each_vehicle(topics.QUALITY)
        planning: dict[str, NavStatus] = each_vehicle(topics.NAV_STATUS)
        events: dict[str, list[Event]] = each_vehicle(every(topics.EVENTS.by("*")))
        params: dict[str, ParamValues] = each_vehicle(topics.PARAMS.by("*"))
        clock: Clock | None = optional(topics.CLOCK)
        arm: list[Answer[ArmRequest, Reply]] = answers(topics.ARM)
        set_mode: list[Answer[ModeRequest, Reply]] = answers(topics.SET_MODE)
        set_mission: list[Answer[MissionRequest, Reply]] = answers(topics.SET_MISSION)
        set_current: list[Answer[SetCurrentRequest, Reply]] = answers(topics.SET_CURRENT)
        set_fence: list[Answer[FenceRequest, Reply]] = answers(topics.SET_FENCE)
        set_rally: list[Answer[RallyRequest, Reply]] = answers(topics.SET_RALLY)
        goal: list[Answer[GoalRequest, Reply]] = answers(topics.GOAL)
        orbit: list[Answer[OrbitRequest, Reply]] = answers(topics.ORBIT)
        go_around: list[Answer[GoAroundRequest, Reply]] = answers(topics.GO_AROUND)
        order: list[Answer[VehicleCommandRequest, Reply]] = answers(topics.VEHICLE_COMMAND)
        air_param: list[Answer[ParamRequest, ParamReply]] = answers(topics.PARAM.by("autopilot_air"))
        ground_param: list[Answer[ParamRequest, ParamReply]] = answers(topics.PARAM.by("autopilot_ground"))

    class Outputs(Writes):
        """Commands and requests to the vehicles."""

        drive: dict[str, DriveCommand] | None = topic(topics.DRIVE.by("mavlink"))
        surfaces: dict[str, SurfaceCommand] | None = topic(topics.SURFACES.by("mavlink"))
        setpoint: dict[str, FlightSetpoint] | None = topic(topics.SETPOINT.by("mavlink"))
        link: dict[str, Link] | None = topic(topics.LINK)
        arm: list[ArmRequest] = call(topics.ARM)
        set_mode: list[ModeRequest] = call(topics.SET_MODE)
        set_mission: list[MissionRequest] = call(topics.SET_MISSION)
        set_current: list[SetCurrentRequest] = call(topics.SET_CURRENT)
        set_fence: list[FenceRequest] = call(topics.SET_FENCE)
        set_rally: list[RallyRequest] = call(topics.SET_RALLY)
        goal: list[GoalRequest] = call(topics.GOAL)
        orbit: list[OrbitRequest] = call(topics.ORBIT)
        go_around: list[GoAroundRequest] = call(topics.GO_AROUND)
        order: list[VehicleCommandRequest] = call(topics.VEHICLE_COMMAND)
        air_param: list[ParamRequest] = call(topics.PARAM.by("autopilot_air"))
        ground_param: list[ParamRequest] = call(topics.PARAM.by("autopilot_ground"))

    def __init__(
        self,
        facts: Sequence[VehicleInfo],
        link: endpoint.DatagramLink,
        stores: Mapping[str, Store],
        signing: Signing | None = None,
        reserved: Reserved | None = None,
    ) -> None:
        """stores: by vehicle, where what is set over MAVLink is remembered."""
        self.codec = Codec()
        self._link = link
        self._vehicles = {one.name: VehicleLink(one, stores[one.name]) for one in facts}
        self._signing = signing or Signing()
        self._reserved = reserved or {}
        self._reception = Reception(list(self._vehicles.values()), link, self._signing, self._reserved)
        for name, vehicle in self._vehicles.items():
            vehicle.line.alone = [peer for peer, system in self._reserved.items() if system == vehicle.line.facts.system_id]
            vehicle.line.latest.others = [(v.line.facts, v.line.latest) for other, v in self._vehicles.items() if other != name]
        self._link_due = Due(topics.LINK.hz)

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s]: wall time since the start; answers end the commands that wait for them."""
        self._update(t, {name: getattr(now, name) for name in NEWS}, now.clock)
        for called in self.calls:
            for answer in getattr(now, called):
                self._vehicles[answer.vehicle].line.answered(answer)
        for datagram, peer in self._link.receive(t):
            for message in self.codec.parse(datagram):
                self._reception.take(t, message, peer)
        self._speak(t, now.events)
        out = self._outputs()
        out.link = self._links(t)
        return out

    def close(self) -> None:
        """Closes the UDP link."""
        self._link.close()

    def _update(self, t: float, news: Mapping[str, Mapping[str, Message]], clock: Clock | None) -> None:
        for name, vehicle in self._vehicles.items():
            vehicle.line.t = t
            vehicle.line.latest.clock = clock
            for what, by_vehicle in news.items():
                if name in by_vehicle:
                    setattr(vehicle.line.latest, what, by_vehicle[name])
            if name in news["imu"]:
                vehicle.line.latest.vibration.hear(news["imu"][name])  # type: ignore[arg-type]

    def _speak(self, t: float, events: Mapping[str, Sequence[Event]]) -> None:
        peers = self._link.peers(t)
        self.codec.forget(peers)
        for name, vehicle in self._vehicles.items():
            vehicle.forget(peers)
            system_id = vehicle.line.facts.system_id
            listening = [peer for peer in peers if self._reserved.get(peer, system_id) == system_id]
            for message, to in vehicle.tick(listening, events.get(name, ())):
                for packet, peer in self.codec.packets(system_id, message, [(p, self._signing.signer(t, p)) for p in to]):
                    self._link.send(packet, peer)

    def _links(self, t: float) -> dict[str, Link]:
        """Told of every vehicle alike: a station hears them all."""
        if not self._link_due.at(t):
            return {}
        self._reception.forget(t)
        count, silence = self._reception.stations.count(t), self._reception.stations.silence(t)
        links = {}
        for name, vehicle in self._vehicles.items():
            latest = vehicle.line.latest
            rate = latest.clock.rate if latest.clock is not None else 1.0
            links[name] = Link(timestamp=stamp(latest.sim_time), stations=count, silence=silence, rate=rate, port=self._link.port)
        return links

    def _outputs(self) -> Outputs:
        out = self.Outputs()
        for name, vehicle in self._vehicles.items():
            asked: dict[str, list[Message]] = {}
            for service, message in vehicle.line.take_requests():
                asked.setdefault(service, []).append(message)
            for called, messages in asked.items():
                out.add(called, name, messages)
            for output, command in vehicle.line.commands.items():
                out.add(output, name, command)
            vehicle.line.commands.clear()
        return out
