"""One vehicle as heard over the link: the newest message of each kind, when it came, and what follows from them."""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.messages import (
    CompressedImage,
    Detections,
    EstimateQuality,
    Fence,
    FrameTransform,
    FrameTransforms,
    GimbalCommand,
    Grid,
    JointStates,
    LaserScan,
    MapFix,
    Mission,
    MissionProgress,
    MovingObstacles,
    NavState,
    NavStatus,
    OctreeMap,
    Odometry,
    PoseInFrame,
    PosesInFrame,
    RallyPoints,
    VehicleStatus,
)
from services.gcs.state.plans.area_draft import DrawnAreas
from services.gcs.state.plans.plan_draft import PlanDraft
from services.gcs.state.plans.plan_outlook import PlanOutlook
from services.gcs.state.plots.trends import Trends
from services.gcs.state.remembered import Remembered
from services.gcs.state.tracks import VehicleTrack
from uvf.maths.rotations import matrix
from uvf.maths.se3 import apply
from uvf.models.scenario import MissionVehicle
from uvf.models.vehicle.sensors import Lidar
from uvf.runtime.messages.convert import array, scan_points, wxyz
from uvf.sensors.fitted import base_from_sensor

Floats = NDArray[np.float64]

STALE_AFTER = 1.5  # s, wall clock
LOST_AFTER = 5.0  # s
SIGNS_OF_LIFE = ("nav", "pose", "odometry", "status", "nav_status", "progress")


class DisplayPose(NamedTuple):
    """A pose in the world frame: position (3,) [m], quaternion (4,) wxyz."""

    position: Floats
    wxyz: Floats


@dataclass
class Order:
    """The last request made to a vehicle, and its outcome."""

    text: str
    at: float  # s, wall
    state: str = "sent"  # sent | accepted | refused
    reason: str = ""


@dataclass
class MappingState:
    """How its map is drawn, as far as it was told from here."""

    held: bool = False
    method: str = ""
    """The SLAM method that another map was begun with; "" for the one of the vehicle's file."""


@dataclass
class VehicleModel:
    """One vehicle as heard over the link."""

    name: str
    member: MissionVehicle
    colour: str
    track: VehicleTrack
    nav: NavState | None = None
    pose: PoseInFrame | None = None
    odometry: Odometry | None = None
    truth: NavState | None = None
    status: VehicleStatus | None = None
    nav_status: NavStatus | None = None
    path: PosesInFrame | None = None
    mission: Mission | None = None
    progress: MissionProgress | None = None
    fence: Fence | None = None
    scan: LaserScan | None = None
    image: CompressedImage | None = None
    chase: CompressedImage | None = None
    gimbal: CompressedImage | None = None
    gimbal_joints: JointStates | None = None
    joints: JointStates | None = None
    grid: Grid | None = None
    team_map: Grid | None = None
    world_from_map: FrameTransform | None = None
    fix: MapFix | None = None
    quality: EstimateQuality | None = None
    particles: PosesInFrame | None = None
    obstacles: MovingObstacles | None = None
    detections: Detections | None = None
    costmap: Grid | None = None
    local_costs: Grid | None = None
    octree: OctreeMap | None = None
    map_from_odom: FrameTransform | None = None
    tf_static: FrameTransforms | None = None
    rally: RallyPoints | None = None
    heard_at: dict[str, float] = field(default_factory=dict)
    """Field -> when its newest message came [s, wall]."""
    scan_points: Floats | None = None
    """(n, 3) m, world: the newest scan as seen from where the vehicle was when it came."""
    other_scans: dict[str, tuple[LaserScan, Floats | None]] = field(default_factory=dict)
    """The newest of each further lidar with its points, as above, by their frames."""
    mapped: float | None = None
    """0..1, the report's ``mapped_floor`` of the newest map."""
    order: Order | None = None
    goal_asked: tuple[float, float] | None = None
    draft: PlanDraft = field(default_factory=PlanDraft)
    """The mission that is drawn for it here."""
    mapping: MappingState = field(default_factory=MappingState)
    plan_file: Remembered[str] = field(default_factory=Remembered)
    """What is drawn for it, as the text of a file."""
    file_fault: str = ""
    """Why the last plan file could not be drawn."""
    areas: DrawnAreas = field(default_factory=DrawnAreas)
    """The fence, the rally points and the field that are drawn for it here."""
    outlook: PlanOutlook | None = None
    aim: GimbalCommand = field(default_factory=GimbalCommand)
    """Where its gimbal was last told from here to look."""
    trends: Trends = field(init=False)
    """The last minutes of what its instrument shows."""
    _placed: tuple[NavState | PoseInFrame, DisplayPose] | None = None
    """The newer estimate, and the pose in it."""

    def __post_init__(self) -> None:
        self.trends = Trends(self.flies)

    @property
    def flies(self) -> bool:
        """Whether it is a fixed-wing aircraft."""
        return self.member.file.kind == "fixed_wing"

    @property
    def leader(self) -> str:
        """The vehicle that the mission has it follow; "" if none."""
        follow = self.member.entry.job.follow
        return follow.leader if follow is not None else ""

    @property
    def stopped(self) -> bool:
        """Whether it reports that it obeys STOP ALL."""
        return self.status is not None and self.status.stopped

    @property
    def heard(self) -> float | None:
        """When its own running messages were last heard [s, wall]: neither latched ones nor the simulator's truth."""
        return max((at for name, at in self.heard_at.items() if name in SIGNS_OF_LIFE), default=None)

    @property
    def place(self) -> DisplayPose | None:
        """Its estimated pose: the newer of its two estimates."""
        nav_at, pose_at = self.heard_at.get("nav", -1.0), self.heard_at.get("pose", -1.0)
        source = self.nav if self.nav is not None and nav_at >= pose_at - STALE_AFTER else self.pose
        if source is None:
            return None
        if self._placed is None or self._placed[0] is not source:
            pose = source.pose if isinstance(source, PoseInFrame) else source
            self._placed = source, DisplayPose(array(pose.position), wxyz(pose.orientation))
        return self._placed[1]

    @property
    def true_place(self) -> DisplayPose | None:
        """Its true pose, where a simulator publishes it."""
        return None if self.truth is None else DisplayPose(array(self.truth.position), wxyz(self.truth.orientation))

    @property
    def speed(self) -> float:
        """Speed over ground [m/s]; of a ground vehicle the forward speed, negative backwards."""
        if self.odometry is not None and not self.flies:
            return self.odometry.linear_velocity.x
        return float(np.hypot(self.nav.velocity.x, self.nav.velocity.y)) if self.nav is not None else 0.0

    @property
    def turn_rate(self) -> float:
        """Turn rate [rad/s], left positive."""
        if self.odometry is not None and not self.flies:
            return self.odometry.angular_velocity.z
        return self.nav.angular_velocity.z if self.nav is not None else 0.0


def track_of(member: MissionVehicle) -> VehicleTrack:
    """The track of a vehicle: of an aircraft with larger steps."""
    return VehicleTrack(spacing=2.0, jump=60.0) if member.file.kind == "fixed_wing" else VehicleTrack(spacing=0.04, jump=0.6)


def scan_in_world(vehicle: VehicleModel, scan: LaserScan | None, lidar: Lidar | None) -> Floats | None:
    """Points (n, 3) [m, world] of a lidar's scan; None while the vehicle's pose or its lidar is unknown."""
    place = vehicle.place
    if scan is None or place is None or lidar is None or not scan.ranges:
        return None
    flat = scan_points(scan)
    in_body = apply(base_from_sensor(lidar.mount), np.column_stack((flat, np.zeros(len(flat)))))
    in_world: Floats = in_body @ matrix(place.wxyz).T + place.position
    return in_world


def link_of(heard: float | None, t: float) -> tuple[str, str]:
    """(word, CSS class) for the last message at ``heard`` and the time ``t`` [s, wall]: WAITING, LIVE, STALE 3 s, LINK LOST."""
    if heard is None:
        return "WAITING", "idle"
    age = t - heard
    if age < STALE_AFTER:
        return "LIVE", "good"
    return (f"STALE {age:.0f} s", "warn") if age < LOST_AFTER else (f"LINK LOST {age:.0f} s", "bad")
