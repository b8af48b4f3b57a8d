"""Every message type of the system, under one name to import from."""

from foxglove_schemas_protobuf.CameraCalibration_pb2 import CameraCalibration
from foxglove_schemas_protobuf.Color_pb2 import Color
from foxglove_schemas_protobuf.CompressedImage_pb2 import CompressedImage
from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.Grid_pb2 import Grid
from foxglove_schemas_protobuf.JointState_pb2 import JointState
from foxglove_schemas_protobuf.JointStates_pb2 import JointStates
from foxglove_schemas_protobuf.KeyValuePair_pb2 import KeyValuePair
from foxglove_schemas_protobuf.LaserScan_pb2 import LaserScan
from foxglove_schemas_protobuf.Odometry_pb2 import Odometry
from foxglove_schemas_protobuf.PackedElementField_pb2 import PackedElementField
from foxglove_schemas_protobuf.Pose_pb2 import Pose
from foxglove_schemas_protobuf.PoseInFrame_pb2 import PoseInFrame
from foxglove_schemas_protobuf.PosesInFrame_pb2 import PosesInFrame
from foxglove_schemas_protobuf.Quaternion_pb2 import Quaternion
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3
from google.protobuf.timestamp_pb2 import Timestamp

from schemas.v1.command_pb2 import (
    AttitudeSetpoint,
    CircleSetpoint,
    CourseSetpoint,
    DriveCommand,
    FlightSetpoint,
    GimbalCommand,
    JointTarget,
    LineSetpoint,
    MoveJointsRequest,
    StopCommand,
    StopEngagement,
    StopState,
    SurfaceCommand,
    WheelCommand,
)
from schemas.v1.detection_pb2 import Detection, Detections
from schemas.v1.fence_pb2 import Fence, FenceRequest, FenceZone
from schemas.v1.link_pb2 import Link
from schemas.v1.map_pb2 import MapFix, MappingRequest, MapReply, MapRequest, MapSession, PlaceRequest, RelocalizeRequest, SaveMapRequest
from schemas.v1.mission_pb2 import (
    CancelRequest,
    FollowRequest,
    GoalRequest,
    GoAroundRequest,
    Mission,
    MissionItem,
    MissionProgress,
    MissionRequest,
    NavStatus,
    OrbitRequest,
    RouteRequest,
    SetCurrentRequest,
)
from schemas.v1.navigation_pb2 import MovingObstacle, MovingObstacles, NavDirective, NavReport, PreviewReply, PreviewRequest
from schemas.v1.octree_pb2 import OctreeMap, OctreeSaveRequest
from schemas.v1.rally_pb2 import RallyPoints, RallyRequest
from schemas.v1.sensor_pb2 import AirData, Battery, Contact, Gnss, Imu, Range, WheelTicks
from schemas.v1.simulator_pb2 import RemoveRequest, SetPoseRequest, SimObject, SimObjects, SpawnRequest, StateRequest, WindRequest
from schemas.v1.system_pb2 import (
    Event,
    Health,
    LaunchRequest,
    Param,
    ParamReply,
    ParamRequest,
    ParamValues,
    Process,
    Processes,
    Refusal,
)
from schemas.v1.targets_pb2 import EstimateQuality, Targets
from schemas.v1.tasks_pb2 import Tasks, TaskStatus
from schemas.v1.time_pb2 import Clock, ClockRequest, Done
from schemas.v1.vehicle_command_pb2 import (
    AltitudeCommand,
    HomeCommand,
    PictureCommand,
    RebootCommand,
    SpeedCommand,
    TakeoffCommand,
    VehicleCommandRequest,
)
from schemas.v1.vehicle_pb2 import (
    ArmRequest,
    Breach,
    Circle,
    ExternalVehicle,
    Kind,
    Mode,
    ModeRequest,
    NavState,
    Reply,
    VehicleStatus,
)

__all__ = [
    "AirData",
    "AltitudeCommand",
    "ArmRequest",
    "AttitudeSetpoint",
    "Battery",
    "Breach",
    "CameraCalibration",
    "CancelRequest",
    "Circle",
    "CircleSetpoint",
    "Clock",
    "ClockRequest",
    "Color",
    "CompressedImage",
    "Contact",
    "CourseSetpoint",
    "Detection",
    "Detections",
    "Done",
    "DriveCommand",
    "EstimateQuality",
    "Event",
    "Fence",
    "FenceRequest",
    "FenceZone",
    "FrameTransform",
    "FrameTransforms",
    "GimbalCommand",
    "Gnss",
    "FlightSetpoint",
    "GoAroundRequest",
    "FollowRequest",
    "GoalRequest",
    "RouteRequest",
    "HomeCommand",
    "OrbitRequest",
    "Grid",
    "ExternalVehicle",
    "Health",
    "Imu",
    "JointState",
    "JointStates",
    "KeyValuePair",
    "Kind",
    "LaserScan",
    "LaunchRequest",
    "LineSetpoint",
    "Link",
    "MapFix",
    "MapReply",
    "MapRequest",
    "MapSession",
    "MappingRequest",
    "Mission",
    "MissionItem",
    "MissionProgress",
    "MissionRequest",
    "Mode",
    "ModeRequest",
    "MovingObstacle",
    "MovingObstacles",
    "NavState",
    "NavDirective",
    "NavReport",
    "NavStatus",
    "OctreeMap",
    "OctreeSaveRequest",
    "Odometry",
    "VehicleCommandRequest",
    "PackedElementField",
    "Param",
    "ParamReply",
    "ParamRequest",
    "ParamValues",
    "PictureCommand",
    "PlaceRequest",
    "Pose",
    "PoseInFrame",
    "PosesInFrame",
    "Process",
    "Processes",
    "PreviewReply",
    "PreviewRequest",
    "Quaternion",
    "RallyPoints",
    "RallyRequest",
    "Range",
    "Refusal",
    "RelocalizeRequest",
    "RemoveRequest",
    "Reply",
    "RebootCommand",
    "SaveMapRequest",
    "SetCurrentRequest",
    "SetPoseRequest",
    "SimObject",
    "SimObjects",
    "SpawnRequest",
    "SpeedCommand",
    "StateRequest",
    "StopCommand",
    "StopEngagement",
    "StopState",
    "SurfaceCommand",
    "TakeoffCommand",
    "Targets",
    "TaskStatus",
    "Tasks",
    "Timestamp",
    "Vector3",
    "VehicleStatus",
    "JointTarget",
    "MoveJointsRequest",
    "WheelCommand",
    "WheelTicks",
    "WindRequest",
]
