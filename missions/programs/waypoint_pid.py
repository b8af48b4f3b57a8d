"""Drives a rover through the waypoints of its mission by PID on distance and on heading, from outside the autopilot."""

from dataclasses import dataclass, field
from math import atan2, cos, hypot, remainder, tau
from typing import Annotated, Literal

from msgspec import Meta

from schemas import topics
from schemas.messages import DriveCommand, Mission, Mode, PoseInFrame, VehicleStatus
from uvf.models.keys import key, plain
from uvf.models.params import Params
from uvf.models.scenario import MissionVehicle
from uvf.runtime.contract.declaration import Reads, Writes, topic
from uvf.runtime.contract.program import Program
from uvf.runtime.messages.convert import stamp, yaw_of

Gain = Annotated[float, Meta(ge=0)]


class PidParams(Params, frozen=True):
    """Gains and limits."""

    law: Annotated[Literal["p", "pi", "pid"], plain("Which terms of both loops are used.")] = "pid"
    distance_p: Annotated[Gain, key("1/s", "Speed for each metre to the waypoint.")] = 0.8
    distance_i: Annotated[Gain, key("1/s^2", "Speed for each metre second.")] = 0.02
    distance_d: Annotated[Gain, key("", "Speed for each metre per second.")] = 0.1
    heading_p: Annotated[Gain, key("1/s", "Turn rate for each radian off the waypoint.")] = 1.5
    heading_i: Annotated[Gain, key("1/s^2", "Turn rate for each radian second.")] = 0.1
    heading_d: Annotated[Gain, key("", "Turn rate for each radian per second.")] = 0.15
    max_linear: Annotated[float, Meta(gt=0), key("m/s", "Largest speed.")] = 0.45
    max_angular: Annotated[float, Meta(gt=0), key("rad/s", "Largest turn rate.")] = 0.8
    acceptance_radius: Annotated[float, Meta(gt=0), key("m", "Distance at which a waypoint is reached.")] = 0.15


@dataclass
class Pid:
    """A PID controller whose output is limited; it does not integrate while it is at its limit."""

    p: float
    i: float
    d: float
    limit: float
    _sum: float = field(default=0.0, init=False)
    _last: float | None = field(default=None, init=False)

    def step(self, error: float, dt: float) -> float:
        """The output for an error, ``dt`` [s] after the one before."""
        rate = 0.0 if self._last is None else (error - self._last) / dt
        self._last = error
        total = self._sum + error * dt
        output = self.p * error + self.i * total + self.d * rate
        if abs(output) <= self.limit:
            self._sum = total
        return min(max(output, -self.limit), self.limit)


class WaypointPid(Program):
    """In mode Offboard: turns towards the next waypoint and drives there; stands at the last one."""

    name = "waypoint_pid"
    hz = 20.0

    class Inputs(Reads):
        """Where the rover is, where it is to go, and whether it listens."""

        pose: PoseInFrame = topic(topics.POSE)
        mission: Mission = topic(topics.MISSION)
        status: VehicleStatus = topic(topics.STATUS)

    class Outputs(Writes):
        """The velocities that are asked for."""

        drive: DriveCommand | None = topic(topics.DRIVE.by("offboard"))

    def __init__(self, vehicle: MissionVehicle) -> None:
        super().__init__(vehicle)
        self.params: PidParams = vehicle.params(self.name, PidParams)
        self._next = 0
        self._begin()

    def _begin(self) -> None:
        """Begins a leg: both loops forget the one before."""
        p = self.params
        has_i, has_d = p.law != "p", p.law == "pid"
        self._distance = Pid(p.distance_p, has_i * p.distance_i, has_d * p.distance_d, p.max_linear)
        self._heading = Pid(p.heading_p, has_i * p.heading_i, has_d * p.heading_d, p.max_angular)

    def step(self, t: float, now: Inputs) -> Outputs:
        """The command at ``t`` [s, simulation]; nothing, and so a stop, at the end."""
        if self._next == len(now.mission.items) or now.status.mode != Mode.MODE_OFFBOARD:
            return self.Outputs()
        goal, here = now.mission.items[self._next].position, now.pose.pose
        dx, dy = goal.x - here.position.x, goal.y - here.position.y
        if hypot(dx, dy) < self.params.acceptance_radius:
            self._next += 1
            self._begin()
            return self.Outputs(drive=DriveCommand(timestamp=stamp(t)))
        off = remainder(atan2(dy, dx) - yaw_of(here.orientation), tau)
        speed = self._distance.step(hypot(dx, dy), 1.0 / self.hz) * max(cos(off), 0.0) ** 3
        turn = self._heading.step(off, 1.0 / self.hz)
        return self.Outputs(drive=DriveCommand(timestamp=stamp(t), linear=speed, angular=turn))
