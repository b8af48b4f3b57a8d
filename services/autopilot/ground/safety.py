"""Keeps watch over a ground vehicle: what its failsafes look at, and its fence."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import NamedTuple

from schemas.messages import Battery, Event, Fence, FrameTransform, Imu, LaserScan, Link, Mode, PoseInFrame, Range, WheelTicks
from services.autopilot.failsafes import FailsafeAction, FailsafeOrder, FailsafeWatch
from services.autopilot.ground.edges import EdgeWatch
from services.autopilot.ground.failsafes import GROUND_RULES, STANDS, GroundFailsafeInputs
from services.autopilot.ground.fence import GroundPose, stops
from services.autopilot.ground.mission import Point
from services.autopilot.ground.motion import StuckDetector, TiltEstimate, WheelSpeedometer
from services.autopilot.ground.params import GroundAutopilotParams
from services.autopilot.ground.sight import SensorWatch
from services.autopilot.link_watch import LinkWatch
from uvf.maths.kinematics import Twist
from uvf.models.mission.fence import Fencing, near_home
from uvf.models.vehicle.file import GroundBody
from uvf.runtime.messages.plans.fences import fence_fault, fencing
from uvf.sensors.cliffs import FloorSight
from uvf.sensors.sweeping import Sweeping

BY_ITSELF = (Mode.MODE_MISSION, Mode.MODE_RETURN)


@dataclass(slots=True)
class GroundSensorInputs:
    """The messages of one cycle; None: nothing fresh."""

    here: GroundPose | None = None
    speed: float | None = None
    """m/s forward, as estimated."""
    link: Link | None = None
    imu: list[Imu] = field(default_factory=list)
    wheels: WheelTicks | None = None
    scans: list[LaserScan] = field(default_factory=list)
    correction: FrameTransform | None = None
    battery: Battery | None = None
    ranges: list[Range] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class GroundActivity:
    """What the vehicle is doing."""

    mode: int
    free: bool
    """Armed and not stopped."""
    is_steered: bool
    """A command is there."""
    asked: Sequence[float]
    """m/s at the rims, by the drive's channels, of the cycle before."""


class SensorLooks(NamedTuple):
    """How the sensors look. imu_rpy: of its mount; sweeping: of the lidars, floor: sights of it by the range finders, by their frames."""

    imu_rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)
    sweeping: Mapping[str, Sweeping] = MappingProxyType({})
    floor: Mapping[str, FloorSight] = MappingProxyType({})


class GroundFailsafeMonitor:
    """Evaluates the failsafes and the fence: ``step`` once a cycle, then ``brakes`` for the velocity that was chosen."""

    def __init__(self, body: GroundBody, fence: Fence, looks: SensorLooks) -> None:
        self.watch = FailsafeWatch(GROUND_RULES)
        self.fence = fence
        self._plan: Fencing = fencing(fence)
        self._about: tuple[Point, float] = (0.0, 0.0), 0.0
        self.fencing = self._plan
        """That is kept: the plan's, and the one about home."""
        self.battery: Battery | None = None
        """As told last."""
        self._keep = body.radius, body.max_linear_acceleration
        self._link = LinkWatch()
        self._times = {"pose_age": 0.0, "setpoint_age": 0.0}
        drive = body.drive.kinematics
        self._wheels = WheelSpeedometer(drive)
        self._grip, self._tilt = StuckDetector(self._wheels, drive.channels), TiltEstimate(looks.imu_rpy)
        self._sight = SensorWatch(looks.sweeping)
        self._edges = EdgeWatch(looks.floor)
        self._fenced = self._driven = self._edged = False
        self.is_outside = False
        """Of its fence."""
        self.breaches = 0
        """How often it has been."""

    def set_fence(self, fence: Fence, here: GroundPose | None) -> str:
        """Sets the fence; returns why it is refused, "" if it is in force from now on."""
        why = fence_fault(fence)
        if not why and here is not None and (room := fencing(fence).region.at((here.x, here.y))) < 0:
            why = f"the vehicle is {-room:.1f} m outside of it"
        if not why:
            self.fence, self._plan = fence, fencing(fence)
            self._renew()
        return why

    def keep_near(self, home: Point, distance: float) -> None:
        """Limits the distance from home [m, world] to ``distance`` [m]; 0: no limit."""
        if (home, distance) != self._about:
            self._about = home, distance
            self._renew()

    def _renew(self) -> None:
        self.fencing = self._plan if self.fence.disabled else near_home(self._plan, *self._about)

    def overrule(self) -> None:
        """Notes that somebody has requested a mode."""
        self.watch.overrule()
        self._grip.forget()

    def step(
        self, t: float, sensed: GroundSensorInputs, doing: GroundActivity, params: GroundAutopilotParams, dt: float
    ) -> tuple[list[Event], FailsafeOrder[GroundFailsafeInputs] | None]:
        """One cycle of ``dt`` [s] at ``t`` [s]: the events of rules raised and cleared, and the order that follows."""
        self._hear(t, sensed, doing, dt)
        if sensed.here is not None:
            was, self.is_outside = self.is_outside, self.fencing.region.at((sensed.here.x, sensed.here.y)) < 0
            self.breaches += self.is_outside and not was
        changes, order = self.watch.step(self._known(t, doing, params), dt)
        return [change.event(t) for change in changes], order

    def _hear(self, t: float, sensed: GroundSensorInputs, doing: GroundActivity, dt: float) -> None:
        self._link.step(t, sensed.link)
        if sensed.battery is not None and sensed.battery.remaining >= 0:
            self.battery = sensed.battery
        lacks = {
            "pose_age": doing.mode in BY_ITSELF and sensed.here is None,
            "setpoint_age": doing.mode == Mode.MODE_OFFBOARD and not doing.is_steered,
        }
        self._driven = doing.mode == Mode.MODE_MANUAL and (doing.is_steered or self._driven)
        self._let_go = self._driven and not doing.is_steered
        for name, lacking in lacks.items():
            self._times[name] = self._times[name] + dt if lacking else 0.0
        self._wheels.step(sensed.wheels)
        self._grip.step(doing.asked, sensed.speed, dt)
        self._tilt.step(sensed.imu, dt)
        self._sight.step(t, sensed.scans, sensed.correction, self._wheels.travelled)
        self._edges.step(t, sensed.ranges)

    def _known(self, t: float, doing: GroundActivity, params: GroundAutopilotParams) -> GroundFailsafeInputs:
        return GroundFailsafeInputs(
            params=params,
            moves=doing.free and doing.mode != Mode.MODE_HOLD,
            by_itself=doing.mode in BY_ITSELF,
            by_hand=doing.mode == Mode.MODE_MANUAL,
            silence=self._link.silence,
            stick_released=self._let_go,
            pose_age=self._times["pose_age"],
            setpoint_age=self._times["setpoint_age"],
            unseen=self._sight.unseen,
            map_age=self._sight.map_age,
            stuck_for=self._grip.stuck_for,
            stuck=self._grip.how,
            tilt=self._tilt.angle,
            charge=self.battery.remaining if self.battery is not None else 1.0,
            fence=self._fenced,
            edge=self._edged,
        )

    def brakes(self, here: GroundPose | None, velocity: Twist) -> bool:
        """Whether the vehicle at this velocity has to stop before the fence; it may still turn away from it."""
        self._fenced = here is not None and stops(self.fencing, here, velocity, self._keep)
        return self._fenced

    def halts(self, velocity: Twist) -> bool:
        """Whether the vehicle that is to drive so has to stand at once before an edge; it may drive away from it."""
        halts = self._edges.stops(velocity)
        self._edged = halts or (self._edged and self._edges.is_near)
        return halts

    def obstacle(self, mode: int) -> str:
        """What it lacks to move autonomously in ``mode``; "" if it may move."""
        holding = [self.watch.holding[name] for name in STANDS if name in self.watch.holding] if mode in BY_ITSELF else []
        return holding[0].raised_text if holding else ""

    def faults(self) -> list[str]:
        """The reasons against arming."""
        return [rule.raised_text for rule in self.watch.holding.values() if rule.name in ("tipped", "battery_critical")]


def mode_of(action: FailsafeAction) -> int:
    """The mode that carries out a failsafe action."""
    return Mode.MODE_RETURN if action is FailsafeAction.RETURN else Mode.MODE_HOLD


def place(pose: PoseInFrame, yaw: float) -> GroundPose:
    """The planar pose of a message, with its ``yaw`` [rad, world]."""
    return GroundPose(pose.pose.position.x, pose.pose.position.y, yaw)
