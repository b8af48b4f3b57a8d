"""What the ground station knows: the newest message of each kind, when it came, and what follows from them."""

from collections.abc import Mapping, Sequence, Set

import numpy as np
from google.protobuf.message import Message
from numpy.typing import NDArray

from schemas.messages import (
    Clock,
    Event,
    ExternalVehicle,
    FrameTransforms,
    LaserScan,
    NavState,
    Odometry,
    SimObject,
    SimObjects,
    StopEngagement,
    Tasks,
)
from schemas.topics import SYSTEM
from services.gcs.state.control import ControlBook
from services.gcs.state.event_log import EventHistory, EventLine
from services.gcs.state.external_vehicles import FORGOTTEN_AFTER, ExternalVehicles
from services.gcs.state.graph.graph_book import GraphBook
from services.gcs.state.plots.plot_series import PlotBook
from services.gcs.state.process_book import ProcessBook
from services.gcs.state.refusals import PageRefusals
from services.gcs.state.session import SHOWN_AT_FIRST, BrowserSession
from services.gcs.state.vehicle_model import SIGNS_OF_LIFE, Order, VehicleModel, scan_in_world, track_of
from uvf.models.mission.file import StartPose, Vehicle
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import seconds, wxyz
from uvf.runtime.messages.maps.mapped_floor import MappedFloor
from uvf.runtime.messages.spawned import SPAWNED_MOST, name_fault, object_fault
from uvf.runtime.state.stop_all import StopStatus, name_of, told

Floats = NDArray[np.float64]

GONE_AFTER = 5.0  # s: a page that has shown nothing new for so long has nobody before it
MOST_VEHICLES = 64
UNIT = 1e-3  # by which a rotation's length may be off
LONGEST_TEXT = 500  # letters of an event or of what an external vehicle says of itself
SHOWN_BY_THE_CLOCK = ("conductor",)
"""Sources whose warnings tell of a state that the page reads from the clock: they stand in the log, not as notices."""
COLOURS = ("#4ea1ff", "#f2913d", "#3fbf7f", "#b98cf5", "#e8c547", "#5fd4d6")
"""Vehicles' own colours, told apart by colour-blind people too; red and magenta keep their meanings."""


class Model:
    """All vehicles of a mission, the clock, the log, and what each browser has chosen."""

    def __init__(self, site: Scenario) -> None:
        self.site = site
        self.vehicles: dict[str, VehicleModel] = {}
        for name, member in sorted(site.members.items()):
            self._add(name, member)
        self.sessions: dict[int, BrowserSession] = {}
        """Of each browser that is connected."""
        self.wall = 0.0
        """Time of this step [s, wall]."""
        self.control = ControlBook()
        self.order: Order | None = None
        """The last request to the system, and its outcome."""
        self.clock: Clock | None = None
        self.clock_at: float | None = None
        self.tasks: Tasks | None = None
        """How far those of the mission are; None where it has none."""
        self.stop = StopStatus()
        self.log = EventHistory()
        self._floors = {v.name: MappedFloor(site.world, v.member) for v in self.vehicles.values() if not v.flies}
        self.spawned: Sequence[SimObject] = ()
        """What has been put into the running simulation."""
        self.strangers: Mapping[str, NavState] = {}
        """True motion of the vehicles among it."""
        self.refused = PageRefusals(self._warn)
        self.processes = ProcessBook(self.refused)
        self.graph = GraphBook(self.processes, self.refused)
        self.windsocks: Mapping[str, Floats] = {}
        """Where those of the world point: attitudes wxyz (4,), world from sock."""
        self._external = ExternalVehicles()
        self.plots = PlotBook()

    def _add(self, name: str, member: MissionVehicle) -> None:
        colour = COLOURS[len(self.vehicles) % len(COLOURS)]
        self.vehicles[name] = VehicleModel(name, member, colour, track_of(member))

    def join(self, page: int) -> None:
        """Notes a browser that has connected; it shows a ground vehicle at first, if there is one."""
        grounded = [v.name for v in self.vehicles.values() if not v.flies]
        self.sessions[page] = BrowserSession(page, next(iter(grounded or self.vehicles), ""))

    @property
    def layers(self) -> Set[str]:
        """The layers that any browser shows; without a browser, those shown at first."""
        return frozenset().union(*(session.layers for session in self.sessions.values())) if self.sessions else SHOWN_AT_FIRST

    def chosen_by(self, session: BrowserSession) -> VehicleModel | None:
        """The vehicle that a browser shows; None while no vehicle is known."""
        if session.vehicle not in self.vehicles:
            session.vehicle = next(iter(self.vehicles), "")
        return self.vehicles.get(session.vehicle)

    @property
    def present(self) -> Set[str]:
        """The operators whose pages are connected and show what happens."""
        return {s.operator for s in self.sessions.values() if s.operator and s.behind(self.wall) <= GONE_AFTER}

    @property
    def stopped(self) -> bool:
        """Whether STOP ALL is engaged, by a command or as a vehicle reports it."""
        return bool(self.stop) or any(v.stopped for v in self.vehicles.values())

    @property
    def stops(self) -> list[StopEngagement]:
        """All engagements of STOP ALL that are known here or reported by a vehicle."""
        reported = [one for v in self.vehicles.values() if v.status is not None for one in v.status.stops]
        return list({name_of(one): one for one in (*reported, *self.stop.engagements)}.values())

    @property
    def sim_time(self) -> float:
        """Simulation time [s]; 0 before the first clock message."""
        return self.clock.t_ns * 1e-9 if self.clock is not None else 0.0

    def hear_newest(self, t: float, newest: Mapping[str, Mapping[str, Message]], events: Mapping[str, Sequence[Event]]) -> None:
        """Takes the messages of a step at ``t`` [s, wall]. newest: by kind, then by vehicle; events: by vehicle."""
        for what, messages in newest.items():
            self.hear(t, what, messages)
        self.hear_events(t, events)

    def hear(self, t: float, what: str, messages: Mapping[str, Message]) -> None:
        """Takes the newest message of one kind of each vehicle at ``t`` [s, wall]; one that is not new is ignored."""
        for name, message in messages.items():
            vehicle = self.vehicles.get(name)
            if vehicle is None:
                self._external.hear(what, name, message)
                continue
            if getattr(vehicle, what) is message:
                continue
            setattr(vehicle, what, message)
            vehicle.heard_at[what] = t
            if isinstance(message, NavState if vehicle.flies else Odometry) and what != "truth":
                vehicle.trends.hear(t, message)
            if what in ("nav", "pose") and vehicle.place is not None:
                vehicle.track.add(vehicle.place.position)
            elif what == "scan":
                vehicle.scan_points = scan_in_world(vehicle, vehicle.scan, vehicle.member.file.sensors.lidar)
            elif what == "grid" and not vehicle.flies:
                floor = self._floors.get(name)
                vehicle.mapped = floor.share(vehicle.grid) if floor and vehicle.grid and vehicle.grid.column_count else None

    def hear_other_scans(self, by_vehicle: Mapping[str, Sequence[LaserScan]]) -> None:
        """Takes the scans of the vehicles' further lidars."""
        for name, scans in by_vehicle.items():
            vehicle = self.vehicles.get(name)
            lidars = {f"{name}/{lidar.frame}": lidar for lidar in vehicle.member.file.sensors.other_lidars} if vehicle is not None else {}
            for scan in scans:
                if vehicle is not None and scan.frame_id in lidars:
                    vehicle.other_scans[scan.frame_id] = scan, scan_in_world(vehicle, scan, lidars[scan.frame_id])

    def hear_clock(self, t: float, clock: Clock | None) -> None:
        """Takes the clock message at ``t`` [s, wall]; a new epoch clears tracks and goals."""
        self.wall = t
        if clock is None or clock is self.clock:
            return
        if self.clock is not None and clock.epoch != self.clock.epoch:
            for vehicle in self.vehicles.values():
                vehicle.track.clear()
                vehicle.goal_asked = None
            self.note("", "the simulation has started afresh")
        self.clock, self.clock_at = clock, t

    def hear_stop(self, stop: StopStatus) -> None:
        """Logs who engages STOP ALL, and who has released the last engagement."""
        before, self.stop = self.stop, stop
        known = {name_of(one) for one in before.engagements}
        for one in stop.engagements:
            if name_of(one) not in known:
                self.note("", f"STOP ALL engaged by {told([one])}", Event.WARNING)
        if before and not stop:
            self.note("", f"STOP ALL released by {stop.released_by or 'somebody unnamed'}", Event.NOTICE)

    def hear_objects(self, lists: Sequence[SimObjects | None], truth: Mapping[str, NavState]) -> None:
        """Takes the objects spawned in each simulator (``lists``) and the true motion of the vehicles among them."""
        told = (thing for one in lists if one is not None for thing in one.objects)
        self.spawned = [thing for thing in told if self._is_sound(thing)][:SPAWNED_MOST]
        self.strangers = {name: state for name, state in truth.items() if name not in self.vehicles}

    def hear_windsocks(self, told: FrameTransforms | None) -> None:
        """Takes where the windsocks of the world point; others, and what is no attitude, are ignored."""
        known = {sock.name for sock in self.site.world.windsocks}
        here = {one.child_frame_id: wxyz(one.rotation) for one in (told.transforms if told is not None else ())}
        self.windsocks = {name: at for name, at in here.items() if name in known and abs(np.linalg.norm(at) - 1) < UNIT}

    def is_external(self, name: str) -> bool:
        """Whether no mission names the vehicle."""
        return name not in self.site.members

    def hear_external_vehicles(self, t: float, announced: Mapping[str, ExternalVehicle]) -> None:
        """Takes announcements of external vehicles at ``t`` [s, wall]; an external vehicle is shown once its model is known."""
        strangers = [(name, external) for name, external in announced.items() if name not in self.vehicles]
        lost = self._lost_guests(t) if strangers else []
        for name, external in strangers:
            if not self._external.is_away(name, external) and self._is_name(name):
                self._meet(t, name, external, lost)

    def _meet(self, t: float, name: str, external: ExternalVehicle, lost: list[str]) -> None:
        """Takes an external vehicle in, in the place of one of the lost if there is no other, or turns it away.

        Its model is one of those in ``vehicles/``, never a path.
        """
        is_full = len(self.vehicles) >= MOST_VEHICLES
        if is_full and not lost:
            self.refused.add("vehicles", name, f"more than {MOST_VEHICLES} vehicles are on the bus: not all are shown")
            return
        try:
            file = load_vehicle(self.site.vehicles_folder, model_name(external.model))
        except BadInput as error:
            if self._external.turn_away(name, external.model):
                self._warn(f"'{name}' cannot be shown: {error}")
            return
        if is_full:
            self._forget(lost.pop())
        self._external.take_in(t, name, external)
        entry = Vehicle(model=external.model, start=StartPose(x=0.0, y=0.0), system_id=1)
        self._add(name, MissionVehicle(name, entry, file, self.site.vehicles_folder / external.model))
        self.note(name, f"external vehicle: {external.about[:LONGEST_TEXT]}", Event.NOTICE)

    def _lost_guests(self, t: float) -> list[str]:
        """Those that may be forgotten, the longest lost last. None that a browser shows; by hand only the mission's own are driven."""
        chosen = {session.vehicle for session in self.sessions.values()}
        heard = {name: self.vehicles[name].heard or met for name, (met, _) in self._external.met.items() if name not in chosen}
        return sorted((name for name, at in heard.items() if t - at > FORGOTTEN_AFTER), key=heard.__getitem__, reverse=True)

    def _forget(self, name: str) -> None:
        gone = self.vehicles.pop(name)
        self._external.forget(name, {what: getattr(gone, what) for what in SIGNS_OF_LIFE})
        self.note(name, "nothing has been heard of it for long: shown no more, to make room for another external vehicle")

    def _is_sound(self, thing: SimObject) -> bool:
        if not self._is_name(thing.name):
            return False
        if why := object_fault(thing):
            self.refused.add("objects", thing.name, f"something on the bus is not shown: {why}")
        return not why

    def _is_name(self, name: str) -> bool:
        """What may stand for a vehicle or an object: those of the mission, and what is spelt like them."""
        fault = "" if name in self.vehicles else name_fault(name)
        if fault:
            self.refused.add("names", name, f"something on the bus is not shown: {fault}")
        return not fault

    def _warn(self, text: str) -> None:
        self.note("", text[:LONGEST_TEXT], Event.WARNING)

    def hear_events(self, t: float, by_vehicle: Mapping[str, Sequence[Event]]) -> None:
        """Logs the vehicles' events, and shows warnings from ``t`` [s, wall] on."""
        for name, events in by_vehicle.items():
            if name != SYSTEM and not self._is_name(name):
                continue
            for event in events:
                cause = f" ({event.cause})" if event.cause else ""
                text = f"{event.text}{cause}"[:LONGEST_TEXT]
                line = EventLine(seconds(event.timestamp), event.severity, "" if name == SYSTEM else name, text)
                self.log.write(line)
                if line.severity >= Event.WARNING and event.source not in SHOWN_BY_THE_CLOCK:
                    self.log.tell(t, line)

    def note(self, vehicle: str, text: str, severity: int = Event.INFO, of_operator: bool = False) -> EventLine:
        """Writes the ground station's own line into the log."""
        line = EventLine(self.sim_time, severity, vehicle, text, of_operator)
        self.log.write(line)
        return line


def model_name(told: str) -> str:
    """The name of a folder in ``vehicles/`` that an external vehicle gives. Raises BadInput when it cannot be one."""
    if fault := name_fault(told):
        raise BadInput(f"its model: {fault}")
    return told
