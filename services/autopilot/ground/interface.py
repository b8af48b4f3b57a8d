"""What the autopilot of a ground vehicle reads and writes."""

from schemas import topics
from schemas.messages import (
    ArmRequest,
    Battery,
    DriveCommand,
    Event,
    Fence,
    FenceRequest,
    FrameTransform,
    Imu,
    JointStates,
    LaserScan,
    Link,
    Mission,
    MissionProgress,
    MissionRequest,
    ModeRequest,
    MoveJointsRequest,
    Odometry,
    ParamValues,
    PoseInFrame,
    RallyPoints,
    RallyRequest,
    Range,
    Reply,
    SetCurrentRequest,
    VehicleCommandRequest,
    VehicleStatus,
    WheelCommand,
    WheelTicks,
)
from uvf.runtime.contract.declaration import Reads, Writes, every, optional, replies, request, stop_all, topic
from uvf.runtime.state.stop_all import StopStatus


class Inputs(Reads):
    """Messages and requests that the ground autopilot reads."""

    teleop: DriveCommand | None = optional(topics.DRIVE.by("teleop"))
    mavlink: DriveCommand | None = optional(topics.DRIVE.by("mavlink"))
    gcs: DriveCommand | None = optional(topics.DRIVE.by("gcs"))
    client: DriveCommand | None = optional(topics.DRIVE.by("client"))
    executive: DriveCommand | None = optional(topics.DRIVE.by("executive"))
    offboard: DriveCommand | None = optional(topics.DRIVE.by("offboard"))
    planner: DriveCommand | None = optional(topics.DRIVE.by("planner"))
    stop: StopStatus = stop_all()
    pose: PoseInFrame | None = optional(topics.POSE)
    odometry: Odometry | None = optional(topics.ODOMETRY)
    link: Link | None = optional(topics.LINK)
    imu: list[Imu] = optional(every(topics.IMU))
    ticks: WheelTicks | None = optional(topics.WHEELS)
    scan: LaserScan | None = optional(topics.SCAN)
    other_scans: list[LaserScan] = optional(every(topics.OTHER_SCANS))
    joints: JointStates | None = optional(topics.JOINTS)
    correction: FrameTransform | None = optional(topics.TF_MAP)
    battery: Battery | None = optional(topics.BATTERY)
    range: list[Range] = optional(every(topics.RANGE))
    arm: list[ArmRequest] = request(topics.ARM)
    set_mode: list[ModeRequest] = request(topics.SET_MODE)
    set_mission: list[MissionRequest] = request(topics.SET_MISSION)
    set_current: list[SetCurrentRequest] = request(topics.SET_CURRENT)
    set_fence: list[FenceRequest] = request(topics.SET_FENCE)
    order: list[VehicleCommandRequest] = request(topics.VEHICLE_COMMAND)
    set_rally: list[RallyRequest] = request(topics.SET_RALLY)
    move_joints: list[MoveJointsRequest] = request(topics.MOVE_JOINTS)


class Outputs(Writes):
    """Messages and replies that the ground autopilot publishes."""

    wheels: WheelCommand | None = topic(topics.WHEEL_COMMAND)
    joints: JointStates | None = topic(topics.JOINT_COMMAND)
    status: VehicleStatus | None = topic(topics.STATUS)
    mission: Mission | None = topic(topics.MISSION)
    bounds: Fence | None = topic(topics.FENCE)
    rally: RallyPoints | None = topic(topics.RALLY)
    progress: MissionProgress | None = topic(topics.PROGRESS)
    events: list[Event] | None = topic(topics.EVENTS.by("autopilot"))
    params: ParamValues | None = topic(topics.PARAMS.by("autopilot_ground"))
    arm: list[Reply] = replies(topics.ARM)
    set_mode: list[Reply] = replies(topics.SET_MODE)
    set_mission: list[Reply] = replies(topics.SET_MISSION)
    set_current: list[Reply] = replies(topics.SET_CURRENT)
    set_fence: list[Reply] = replies(topics.SET_FENCE)
    order: list[Reply] = replies(topics.VEHICLE_COMMAND)
    set_rally: list[Reply] = replies(topics.SET_RALLY)
    move_joints: list[Reply] = replies(topics.MOVE_JOINTS)


class Recalls(Reads):
    """Latched messages from which a restarted instance resumes."""

    status: VehicleStatus | None = topic(topics.STATUS)
    mission: Mission | None = topic(topics.MISSION)
    progress: MissionProgress | None = topic(topics.PROGRESS)
    bounds: Fence | None = topic(topics.FENCE)
    rally: RallyPoints | None = topic(topics.RALLY)
    params: ParamValues | None = topic(topics.PARAMS.by("autopilot_ground"))
