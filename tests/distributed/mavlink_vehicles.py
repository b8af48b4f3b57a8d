"""A plane and a rover that answer requests like the real autopilots, on a LocalBus with the real MAVLink service, live."""

import threading
import time

import numpy as np

from schemas import topics
from schemas.messages import (
    ArmRequest,
    Gnss,
    GoalRequest,
    Kind,
    Mission,
    MissionItem,
    MissionProgress,
    MissionRequest,
    Mode,
    ModeRequest,
    NavState,
    Reply,
    SetCurrentRequest,
    VehicleStatus,
)
from services.autopilot.mavlink.service import MavlinkService
from tests.services.autopilot.mavlink.rig import ORIGIN, PLANE_FACTS, ROVER_FACTS, shelves
from uvf.maths.rotations import from_euler
from uvf.mavlink.endpoint import UdpLink
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.contract.declaration import Reads, Writes, replies, request, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.messages.convert import array, quaternion, stamp, vector
from uvf.runtime.messages.step_times import NS

SPEED = 60.0  # m/s


class ScriptedVehicle(Service):
    """Flies straight from item to item in mode Mission, stands still in every other."""

    name = "scripted"
    hz = 50.0

    class Inputs(Reads):
        arm: list[ArmRequest] = request(topics.ARM)
        set_mode: list[ModeRequest] = request(topics.SET_MODE)
        set_mission: list[MissionRequest] = request(topics.SET_MISSION)
        set_current: list[SetCurrentRequest] = request(topics.SET_CURRENT)
        goal: list[GoalRequest] = request(topics.GOAL)

    class Outputs(Writes):
        nav: NavState | None = topic(topics.NAV_STATE)
        status: VehicleStatus | None = topic(topics.STATUS)
        mission: Mission | None = topic(topics.MISSION)
        progress: MissionProgress | None = topic(topics.PROGRESS)
        gnss: Gnss | None = topic(topics.GNSS)
        arm: list[Reply] = replies(topics.ARM)
        set_mode: list[Reply] = replies(topics.SET_MODE)
        set_mission: list[Reply] = replies(topics.SET_MISSION)
        set_current: list[Reply] = replies(topics.SET_CURRENT)
        goal: list[Reply] = replies(topics.GOAL)

    def __init__(self, kind, start):
        self.position = np.array(start, dtype=float)
        self.home = self.position.copy()
        self.goal = None
        self.status = VehicleStatus(kind=kind, mode=Mode.MODE_HOLD, home=vector(self.home), landed=True)
        self.plan = Mission()
        self.progress = MissionProgress(reached=-1)

    def step(self, t: float, now: Inputs) -> Outputs:
        out = self.Outputs(
            arm=[self._arm(r) for r in now.arm],
            set_mode=[self._set_mode(r) for r in now.set_mode],
            set_mission=[self._set_mission(r) for r in now.set_mission],
            set_current=[self._set_current(r) for r in now.set_current],
            goal=[self._goal(r) for r in now.goal],
        )
        velocity = self._move(1.0 / self.hz)
        at = stamp(t)
        nav = NavState(timestamp=at, position=vector(self.position), velocity=vector(velocity), orientation=quaternion(from_euler(0, 0, 0)))
        latitude, longitude, altitude = ORIGIN.geodetic(self.position)
        fix = Gnss(timestamp=at, fix=Gnss.FIX_3D, latitude=latitude, longitude=longitude, altitude=altitude, satellites=12)
        self.status.timestamp.CopyFrom(at)
        out.update({"nav": nav, "status": self.status, "mission": self.plan, "progress": self.progress, "gnss": fix})
        return out

    def _move(self, dt):
        target = self._target()
        if target is None:
            return np.zeros(3)
        way = target - self.position
        distance = float(np.linalg.norm(way))
        if distance < SPEED * dt:
            self.position = target
            self._arrive()
            return np.zeros(3)
        self.position = self.position + way / distance * SPEED * dt
        return way / distance * SPEED

    def _target(self):
        if self.status.mode == Mode.MODE_MISSION and self.progress.state == MissionProgress.ACTIVE:
            return array(self.plan.items[self.progress.current].position)
        return self.goal if self.status.mode == Mode.MODE_HOLD else None

    def _arrive(self):
        if self.status.mode != Mode.MODE_MISSION:
            return
        self.progress.reached = self.progress.current
        if self.progress.current + 1 < self.progress.total:
            self.progress.current += 1
        else:
            self.progress.state = MissionProgress.COMPLETE

    def _arm(self, request):
        self.status.armed, self.status.landed = request.arm, not request.arm
        return Reply(accepted=True)

    def _set_mode(self, request):
        if request.mode not in (Mode.MODE_HOLD, Mode.MODE_MISSION, Mode.MODE_RETURN):
            return Reply(reason="this vehicle has no such mode")
        self.status.mode = request.mode
        if request.mode == Mode.MODE_MISSION and self.progress.total:
            self.progress.state = MissionProgress.ACTIVE
        return Reply(accepted=True)

    def _set_mission(self, request):
        if any(item.kind in (MissionItem.TAKEOFF, MissionItem.LAND) for item in request.mission.items):
            return Reply(reason="no take-off and no landing")
        self.plan = request.mission
        self.progress = MissionProgress(state=MissionProgress.NOT_STARTED, total=len(self.plan.items), reached=-1, mission_id=self.plan.id)
        return Reply(accepted=True)

    def _set_current(self, request):
        if request.index >= self.progress.total:
            return Reply(reason="no such item")
        self.progress.current = request.index
        return Reply(accepted=True)

    def _goal(self, request):
        self.goal = array(request.position)
        self.status.mode = Mode.MODE_HOLD
        return Reply(accepted=True)


class LiveVehicles:
    """Runs plane and rover with the MAVLink service in a thread, in real time, speaking to ``targets``."""

    def __init__(self, targets, listen=None):
        self.link = UdpLink(targets, listen)
        self.plane = ScriptedVehicle(Kind.KIND_FIXED_WING, (0.0, 0.0, 50.0))
        self.rover = ScriptedVehicle(Kind.KIND_GROUND, (3.0, 4.0, 0.0))
        bus = LocalBus()
        service = MavlinkService([PLANE_FACTS, ROVER_FACTS], self.link, shelves())
        self._shells = [
            ServiceRunner(ServiceInstance(ScriptedVehicle, lambda: self.plane, "plane"), bus),
            ServiceRunner(ServiceInstance(ScriptedVehicle, lambda: self.rover, "rover"), bus),
            ServiceRunner(ServiceInstance(MavlinkService, lambda: service), bus),
        ]
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name="vehicles")

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *exc):
        self._stop.set()
        self._thread.join()
        self.link.close()

    def _run(self):
        """Steps in the order of their time, also after the machine has been busy with something else."""
        start = time.monotonic()
        while not self._stop.wait(0.005):
            now = round((time.monotonic() - start) * NS)
            while (shell := min(self._shells, key=lambda s: s.due_ns)).due_ns <= now:
                shell.sim_ns = shell.due_ns
                shell.advance()
