"""What the link knows of one vehicle: what never changes, and the newest message of each kind."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol, TypeVar

import numpy as np
from google.protobuf.timestamp_pb2 import Timestamp

from schemas.messages import (
    AirData,
    Battery,
    Clock,
    EstimateQuality,
    Fence,
    Gnss,
    Imu,
    Kind,
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
from services.autopilot.mavlink.connection.vibration import Vibration
from uvf.maths.geodesy import Floats, LocalTangent
from uvf.models.params import Params
from uvf.models.vehicle.file import VehicleFile
from uvf.models.vehicle.sensors import Sensors
from uvf.runtime.mavlink.geo import GeoPosition
from uvf.runtime.messages.convert import array, seconds
from uvf.runtime.messages.plans.fences import fencing

SILENT_AFTER = 2.0  # s of simulation time
HOME_FENCE = "max_distance", "max_height"
"""The autopilot's parameters of the fence about home."""


class Stamped(Protocol):
    """A message with a time stamp."""

    @property
    def timestamp(self) -> Timestamp:
        """When the message was made."""
        ...


S = TypeVar("S", bound=Stamped)


@dataclass(frozen=True)
class VehicleInfo(GeoPosition):
    """The static facts of a vehicle. origin: of the world frame; its altitude counts as above mean sea level.

    params: the autopilot's, as the vehicle's file sets them; fixed_params: those that it reads only when it starts.
    """

    name: str
    system_id: int
    file: VehicleFile
    origin: LocalTangent
    params: Params
    fixed_params: frozenset[str] = frozenset()
    generic: bool = False
    """Says that it is a generic autopilot instead of a PX4-compatible one; all else is the same."""
    started: float = 0.0
    """Unix time [s] when the link came up, 0 = unknown."""

    @property
    def kind(self) -> Kind:
        """Kind of the vehicle."""
        return Kind.KIND_GROUND if self.file.kind == "ground" else Kind.KIND_FIXED_WING

    @property
    def is_ground(self) -> bool:
        """Whether it is a ground vehicle."""
        return self.file.kind == "ground"

    @property
    def sensors(self) -> Sensors:
        """The sensors of the vehicle's file."""
        return self.file.sensors


@dataclass
class VehicleState:
    """The newest message of each kind of one vehicle; None until the first has arrived."""

    nav: NavState | None = None
    status: VehicleStatus | None = None
    mission: Mission | None = None
    progress: MissionProgress | None = None
    fence: Fence | None = None
    rally: RallyPoints | None = None
    breached_at: float | None = None
    """s, wall: when the vehicle has left its fence last; None while it never has."""
    gnss: Gnss | None = None
    battery: Battery | None = None
    clock: Clock | None = None
    imu: Imu | None = None
    air_data: AirData | None = None
    surface_command: SurfaceCommand | None = None
    wheel_command: WheelCommand | None = None
    targets: Targets | None = None
    quality: EstimateQuality | None = None
    planning: NavStatus | None = None
    vibration: Vibration = field(default_factory=Vibration)
    others: Sequence[tuple[VehicleInfo, "VehicleState"]] = ()
    """The other vehicles of the mission."""
    rc_channels: tuple[int, ...] = ()
    """us, of each channel that a ground station overrides; 0 = released. Empty: none is."""
    params: ParamValues | None = None
    intended_custom_mode: int = field(default=0)
    """The last mode that a ground station asked for, 0 = none yet."""
    own: Mapping[str, Any] = field(default_factory=dict)
    """The autopilot's parameters that are in force, by its own names."""

    @property
    def sim_time(self) -> float:
        """Simulation time [s]: the clock's, or the newest stamp where nobody publishes a clock."""
        if self.clock is not None:
            return self.clock.t_ns * 1e-9
        return max((seconds(m.timestamp) for m in (self.nav, self.status) if m is not None), default=0.0)

    @property
    def is_paused(self) -> bool:
        """Whether the simulation clock does not run."""
        return self.clock is not None and self.clock.state != Clock.RUNNING

    @property
    def is_fenced(self) -> bool:
        """Whether a fence is in force, by a plan or by parameters about home."""
        if self.fence is None or self.fence.disabled:
            return False
        return not fencing(self.fence).is_open or any(self.own.get(limit, 0.0) > 0 for limit in HOME_FENCE)

    @property
    def is_gliding(self) -> bool:
        """Whether it is an aircraft in the air that is disarmed."""
        status = self.status
        return status is not None and status.kind == Kind.KIND_FIXED_WING and not status.armed and not status.landed

    @property
    def is_silent(self) -> bool:
        """Whether estimator or autopilot have been silent for ``SILENT_AFTER``, or were never heard."""
        oldest = min(seconds(m.timestamp) if m is not None else -np.inf for m in (self.nav, self.status))
        return bool(self.sim_time - oldest > SILENT_AFTER)

    def fresh(self, message: S | None) -> S | None:
        """The message, or None when it is older than ``SILENT_AFTER``."""
        return message if message is not None and self.sim_time - seconds(message.timestamp) <= SILENT_AFTER else None

    @property
    def home(self) -> Floats | None:
        """Home position (3,) [m, world]; None while unknown."""
        return array(self.status.home) if self.status is not None and self.status.HasField("home") else None

    @property
    def position(self) -> Floats | None:
        """Estimated position (3,) [m, world]; None while unknown."""
        return array(self.nav.position) if self.nav is not None else None
