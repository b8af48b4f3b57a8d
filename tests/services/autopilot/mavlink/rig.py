"""The MAVLink service on a link in memory, with vehicles that answer its requests, and a ground station beside it."""

import json

import numpy as np

from schemas.messages import (
    Circle,
    Clock,
    Fence,
    Gnss,
    Kind,
    Mission,
    MissionProgress,
    Mode,
    NavState,
    ParamRequest,
    RallyPoints,
    Reply,
    Vector3,
    VehicleStatus,
)
from services.autopilot.ground.params import GroundAutopilotParams
from services.autopilot.mavlink.connection.facts import VehicleInfo
from services.autopilot.mavlink.parameters.parameter_store import UnreadableStore
from services.autopilot.mavlink.service import MavlinkService
from services.autopilot.parameter_state import ToldParams
from tests.runtime.stepping import stepped
from uvf.maths.geodesy import LocalTangent
from uvf.maths.rotations import from_euler
from uvf.mavlink import dialect as mav
from uvf.mavlink.endpoint import Callers
from uvf.models.vehicle.file import VehicleFile
from uvf.models.vehicle.flight_params import FIXED, AirParams
from uvf.models.yaml_data import convert
from uvf.runtime.contract.param_server import ParamServer
from uvf.runtime.contract.service import Answer, Service
from uvf.runtime.messages.convert import quaternion, stamp

PLANE, ROVER = 1, 2
GCS = ("127.0.0.1", 14550)
OTHER = ("127.0.0.1", 14540)
ORIGIN = LocalTangent.from_degrees(40.77, 14.79, 300.0)
DT = 0.02

_IMU = {"mount": {}, "hz": 100}
_PLANE_FILE = {
    "kind": "fixed_wing",
    "about": "test",
    "sensors": {
        "imu": _IMU,
        "gnss": {"hz": 5},
        "air_data": {"hz": 50},
        "camera": {"mount": {}, "hz": 5, "width": 64, "height": 48, "fov": 1.0},
    },
    "air": {
        "model": "x",
        "physics_hz": 100,
        "trim_speed": 25.0,
        "servo_rate": 5,
        "servo_lag": 0,
    },
}
_ROVER_FILE = {
    "kind": "ground",
    "about": "test",
    "sensors": {"imu": _IMU},
    "ground": {
        "urdf": "x",
        "drive": {"left": "l", "right": "r", "wheel_radius": 0.03, "track": 0.16},
        "radius": 0.15,
        "max_linear": 0.5,
        "max_angular": 2.0,
        "max_linear_acceleration": 1,
        "max_angular_acceleration": 1,
        "motor": {"stall_torque": 1, "no_load_speed": 100},
    },
}
_PLANE_PARAMS = AirParams(trim_airspeed=25.0, hold_radius=90.0, return_altitude=40.0)
PLANE_FACTS = VehicleInfo("plane", PLANE, convert(_PLANE_FILE, VehicleFile, "test"), ORIGIN, _PLANE_PARAMS, FIXED)


def rover_facts(**drive):
    """A rover with another drive, or other keys of it."""
    body = _ROVER_FILE["ground"]
    file = {**_ROVER_FILE, "ground": {**body, "drive": {**body["drive"], **drive}}}
    return VehicleInfo("rover", ROVER, convert(file, VehicleFile, "test"), ORIGIN, GroundAutopilotParams())


ROVER_FACTS = rover_facts()
CAR_FACTS = rover_facts(kind="ackermann", wheelbase=0.3, steered={"a": "b", "c": "d"}, max_steering=0.4, steering_rate=2.0)
MECANUM_FACTS = rover_facts(kind="mecanum", left=["a", "b"], right=["c", "d"], wheelbase=0.2)


class Shelf:
    """Remembers settings as a file does."""

    def __init__(self, **settings):
        self.settings = settings
        self.trouble = None

    def load(self):
        if isinstance(self.trouble, UnreadableStore):
            raise self.trouble
        return dict(self.settings)

    def save(self, settings):
        if isinstance(self.trouble, OSError):
            raise self.trouble
        self.settings = dict(settings)


def shelves():
    """One for each vehicle."""
    return {"plane": Shelf(), "rover": Shelf()}


class Autopilot(Service):
    """Only its parameters."""

    name = "autopilot"


class MemoryLink:
    """Datagrams in lists; two peers always listen."""

    port = 14600

    def __init__(self):
        self.incoming = []
        self.outgoing = []
        self.listening = [GCS, OTHER]
        self.callers = Callers()

    def receive(self, t):
        taken, self.incoming = self.incoming, []
        return taken

    def peers(self, t):
        return [*self.listening, *self.callers.peers(t)]

    def keep(self, t, peer, engaged=False):
        if peer not in self.listening:
            self.callers.keep(t, peer, engaged)

    def send(self, datagram, peer):
        self.outgoing.append((datagram, peer))

    def close(self):
        self.incoming = None


class Vehicle:
    """Answers requests as an autopilot does, and reports what they changed; ``refuse`` names what it will not do."""

    def __init__(self, kind, position):
        self.refuse = {}
        self.asked = []
        self.battery = None
        self.sensed = {}
        """Messages of sensors and of what goes to the actuators, by the names of the service's inputs."""
        self.gnss = Gnss(fix=Gnss.FIX_3D, latitude=0.7, longitude=0.2, altitude=400, satellites=12)
        self.nav = NavState(velocity=Vector3(x=3.0, y=4.0, z=1.0), airspeed=25.0)
        self.nav.position.CopyFrom(Vector3(x=position[0], y=position[1], z=position[2]))
        self.nav.orientation.CopyFrom(quaternion(from_euler(0.1, -0.2, 0.3)))
        self.status = VehicleStatus(kind=kind, mode=Mode.MODE_HOLD, landed=True, home=Vector3(x=0.0, y=0.0, z=20.0))
        self.mission = Mission()
        self.fence = Fence()
        self.rally = RallyPoints()
        self.progress = MissionProgress(reached=-1)
        self._hold()
        self.begin(GroundAutopilotParams() if kind == Kind.KIND_GROUND else _PLANE_PARAMS)

    def begin(self, params):
        """The autopilot is started with its file's parameters."""
        self.autopilot = Autopilot()
        self.autopilot.params, self.autopilot.fixed_params = params, FIXED
        self._told = ToldParams()
        self.params = None
        self.tell()

    def tell(self):
        self.params = self._told.news(0.0, self.autopilot.params) or self.params

    def set(self, name, value):
        """By the page, or anybody else."""
        reply = ParamServer(self.autopilot).reply(ParamRequest(name=name, value=json.dumps(value)))
        self.tell()
        return reply

    def _hold(self):
        """Aircraft circle in some modes."""
        if self.status.kind == Kind.KIND_FIXED_WING and self.status.mode in (Mode.MODE_HOLD, Mode.MODE_RETURN):
            self.status.circle.CopyFrom(Circle(centre=Vector3(x=50.0, y=60.0, z=80.0), radius=90.0))
        else:
            self.status.ClearField("circle")

    def answer(self, name, request):
        self.asked.append((name, request))
        if name in self.refuse:
            return Reply(accepted=False, reason=self.refuse[name])
        if name.endswith("_param"):
            return self.set(request.name, json.loads(request.value))
        if name == "arm":
            self.status.armed = request.arm
        elif name == "set_mode":
            self.status.mode = request.mode
            self._hold()
        elif name == "set_mission":
            self.mission = request.mission
            state = MissionProgress.NOT_STARTED if request.mission.items else MissionProgress.NO_MISSION
            self.progress = MissionProgress(state=state, total=len(request.mission.items), reached=-1, mission_id=request.mission.id)
        elif name == "set_fence":
            self.fence = request.fence
        elif name == "set_rally":
            self.rally = request.rally
        elif name == "set_current":
            self.progress.current = request.index
        elif name == "order" and request.WhichOneof("kind") == "takeoff":
            self.status.mode = Mode.MODE_TAKEOFF
        elif name == "orbit":
            self.status.mode = Mode.MODE_ORBIT
            self.status.circle.CopyFrom(Circle(centre=request.centre, radius=request.radius))
        return Reply(accepted=True)


class Rig:
    """``say`` a message, ``run`` the service, look at what a ground station ``heard``."""

    SENSED = ("imu", "air_data", "surface_command", "wheel_command", "targets", "quality", "planning")
    CALLS = tuple(MavlinkService.calls)

    def __init__(self, answers=True, shelf=None, reserved=None, rover=ROVER_FACTS, plane=PLANE_FACTS):
        self.link = MemoryLink()
        self.reserved = reserved
        self.plane_facts, self.rover_facts = plane, rover
        self.shelf = shelf or Shelf()
        self.restart()
        self.plane = Vehicle(Kind.KIND_FIXED_WING, (100.0, 200.0, 80.0))
        self.rover = Vehicle(Kind.KIND_GROUND, (1.0, 2.0, 0.0))
        self.vehicles = {"plane": self.plane, "rover": self.rover}
        self.reported = set(self.vehicles)
        self.answers = answers
        self.hears_satellites = True
        self.rate = 1.0
        """Simulated seconds in one of wall time."""
        self.clock = Clock(state=Clock.RUNNING)
        self.events = {}
        self.outputs = {}
        self.n = 0
        self._waiting = {call: [] for call in self.CALLS}
        self._mav = mav.MAVLink(None)

    @property
    def t(self):
        return self.n * DT

    def restart(self):
        """The process begins anew; the vehicles go on."""
        self.service = MavlinkService(
            [self.plane_facts, self.rover_facts], self.link, {**shelves(), "plane": self.shelf}, reserved=self.reserved
        )

    def say(self, message, system=255, component=190, peer=GCS):
        self._mav.srcSystem, self._mav.srcComponent = system, component
        self.link.incoming.append((message.pack(self._mav), peer))

    def run(self, seconds=0.1):
        """Steps for a while (5 steps by default); returns what the ground station heard meanwhile."""
        self.link.outgoing.clear()
        for _ in range(round(seconds / DT)):
            self._step()
        return self.heard()

    def _step(self):
        self.n += 1
        if self.clock.state == Clock.RUNNING:
            self.clock.t_ns += round(DT * self.rate * 1e9)
        sim = stamp(self.clock.t_ns * 1e-9)
        live = {name: v for name, v in self.vehicles.items() if name in self.reported}
        for v in live.values():
            v.nav.timestamp.CopyFrom(sim)
            v.status.timestamp.CopyFrom(sim)
            if self.hears_satellites:
                v.gnss.timestamp.CopyFrom(sim)
            for told in v.sensed.values():
                told.timestamp.CopyFrom(sim)
        answers, self._waiting = self._waiting, {call: [] for call in self.CALLS}
        events, self.events = self.events, {}
        self.outputs = stepped(
            self.service,
            self.t,
            nav={n: v.nav for n, v in live.items()},
            status={n: v.status for n, v in live.items()},
            mission={n: v.mission for n, v in live.items() if v.mission is not None},
            progress={n: v.progress for n, v in live.items() if v.progress is not None},
            fence={n: v.fence for n, v in live.items()},
            rally={n: v.rally for n, v in live.items()},
            gnss={"plane": self.plane.gnss} if "plane" in live else {},
            battery={n: v.battery for n, v in live.items() if v.battery is not None},
            **{what: {n: v.sensed[what] for n, v in live.items() if what in v.sensed} for what in self.SENSED},
            params={n: v.params for n, v in live.items()},
            events=events,
            clock=self.clock,
            **answers,
        )
        if self.answers:
            self._answer()

    def _answer(self):
        for call in self.CALLS:
            for name, requests in self.outputs.get(call, {}).items():
                for request in requests:
                    self._waiting[call].append(Answer(name, request, self.vehicles[name].answer(call, request)))

    def heard(self, peer=GCS):
        """Messages to one peer, through the parser of a client of its own."""
        client = mav.MAVLink(None)
        return [m for data, to in self.link.outgoing if to == peer for m in client.parse_buffer(data)]


def of(messages, name, system=None):
    """Those of one type, perhaps from one system."""
    return [m for m in messages if m.get_type() == name and system in (None, m.get_srcSystem())]


def texts(messages):
    """Whole texts, chunks put together the way QGroundControl does."""
    whole, parts = [], {}
    for m in of(messages, "STATUSTEXT"):
        parts.setdefault(m.id, "")
        parts[m.id] += m.text
        if m.id == 0 or len(m.text) < 50:
            whole.append(parts.pop(m.id))
    return whole


def long(number, *p, system=PLANE, confirmation=0, component=1):
    """COMMAND_LONG; parameters left out are NaN."""
    params = (*p, *[np.nan] * (7 - len(p)))
    return mav.MAVLink_command_long_message(system, component, number, confirmation, *params)


def acks(messages):
    """(command, result) of each COMMAND_ACK, which must be addressed to the asker."""
    found = of(messages, "COMMAND_ACK")
    assert all((m.target_system, m.target_component) == (255, 190) for m in found)
    return [(m.command, m.result) for m in found]
