"""MAVLink for every vehicle of the mission: the services' messages out to ground stations, their wishes in as requests."""

from collections.abc import Mapping, Sequence
from typing import Any

from google.protobuf.message import Message

from schemas import topics
from schemas.messages import (
    AirData,
    Battery,
    Clock,
    EstimateQuality,
    Event,
    Fence,
    Gnss,
    Imu,
    Link,
    Mission,
    MissionProgress,
    NavState,
    NavStatus,
    ParamValues,
    RallyPoints,
    SurfaceCommand,
    Targets,
    VehicleStatus,
    WheelCommand,
)
from services.autopilot.mavlink.connection.facts import Facts
from services.autopilot.mavlink.connection.signing import Signing
from services.autopilot.mavlink.connection.targets import Reserved
from services.autopilot.mavlink.parameters.parameter_store import Store
from services.autopilot.mavlink.reception import Reception
from services.autopilot.mavlink.vehicle_link import VehicleLink
from uvf.mavlink import endpoint
from uvf.mavlink.codec import Codec
from uvf.runtime.contract.service import Answer, Service, each_vehicle, every, optional
from uvf.runtime.messages.convert import stamp
from uvf.runtime.messages.outputs import Outputs
from uvf.sensors.sampling import Due

Answers = list[Answer[Any, Any]]


class MavlinkService(Service):
    """Runs on wall time: heartbeats, answers and timers go on while the simulation is slow or paused."""

    name = "mavlink"
    hz = 50.0
    scope = "world"
    clock = "wall"
    inputs = {
        "nav": each_vehicle(topics.NAV_STATE),
        "status": each_vehicle(topics.STATUS),
        "mission": each_vehicle(topics.MISSION),
        "progress": each_vehicle(topics.PROGRESS),
        "fence": each_vehicle(topics.FENCE),
        "rally": each_vehicle(topics.RALLY),
        "gnss": each_vehicle(topics.GNSS),
        "battery": each_vehicle(topics.BATTERY),
        "imu": each_vehicle(topics.IMU),
        "air_data": each_vehicle(topics.AIR_DATA),
        "surface_command": each_vehicle(topics.SURFACE_COMMAND),
        "wheel_command": each_vehicle(topics.WHEEL_COMMAND),
        "targets": each_vehicle(topics.TARGETS),
        "quality": each_vehicle(topics.QUALITY),
        "planning": each_vehicle(topics.NAV_STATUS),
        "events": each_vehicle(every(topics.EVENTS.by("*"))),
        "params": each_vehicle(topics.PARAMS.by("*")),
        "clock": optional(topics.CLOCK),
    }
    outputs = {
        "drive": topics.DRIVE.by("mavlink"),
        "surfaces": topics.SURFACES.by("mavlink"),
        "setpoint": topics.SETPOINT.by("mavlink"),
        "link": topics.LINK,
    }
    calls = {
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
        "air_param": topics.PARAM.by("autopilot_air"),
        "ground_param": topics.PARAM.by("autopilot_ground"),
    }

    def __init__(
        self,
        facts: Sequence[Facts],
        link: endpoint.Link,
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

    def step(
        self,
        t: float,
        nav: dict[str, NavState],
        status: dict[str, VehicleStatus],
        mission: dict[str, Mission],
        progress: dict[str, MissionProgress],
        fence: dict[str, Fence],
        rally: dict[str, RallyPoints],
        gnss: dict[str, Gnss],
        battery: dict[str, Battery],
        imu: dict[str, Imu],
        air_data: dict[str, AirData],
        surface_command: dict[str, SurfaceCommand],
        wheel_command: dict[str, WheelCommand],
        targets: dict[str, Targets],
        quality: dict[str, EstimateQuality],
        planning: dict[str, NavStatus],
        events: dict[str, list[Event]],
        params: dict[str, ParamValues],
        clock: Clock | None,
        arm: Answers,
        set_mode: Answers,
        set_mission: Answers,
        set_current: Answers,
        set_fence: Answers,
        set_rally: Answers,
        goal: Answers,
        orbit: Answers,
        go_around: Answers,
        order: Answers,
        air_param: Answers,
        ground_param: Answers,
    ) -> Outputs:
        """``t`` [s]: wall time since the start; answers end the commands that wait for them."""
        news: dict[str, Mapping[str, Message]] = {
            "nav": nav,
            "status": status,
            "gnss": gnss,
            "battery": battery,
            "imu": imu,
            "air_data": air_data,
            "surface_command": surface_command,
            "wheel_command": wheel_command,
            "targets": targets,
            "quality": quality,
            "planning": planning,
            "params": params,
        }
        news |= {"mission": mission, "progress": progress, "fence": fence, "rally": rally}
        self._update(t, news, clock)
        plans = (*set_mission, *set_current, *set_fence, *set_rally)
        for answer in (*arm, *set_mode, *plans, *goal, *orbit, *go_around, *order, *air_param, *ground_param):
            self._vehicles[answer.vehicle].line.answered(answer)
        for datagram, peer in self._link.receive(t):
            for message in self.codec.parse(datagram):
                self._reception.take(t, message, peer)
        self._speak(t, events)
        return {**self._outputs(), **self._links(t)}

    def close(self) -> None:
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

    def _links(self, t: float) -> Outputs:
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
        return {"link": links}

    def _outputs(self) -> Outputs:
        outputs: dict[str, dict[str, Any]] = {}
        for name, vehicle in self._vehicles.items():
            for call, request in vehicle.line.take_requests():
                outputs.setdefault(call, {}).setdefault(name, []).append(request)
            for output, command in vehicle.line.commands.items():
                outputs.setdefault(output, {})[name] = command
            vehicle.line.commands.clear()
        return outputs
