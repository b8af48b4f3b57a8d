"""What the autopilot of an aircraft reads and writes."""

from schemas import topics
from schemas.messages import (
    AirData,
    ArmRequest,
    Battery,
    EstimateQuality,
    Event,
    Fence,
    FenceRequest,
    FlightSetpoint,
    FrameTransform,
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
    OrbitRequest,
    ParamValues,
    PoseInFrame,
    PosesInFrame,
    RallyPoints,
    RallyRequest,
    Range,
    Reply,
    SetCurrentRequest,
    SurfaceCommand,
    Targets,
    VehicleCommandRequest,
    VehicleStatus,
)
from uvf.runtime.contract.declaration import Reads, Writes, every, optional, replies, request, stop_all, topic
from uvf.runtime.state.stop_all import StopStatus


class Inputs(Reads):
    """Messages and requests that the air autopilot reads."""

    imu: list[Imu] = every(topics.IMU)
    air_data: AirData | None = optional(topics.AIR_DATA)
    gnss: Gnss | None = optional(topics.GNSS)
    battery: Battery | None = optional(topics.BATTERY)
    range: list[Range] = optional(every(topics.RANGE))
    link: Link | None = optional(topics.LINK)
    stop: StopStatus = stop_all()
    teleop: SurfaceCommand | None = optional(topics.SURFACES.by("teleop"))
    mavlink: SurfaceCommand | None = optional(topics.SURFACES.by("mavlink"))
    client: SurfaceCommand | None = optional(topics.SURFACES.by("client"))
    setpoint_offboard: FlightSetpoint | None = optional(topics.SETPOINT.by("offboard"))
    setpoint_client: FlightSetpoint | None = optional(topics.SETPOINT.by("client"))
    setpoint_mavlink: FlightSetpoint | None = optional(topics.SETPOINT.by("mavlink"))
    arm: list[ArmRequest] = request(topics.ARM)
    mode: list[ModeRequest] = request(topics.SET_MODE)
    goal: list[GoalRequest] = request(topics.GOAL)
    mission: list[MissionRequest] = request(topics.SET_MISSION)
    current: list[SetCurrentRequest] = request(topics.SET_CURRENT)
    orbit: list[OrbitRequest] = request(topics.ORBIT)
    go_around: list[GoAroundRequest] = request(topics.GO_AROUND)
    order: list[VehicleCommandRequest] = request(topics.VEHICLE_COMMAND)
    fence: list[FenceRequest] = request(topics.SET_FENCE)
    set_rally: list[RallyRequest] = request(topics.SET_RALLY)


class Outputs(Writes):
    """Messages and replies that the air autopilot publishes."""

    surfaces: SurfaceCommand | None = topic(topics.SURFACE_COMMAND)
    nav_state: NavState | None = topic(topics.NAV_STATE)
    pose: PoseInFrame | None = topic(topics.POSE)
    body_frame: FrameTransform | None = topic(topics.TF_BODY)
    status: VehicleStatus | None = topic(topics.STATUS)
    targets: Targets | None = topic(topics.TARGETS)
    quality: EstimateQuality | None = topic(topics.QUALITY)
    plan: Mission | None = topic(topics.MISSION)
    bounds: Fence | None = topic(topics.FENCE)
    rally: RallyPoints | None = topic(topics.RALLY)
    progress: MissionProgress | None = topic(topics.PROGRESS)
    path: PosesInFrame | None = topic(topics.PATH)
    events: list[Event] | None = topic(topics.EVENTS.by("autopilot"))
    params: ParamValues | None = topic(topics.PARAMS.by("autopilot_air"))
    arm: list[Reply] = replies(topics.ARM)
    mode: list[Reply] = replies(topics.SET_MODE)
    goal: list[Reply] = replies(topics.GOAL)
    mission: list[Reply] = replies(topics.SET_MISSION)
    current: list[Reply] = replies(topics.SET_CURRENT)
    orbit: list[Reply] = replies(topics.ORBIT)
    go_around: list[Reply] = replies(topics.GO_AROUND)
    order: list[Reply] = replies(topics.VEHICLE_COMMAND)
    fence: list[Reply] = replies(topics.SET_FENCE)
    set_rally: list[Reply] = replies(topics.SET_RALLY)


class Recalls(Reads):
    """Latched messages from which a restarted instance resumes."""

    status: VehicleStatus | None = topic(topics.STATUS)
    plan: Mission | None = topic(topics.MISSION)
    bounds: Fence | None = topic(topics.FENCE)
    rally: RallyPoints | None = topic(topics.RALLY)
    progress: MissionProgress | None = topic(topics.PROGRESS)
    nav_state: NavState | None = topic(topics.NAV_STATE)
    params: ParamValues | None = topic(topics.PARAMS.by("autopilot_air"))
