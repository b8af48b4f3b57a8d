"""Two vehicles that move by script on a bus: a ground vehicle on a loop through a room, an aircraft on a circuit."""

from pathlib import Path

import msgspec
import numpy as np

from schemas import topics
from schemas.messages import (
    Clock,
    Event,
    FenceRequest,
    GoalRequest,
    Kind,
    LaserScan,
    Mission,
    MissionItem,
    MissionProgress,
    MissionRequest,
    Mode,
    ModeRequest,
    NavState,
    NavStatus,
    Odometry,
    PoseInFrame,
    PosesInFrame,
    PreviewReply,
    RallyRequest,
    Reply,
    Timestamp,
    Vector3,
    VehicleStatus,
)
from uvf.maths.rotations import from_euler
from uvf.models.mission.file import JobFile
from uvf.models.mission.formation import Follow
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.vehicle.file import load_vehicle
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.messages.convert import occupancy_grid, planar_pose, quaternion, stamp
from uvf.runtime.messages.step_times import NS

UGV, UAV = "burger", "milvus"
SERVED = (topics.GOAL, topics.CANCEL, topics.ARM, topics.SET_MODE, topics.VEHICLE_COMMAND, topics.SET_MISSION, topics.SET_CURRENT)
LEGS = ((200.0, -150.0), (200.0, 150.0), (-200.0, 150.0), (-200.0, -150.0))


def demo_site():
    return load_scenario(Path(ROOT / "missions/demo.yaml"))


def with_eyes(site, of="milvus_survey"):
    """The same site, its aircraft with the sensors of another."""
    file = site.members[UAV].file
    sensors = load_vehicle(site.vehicles_folder, of).sensors
    object.__setattr__(site.members[UAV], "file", msgspec.structs.replace(file, sensors=sensors))
    return site


def with_leader(site, leader="milvus1"):
    """The same site, its aircraft with a place behind a leader instead of a mission."""
    entry = msgspec.structs.replace(site.members[UAV].entry, job=JobFile(follow=Follow(leader, behind=40.0)))
    object.__setattr__(site.members[UAV], "entry", entry)
    return site


def ugv_at(t):
    """(x, y, yaw) on a circle in the living room."""
    a = 0.3 * t
    return 3.3 + 0.7 * np.cos(a), 2.0 + 0.7 * np.sin(a), a + np.pi / 2


def uav_at(t, speed=25.0):
    """(position, yaw) on the rectangle, 60 m up."""
    corners = np.array((LEGS[3], *LEGS))
    lengths = np.hypot(*np.diff(corners, axis=0).T)
    s = (speed * t) % lengths.sum()
    for corner, length, way in zip(corners, lengths, np.diff(corners, axis=0), strict=False):
        if s <= length:
            xy = corner + way * s / length
            return np.array((*xy, 60.0 + 2 * np.sin(t / 3))), np.arctan2(way[1], way[0])
        s -= length
    raise AssertionError("beyond the last leg")


class Script:
    """Publishes what both vehicles would say; keeps what is asked of them and answers it."""

    def __init__(self, bus=None, accept=True):
        self.bus = bus or LocalBus()
        self.accept = accept
        self.asked = []
        self.stops = []
        self.drives = []
        self.gimbals = []
        self.job = "explore"
        self._publishers = {}
        for name in (UGV, UAV):
            for request in (
                topics.GOAL,
                topics.CANCEL,
                topics.ARM,
                topics.SET_MODE,
                topics.VEHICLE_COMMAND,
                topics.SET_MISSION,
                topics.SET_CURRENT,
                topics.SET_FENCE,
                topics.SET_RALLY,
            ):
                self.bus.serve(request.at(name), lambda query, n=name, r=request: self._answer(n, r, query))
        self.bus.serve(topics.PREVIEW.at(UGV), self._preview)
        self.bus.subscribe(topics.STOP.by("gcs").at("sys"), topics.STOP.qos, self._hear_stop)
        self.bus.subscribe(topics.DRIVE.by("gcs").at(UGV), topics.DRIVE.qos, self._hear_drive)
        self.bus.subscribe(topics.GIMBAL.by("gcs").at(UAV), topics.GIMBAL.qos, self._hear_gimbal)
        self.mode = {UGV: Mode.MODE_MISSION, UAV: Mode.MODE_MISSION}
        self.armed = {UGV: True, UAV: True}
        self.landed = False
        self.goal = (4.5, 4.2)
        self.put(UAV, topics.MISSION, self._mission(), 0.0)

    def _hear_stop(self, sample):
        self.stops.append(topics.STOP.message.FromString(sample.payload))

    def _hear_drive(self, sample):
        message = topics.DRIVE.message.FromString(sample.payload)
        self.drives.append((message.linear, message.angular))

    def _hear_gimbal(self, sample):
        self.gimbals.append(topics.GIMBAL.message.FromString(sample.payload))

    def _answer(self, name, request, query):
        message = request.message.FromString(query.payload)
        self.asked.append((name, message))
        if self.accept and isinstance(message, GoalRequest):
            self.goal = (message.position.x, message.position.y)
        if self.accept and isinstance(message, ModeRequest):
            self.mode[name] = message.mode
        if self.accept and isinstance(message, FenceRequest):
            self.put(name, topics.FENCE, message.fence, 0.0)
        if self.accept and isinstance(message, RallyRequest):
            self.put(name, topics.RALLY, message.rally, 0.0)
        if self.accept and isinstance(message, MissionRequest):
            self.put(name, topics.MISSION, message.mission, 0.0)
        reply = Reply(accepted=self.accept, reason="" if self.accept else "the <goal> lies inside a wall")
        query.answer(reply.SerializeToString(deterministic=True), query.stamp_ns)

    def _preview(self, query):
        """A straight way."""
        to = topics.PREVIEW.message.FromString(query.payload).position
        poses = [planar_pose(3.3, 2.0, 0.0), planar_pose(to.x, to.y, 0.0)]
        found = PreviewReply(accepted=True, poses=poses, length=4.2, duration=9.0, clearance=0.3)
        reply = found if self.accept else PreviewReply(reason="no way")
        query.answer(reply.SerializeToString(deterministic=True), query.stamp_ns)

    def put(self, owner, topic, message, t):
        key = topic.at(owner)
        if key not in self._publishers:
            self._publishers[key] = self.bus.publisher(key, topic.message.DESCRIPTOR.full_name, topic.qos)
        self._publishers[key].put(message.SerializeToString(deterministic=True), round(t * NS))

    def publish(self, t):
        """Everything that is newest at simulation time ``t`` [s]."""
        self.put("sys", topics.CLOCK, Clock(tick=round(t * 100), t_ns=round(t * NS), rate=1.0, rate_wanted=1.0), t)
        self._publish_ugv(t)
        self._publish_uav(t)

    def _publish_ugv(self, t):
        x, y, yaw = ugv_at(t)
        self.put(UGV, topics.POSE, PoseInFrame(timestamp=stamp(t), frame_id="world", pose=planar_pose(x, y, yaw)), t)
        odometry = Odometry(timestamp=stamp(t), linear_velocity=Vector3(x=0.21), angular_velocity=Vector3(z=0.3))
        self.put(UGV, topics.ODOMETRY, odometry, t)
        ahead = [planar_pose(*ugv_at(t + dt)) for dt in np.arange(0, 3, 0.2)] + [planar_pose(*self.goal, 0.0)]
        self.put(UGV, topics.PATH, PosesInFrame(timestamp=stamp(t), frame_id="world", poses=ahead), t)
        goal = Vector3(x=self.goal[0], y=self.goal[1])
        status = NavStatus(state=NavStatus.DRIVING, job=self.job, goal=goal, distance_left=2.4, explored=min(0.9, 0.1 + t / 100))
        self.put(UGV, topics.NAV_STATUS, status, t)
        self.put(UGV, topics.STATUS, self._status(UGV, Kind.KIND_GROUND, "planner"), t)
        angles = np.radians(np.arange(360))
        ranges = 1.2 + 0.4 * np.sin(3 * angles)
        ranges[::7] = 0.0
        scan = LaserScan(timestamp=stamp(t), frame_id="burger/lidar", start_angle=0.0, end_angle=angles[-1], ranges=ranges)
        self.put(UGV, topics.SCAN, scan, t)
        self.put(UGV, topics.MAP, self._grid(t), t)

    def _publish_uav(self, t):
        position, yaw = uav_at(t)
        roll, pitch = 0.25 * np.sin(t / 4), -0.06
        state = NavState(
            timestamp=stamp(t),
            position=Vector3(x=position[0], y=position[1], z=position[2]),
            velocity=Vector3(x=25 * np.cos(yaw), y=25 * np.sin(yaw), z=0.4),
            orientation=quaternion(from_euler(roll, pitch, yaw)),
            airspeed=24.3,
            wind=Vector3(x=1.5, y=1.3),
        )
        self.put(UAV, topics.NAV_STATE, state, t)
        self.put(UAV, topics.TRUTH, state, t)
        self.put(UAV, topics.STATUS, self._status(UAV, Kind.KIND_FIXED_WING, "mission"), t)
        progress = MissionProgress(state=MissionProgress.ACTIVE, current=int(t / 14) % 4, total=4, laps=int(t / 56))
        self.put(UAV, topics.PROGRESS, progress, t)

    def _status(self, name, kind, source):
        return VehicleStatus(
            kind=kind,
            mode=self.mode[name],
            armed=self.armed[name],
            landed=self.landed,
            command_source=source,
            stopped=bool(self.stops) and self.stops[-1].engaged,
            throttle=0.54,
            battery_remaining=0.81,
            battery_voltage=11.6,
            cross_track=-1.4,
            altitude_error=0.6,
            distance_to_waypoint=123.0,
        )

    def _grid(self, t):
        """The living room, known from the start; more of the house with time."""
        cells = np.full((100, 130), -1, dtype=np.int8)
        known = int(min(100, 50 + t))
        cells[:known, : known + 20] = 0
        cells[:3, : known + 20] = 100
        cells[:known, :3] = 100
        return occupancy_grid(cells, 0.1, -0.2, -0.2, "world", t)

    def _mission(self):
        items = [MissionItem(kind=MissionItem.WAYPOINT, position=Vector3(x=x, y=y, z=60.0)) for x, y in LEGS]
        return Mission(items=[*items, MissionItem(kind=MissionItem.JUMP, jump_to=0, repeat=-1)])

    def say(self, name, text, severity=Event.INFO, t=0.0):
        event = Event(timestamp=Timestamp(seconds=int(t)), severity=severity, text=text)
        self.put(name, topics.EVENTS.by("test"), event, t)
