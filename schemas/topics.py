"""THE TABLE: every topic and request of the system, one line each.

A key is ``uvf/<owner>/<group>/<name>``; the owner is a vehicle or ``sys``. ``<source>`` in a key is filled by
``topic.by(source)``: the one place where a key has several writers, each with a key of its own.
"""

from dataclasses import dataclass, replace
from enum import Enum
from typing import Any, Generic, TypeVar

from google.protobuf.message import Message as ProtobufMessage

from schemas import messages as m

M = TypeVar("M", bound=ProtobufMessage)
Q = TypeVar("Q", bound=ProtobufMessage)
R = TypeVar("R", bound=ProtobufMessage)

PREFIX = "uvf"
SYSTEM = "sys"
STALE_PERIODS = 10
ACTUATOR_MAX_AGE = 0.5  # s
OPERATORS = ("gcs", "client", "teleop", "mavlink")
"""Sources through which people speak: only they release STOP ALL."""


class Qos(Enum):
    """How a topic travels; ``uvf.runtime.bus.zenoh_bus`` turns each class into Zenoh's settings."""

    CONTROL = "control"
    STATE = "state"
    SENSOR = "sensor"
    BULK = "bulk"
    LATCHED = "latched"
    EVENT = "event"
    LOCKSTEP = "lockstep"


@dataclass(frozen=True)
class Topic(Generic[M]):
    """One line of the table.

    key: template with ``<owner>`` (a vehicle) or ``sys``, perhaps ``<source>``; hz: nominal rate, 0 = on change.
    """

    key: str
    message: type[M]
    hz: float
    qos: Qos
    about: str
    logged: bool = True
    kept: bool = False
    """The newest one outlives its writer, so that a service that is started again can ``recall`` it."""
    across_epochs: bool = False
    """Holds on when time starts over: what an operator has said, not what was simulated."""

    @property
    def per_vehicle(self) -> bool:
        """Whether each vehicle has a topic of its own."""
        return "<owner>" in self.key

    @property
    def max_age(self) -> float:
        """Age [s, message time] from which a message no longer counts; latched and event topics never age."""
        if self.hz == 0 or self.qos in (Qos.LATCHED, Qos.EVENT):
            return float("inf")
        return ACTUATOR_MAX_AGE if "/actuator/" in self.key else STALE_PERIODS / self.hz

    def by(self, source: str) -> "Topic[M]":
        """The same topic as written by one source; ``*`` reads all of them."""
        return replace(self, key=self.key.replace("<source>", source))

    def at(self, owner: str) -> str:
        """Full key for one owner: ``uvf/burger/nav/pose``."""
        return f"{PREFIX}/{self.key.replace('<owner>', owner)}"


@dataclass(frozen=True)
class Request(Generic[Q, R]):
    """A request with its reply: sent by a service's ``calls``, served by another's ``requests``."""

    key: str
    message: type[Q]
    reply: type[R]
    about: str

    @property
    def per_vehicle(self) -> bool:
        """Whether each vehicle has a request of its own."""
        return "<owner>" in self.key

    def by(self, source: str) -> "Request[Q, R]":
        """The same request to the service named ``source``."""
        return replace(self, key=self.key.replace("<source>", source))

    def at(self, owner: str) -> str:
        """Full key for one owner: ``uvf/burger/srv/goal``."""
        return f"{PREFIX}/{self.key.replace('<owner>', owner)}"


_V, _S = "<owner>", SYSTEM
_Q = Qos

# time and supervision
CLOCK = Topic(f"{_S}/time/clock", m.Clock, 100, _Q.LOCKSTEP, "simulation time, from the conductor", kept=True)
DONE = Topic(f"{_S}/time/done/<source>", m.Done, 100, _Q.LOCKSTEP, "a participant has reached this time", logged=False)
STOP = Topic(f"{_S}/cmd/<source>", m.StopCommand, 0, _Q.LATCHED, "STOP ALL and its release by name", across_epochs=True)
STOP_STATE = Topic(f"{_S}/state/stop", m.StopState, 0, _Q.LATCHED, "who engages STOP ALL, kept beside the router", across_epochs=True)
PROCESSES = Topic(f"{_S}/state/processes/<source>", m.Processes, 0, _Q.LATCHED, "what runs", logged=False, across_epochs=True)
HEALTH = Topic(f"{_S}/state/health/<source>", m.Health, 2, _Q.STATE, "sign of life and counters of a process", logged=False)
TASKS = Topic(f"{_S}/mission/tasks", m.Tasks, 0, _Q.LATCHED, "how far the tasks of the mission are", kept=True)
SYSTEM_EVENTS = Topic(f"{_S}/state/events/<source>", m.Event, 0, _Q.EVENT, "what happened to the system")

# sensors
IMU = Topic(f"{_V}/sensor/imu", m.Imu, 100, _Q.STATE, "gyroscope, accelerometer, magnetometer")
SCAN = Topic(f"{_V}/sensor/scan", m.LaserScan, 5, _Q.SENSOR, "2-D lidar; range 0 = no return; stamped at its first beam")
OTHER_SCANS = Topic(f"{_V}/sensor/other_scans", m.LaserScan, 5, _Q.STATE, "further 2-D lidars, distinguished by frame")
WHEELS = Topic(f"{_V}/sensor/wheels", m.WheelTicks, 50, _Q.STATE, "wheel encoders")
GNSS = Topic(f"{_V}/sensor/gnss", m.Gnss, 5, _Q.STATE, "satellite position and velocity")
AIR_DATA = Topic(f"{_V}/sensor/air_data", m.AirData, 50, _Q.STATE, "static and differential pressure")
BATTERY = Topic(f"{_V}/sensor/battery", m.Battery, 1, _Q.STATE, "voltage, current, charge")
CONTACT = Topic(f"{_V}/sensor/contact", m.Contact, 20, _Q.STATE, "bumper")
SONAR = Topic(f"{_V}/sensor/sonar", m.Range, 10, _Q.STATE, "sonars, distinguished by frame; range 0 = no return")
RANGE = Topic(f"{_V}/sensor/range", m.Range, 20, _Q.STATE, "range finders, distinguished by frame; range 0 = no return")
JOINTS = Topic(f"{_V}/sensor/joints", m.JointStates, 20, _Q.STATE, "wheels, surfaces, propeller")
IMAGE = Topic(f"{_V}/sensor/camera/image", m.CompressedImage, 5, _Q.BULK, "camera picture, JPEG")
DEPTH = Topic(f"{_V}/sensor/camera/depth", m.CompressedImage, 5, _Q.BULK, "depth picture, 16-bit PNG: mm along the view, 0 = none")
CAMERA_INFO = Topic(f"{_V}/sensor/camera/info", m.CameraCalibration, 0, _Q.LATCHED, "camera intrinsics")
VIEW = Topic(f"{_V}/sensor/<source>/image", m.CompressedImage, 5, _Q.BULK, "picture of a further camera: chase, gimbal; JPEG")
VIEW_INFO = Topic(f"{_V}/sensor/<source>/info", m.CameraCalibration, 0, _Q.LATCHED, "a further camera's intrinsics")
GIMBAL_JOINTS = Topic(
    f"{_V}/sensor/gimbal/joints", m.JointStates, 5, _Q.STATE, "the gimbal's joints: pan, roll, tilt, from its mount outwards"
)

# truth: for simulators among themselves, tests, displays and scores; never for an algorithm
TRUTH = Topic(f"{_V}/truth/state", m.NavState, 50, _Q.STATE, "true motion, world frame")
OBJECTS = Topic(f"{_S}/truth/objects", m.SimObjects, 20, _Q.STATE, "what has been put into the ground simulation")
WINDSOCKS = Topic(f"{_S}/truth/windsocks", m.FrameTransforms, 10, _Q.STATE, "world from each windsock, which points with the wind")
AIR_OBJECTS = Topic(f"{_S}/truth/aircraft", m.SimObjects, 20, _Q.STATE, "aircraft that have been put into the air simulation")

# navigation
TF_STATIC = Topic(f"{_V}/tf/static", m.FrameTransforms, 0, _Q.LATCHED, "base_link, links that do not move, sensors")
TF_WORLD = Topic(f"{_V}/tf/world", m.FrameTransform, 0, _Q.LATCHED, "world from map, placed at the mission's start pose")
TF_MAP = Topic(f"{_V}/tf/map", m.FrameTransform, 10, _Q.STATE, "map from odom", kept=True)
OCTREE = Topic(f"{_V}/map/octree", m.OctreeMap, 0, _Q.LATCHED, "what is occupied and free in space, world frame", kept=True)
SLICE = Topic(f"{_V}/map/slice", m.Grid, 0, _Q.LATCHED, "a level slice of the octree, int8: -1 unknown, 0 free, 100 occupied")
HEIGHTS = Topic(
    f"{_V}/map/heights", m.Grid, 0, _Q.LATCHED, "top and ground by octree or elevation map, 2 float32 [m], NaN unknown", kept=True
)
SHARED_MAP = Topic(
    f"{_V}/map/shared", m.Grid, 0, _Q.LATCHED, "a map that another vehicle has made, world frame: as map/grid or map/heights", kept=True
)
TF_ODOM = Topic(f"{_V}/tf/odom", m.FrameTransform, 50, _Q.STATE, "odom from base_footprint")
TF_JOINTS = Topic(f"{_V}/tf/joints", m.FrameTransforms, 20, _Q.STATE, "links that joints move: the wheels")
TF_GIMBAL = Topic(f"{_V}/tf/gimbal", m.FrameTransform, 5, _Q.STATE, "base_link from the gimbal's camera, where it looks now")
TF_BODY = Topic(f"{_V}/tf/body", m.FrameTransform, 50, _Q.STATE, "world from base_link of an aircraft")
ODOMETRY = Topic(f"{_V}/nav/odometry", m.Odometry, 50, _Q.STATE, "wheels and IMU, odom frame: smooth, drifts", kept=True)
POSE = Topic(f"{_V}/nav/pose", m.PoseInFrame, 50, _Q.STATE, "best estimate of the pose, world frame")
NAV_STATE = Topic(f"{_V}/nav/state", m.NavState, 50, _Q.STATE, "best estimate of the whole motion, world frame", kept=True)
QUALITY = Topic(f"{_V}/nav/quality", m.EstimateQuality, 2, _Q.STATE, "how far the estimate may be off, and how well measurements fit")
PATH = Topic(f"{_V}/nav/path", m.PosesInFrame, 2, _Q.STATE, "path being followed, world frame")
NAV_STATUS = Topic(f"{_V}/nav/status", m.NavStatus, 2, _Q.STATE, "what the planner is doing", kept=True)
NAV_DIRECTIVE = Topic(f"{_V}/nav/directive", m.NavDirective, 4, _Q.STATE, "what the tracker is to do: follow the path, or recover")
NAV_REPORT = Topic(f"{_V}/nav/report", m.NavReport, 10, _Q.STATE, "how the tracker fares with it")
OBSTACLES = Topic(f"{_V}/nav/obstacles", m.MovingObstacles, 5, _Q.STATE, "what moves around the vehicle, as its tracker follows it")
DETECTIONS = Topic(f"{_V}/nav/detections", m.Detections, 0, _Q.LATCHED, "markers that the vehicle has seen with its camera", kept=True)
PARTICLES = Topic(f"{_V}/nav/particles", m.PosesInFrame, 5, _Q.STATE, "some of the particles that localize the vehicle, map frame")
MAP_POSE = Topic(
    f"{_V}/nav/map_pose", m.MapFix, 5, _Q.STATE, "where the newest scan places the vehicle in its map, and how surely", kept=True
)
MAP_SESSION = Topic(f"{_V}/map/session", m.MapSession, 0, _Q.LATCHED, "keyframes, poses and edges of the map", logged=False, kept=True)
MAP = Topic(f"{_V}/map/grid", m.Grid, 0, _Q.LATCHED, "occupancy, int8: -1 unknown, 0..100", kept=True)
COSTMAP = Topic(
    f"{_V}/map/costmap",
    m.Grid,
    0,
    _Q.LATCHED,
    "what the planner plans on, map frame, uint8: 0 free, 253 inscribed, 254 obstacle, 255 unknown",
    logged=False,
)
LOCAL_COSTS = Topic(
    f"{_V}/map/costs",
    m.Grid,
    0,
    _Q.LATCHED,
    "what the tracker drives by, around the vehicle, world frame; values as map/costmap",
    logged=False,
)
TEAM_MAP = Topic(
    f"{_V}/map/team", m.Grid, 0, _Q.LATCHED, "maps that were found to be of one place, in the map frame of the first; as map/grid"
)
TEAM_PLACE = Topic(f"{_V}/map/place", m.FrameTransform, 0, _Q.LATCHED, "where the vehicle's map lies in that of the first of its team")
KNOWN_MAP = Topic(f"{_V}/map/known", m.Grid, 0, _Q.LATCHED, "a saved map that the vehicle was given, world frame; as map/grid")
KEEP_OUT = Topic(f"{_V}/map/keepout", m.Grid, 0, _Q.LATCHED, "where not to drive, world frame, int8: 100 keep out, 0 not")
SPEED_MAP = Topic(f"{_V}/map/speed", m.Grid, 0, _Q.LATCHED, "speed allowed, world frame, int8: per cent of the vehicle's own")

# commands and actuators
DRIVE = Topic(f"{_V}/cmd/<source>", m.DriveCommand, 20, _Q.CONTROL, "velocity asked of a ground vehicle")
SURFACES = Topic(f"{_V}/cmd/<source>/surfaces", m.SurfaceCommand, 20, _Q.CONTROL, "surfaces and throttle asked of an aircraft")
SETPOINT = Topic(f"{_V}/cmd/<source>/setpoint", m.FlightSetpoint, 20, _Q.CONTROL, "what mode Offboard follows: attitude, course or path")
GIMBAL = Topic(f"{_V}/cmd/<source>/gimbal", m.GimbalCommand, 0, _Q.LATCHED, "where the gimbal is to look, and relative to what")
WHEEL_COMMAND = Topic(f"{_V}/actuator/wheels", m.WheelCommand, 50, _Q.CONTROL, "wheel speeds")
JOINT_COMMAND = Topic(f"{_V}/actuator/joints", m.JointStates, 50, _Q.CONTROL, "positions of a ground vehicle's lift, pan, arm")
SURFACE_COMMAND = Topic(f"{_V}/actuator/surfaces", m.SurfaceCommand, 50, _Q.CONTROL, "control surfaces and throttle")

# state and mission
STATUS = Topic(f"{_V}/state/vehicle", m.VehicleStatus, 10, _Q.STATE, "mode, arming, who commands and why", kept=True)
TARGETS = Topic(f"{_V}/state/targets", m.Targets, 10, _Q.STATE, "what the autopilot is steering at")
EXTERNAL_VEHICLE = Topic(
    f"{_V}/state/external_vehicle", m.ExternalVehicle, 0, _Q.LATCHED, "a vehicle that no mission names: flown elsewhere", across_epochs=True
)
EVENTS = Topic(f"{_V}/state/events/<source>", m.Event, 0, _Q.EVENT, "what happened to the vehicle")
MISSION = Topic(f"{_V}/mission/plan", m.Mission, 0, _Q.LATCHED, "mission in force", kept=True)
FENCE = Topic(f"{_V}/mission/fence", m.Fence, 0, _Q.LATCHED, "where the vehicle may be", kept=True)
RALLY = Topic(f"{_V}/mission/rally", m.RallyPoints, 0, _Q.LATCHED, "where Return may lead beside home", kept=True)
PROGRESS = Topic(f"{_V}/mission/progress", m.MissionProgress, 2, _Q.STATE, "where in the mission", kept=True)

PARAMS = Topic(f"{_V}/state/params/<source>", m.ParamValues, 0, _Q.LATCHED, "a service's parameters that are in force", kept=True)
LINK = Topic(f"{_V}/state/link", m.Link, 2, _Q.STATE, "ground stations that are in touch with the vehicle")

# requests
CLOCK_REQUEST = Request(f"{_S}/srv/clock", m.ClockRequest, m.Reply, "rate, pause, resume, single step, reset")
LAUNCH = Request(f"{_S}/srv/launch", m.LaunchRequest, m.Reply, "end the mission that runs, and start another one")
SPAWN = Request(f"{_S}/srv/sim/spawn", m.SpawnRequest, m.Reply, "put a shape or a vehicle into the ground simulation")
REMOVE = Request(f"{_S}/srv/sim/remove", m.RemoveRequest, m.Reply, "take out what was put in")
SET_POSE = Request(f"{_S}/srv/sim/pose", m.SetPoseRequest, m.Reply, "put a ground vehicle or an object elsewhere, at rest")
SAVE = Request(f"{_S}/srv/sim/save", m.StateRequest, m.Reply, "keep the ground simulator's state under a name")
RESTORE = Request(f"{_S}/srv/sim/restore", m.StateRequest, m.Reply, "go back to a state that was kept")
AIR_SPAWN = Request(f"{_S}/srv/air/spawn", m.SpawnRequest, m.Reply, "put an aircraft in: in level flight, at z = 0 on its wheels")
AIR_REMOVE = Request(f"{_S}/srv/air/remove", m.RemoveRequest, m.Reply, "take out an aircraft that was put in")
AIR_SAVE = Request(f"{_S}/srv/air/save", m.StateRequest, m.Reply, "keep the air simulator's state under a name")
AIR_RESTORE = Request(f"{_S}/srv/air/restore", m.StateRequest, m.Reply, "go back to a state that was kept")
WIND = Request(f"{_S}/srv/air/wind", m.WindRequest, m.Reply, "let another mean wind blow in the air simulation")
AIR_POSE = Request(f"{_S}/srv/air/pose", m.SetPoseRequest, m.Reply, "put an aircraft elsewhere: in steady flight, at z = 0 on its wheels")
ARM = Request(f"{_V}/srv/arm", m.ArmRequest, m.Reply, "arm or disarm")
SET_MODE = Request(f"{_V}/srv/mode", m.ModeRequest, m.Reply, "change the flight or drive mode")
GOAL = Request(f"{_V}/srv/goal", m.GoalRequest, m.Reply, "go to a point")
ORBIT = Request(f"{_V}/srv/orbit", m.OrbitRequest, m.Reply, "circle a place, in mode Orbit")
GO_AROUND = Request(f"{_V}/srv/go_around", m.GoAroundRequest, m.Reply, "give up the approach and fly another one")
VEHICLE_COMMAND = Request(
    f"{_V}/srv/vehicle_command", m.VehicleCommandRequest, m.Reply, "take off to a height; speed, altitude, home, camera; begin anew"
)
MAPPING = Request(f"{_V}/srv/map/mapping", m.MappingRequest, m.Reply, "let the map as it is, go on with it, or begin another one")
ROUTE = Request(f"{_V}/srv/route", m.RouteRequest, m.Reply, "go to several places: stop at each, pass through, or patrol")
FOLLOW = Request(f"{_V}/srv/follow", m.FollowRequest, m.Reply, "stay behind another vehicle")
PREVIEW = Request(f"{_V}/srv/preview", m.PreviewRequest, m.PreviewReply, "is there a way to a place, and what is it like?")
MOVE_JOINTS = Request(f"{_V}/srv/joints", m.MoveJointsRequest, m.Reply, "move joints of a ground vehicle: lift, pan, arm")
CANCEL = Request(f"{_V}/srv/cancel", m.CancelRequest, m.Reply, "give up the goal that is being driven to")
SET_MISSION = Request(f"{_V}/srv/mission", m.MissionRequest, m.Reply, "replace the mission")
SET_FENCE = Request(f"{_V}/srv/fence", m.FenceRequest, m.Reply, "replace the fence, or take it away")
SET_RALLY = Request(f"{_V}/srv/rally", m.RallyRequest, m.Reply, "replace the rally points")
SET_CURRENT = Request(f"{_V}/srv/current", m.SetCurrentRequest, m.Reply, "jump to a mission item")
SAVE_OCTREE = Request(f"{_V}/srv/octree/save", m.OctreeSaveRequest, m.Reply, "write the octree into a .bt file")
SAVE_MAP = Request(f"{_V}/srv/map/save", m.SaveMapRequest, m.Reply, "write the map that is being drawn to a file")
PLACE = Request(f"{_V}/srv/slam/pose", m.PlaceRequest, m.Reply, "where the vehicle is, to one that is localized on a known map")
RELOCALIZE = Request(f"{_V}/srv/slam/relocalize", m.RelocalizeRequest, m.Reply, "look for the vehicle in the whole known map")
GET_MAP = Request(f"{_V}/srv/map/get", m.MapRequest, m.MapReply, "the map that is being drawn, the one given, or a mask")
PARAM = Request(f"{_V}/srv/param/<source>", m.ParamRequest, m.ParamReply, "read or set a service's parameters")

TOPICS: dict[str, Topic[Any]] = {k: v for k, v in globals().items() if isinstance(v, Topic)}
REQUESTS: dict[str, Request[Any, Any]] = {k: v for k, v in globals().items() if isinstance(v, Request)}
