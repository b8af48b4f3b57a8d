"""The aircraft of a mission, flown by JSBSim: surfaces in, sensors and truth out."""

from collections.abc import Mapping
from functools import partial

import numpy as np

from schemas import topics
from schemas.messages import (
    AirData,
    Battery,
    Event,
    FrameTransforms,
    Gnss,
    Imu,
    JointStates,
    LaserScan,
    NavState,
    Range,
    RemoveRequest,
    Reply,
    SetPoseRequest,
    SimObjects,
    SpawnRequest,
    StateRequest,
    SurfaceCommand,
    WindRequest,
)
from services.sim_air import readings
from services.sim_air.aircraft import Aircraft
from services.sim_air.stage import AirStage
from uvf.runtime.contract.declaration import Reads, Writes, each_vehicle, optional, replies, request, topic
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.outputs import Value
from uvf.runtime.messages.readings.faults import Faults
from uvf.runtime.messages.readings.sensors import battery_message, gnss_message, imu_message, later
from uvf.runtime.messages.sensor_frames import sensor_frames
from uvf.sensors.sampling import Due


class SimAir(Service):
    """All aircraft of the mission, each in its own air; without a command for 0.5 s surfaces and throttle go to trim."""

    name = "sim_air"
    hz = 100.0
    scope = "world"
    simulator = True

    class Inputs(Reads):
        """Surface commands, true motion of the ground vehicles, and requests."""

        surfaces: dict[str, SurfaceCommand] = each_vehicle(optional(topics.SURFACE_COMMAND))
        truth: dict[str, NavState] = each_vehicle(optional(topics.TRUTH))
        objects: SimObjects | None = optional(topics.OBJECTS)
        spawn: list[SpawnRequest] = request(topics.AIR_SPAWN)
        remove: list[RemoveRequest] = request(topics.AIR_REMOVE)
        set_pose: list[SetPoseRequest] = request(topics.AIR_POSE)
        wind: list[WindRequest] = request(topics.WIND)
        save: list[StateRequest] = request(topics.AIR_SAVE)
        restore: list[StateRequest] = request(topics.AIR_RESTORE)

    class Outputs(Writes):
        """Sensor readings and true motion of each aircraft, and replies."""

        imu: dict[str, Imu] | None = topic(topics.IMU)
        gnss: dict[str, Gnss] | None = topic(topics.GNSS)
        air_data: dict[str, AirData] | None = topic(topics.AIR_DATA)
        scan: dict[str, LaserScan] | None = topic(topics.SCAN)
        sonar: dict[str, Range] | None = topic(topics.SONAR)
        range: dict[str, Range] | None = topic(topics.RANGE)
        battery: dict[str, Battery] | None = topic(topics.BATTERY)
        joints: dict[str, JointStates] | None = topic(topics.JOINTS)
        truth: dict[str, NavState] | None = topic(topics.TRUTH)
        tf_static: dict[str, FrameTransforms] | None = topic(topics.TF_STATIC)
        events: dict[str, list[Event]] | None = topic(topics.EVENTS.by("sim_air"))
        spawned: SimObjects | None = topic(topics.AIR_OBJECTS)
        windsocks: FrameTransforms | None = topic(topics.WINDSOCKS)
        spawn: list[Reply] = replies(topics.AIR_SPAWN)
        remove: list[Reply] = replies(topics.AIR_REMOVE)
        set_pose: list[Reply] = replies(topics.AIR_POSE)
        wind: list[Reply] = replies(topics.WIND)
        save: list[Reply] = replies(topics.AIR_SAVE)
        restore: list[Reply] = replies(topics.AIR_RESTORE)

    def __init__(self, stage: AirStage, faults: Faults | None = None) -> None:
        self._stage = stage
        self._faults = faults or Faults()
        self._spawned_due = Due(topics.AIR_OBJECTS.hz)
        self._windsocks_due = Due(topics.WINDSOCKS.hz)
        self._had_spawned = False

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s, simulation]. Requests take effect at its end.

        truth: of the ground vehicles; that of the aircraft is known better here.
        """
        stage, n = self._stage, round(t * self.hz)
        flown = self._flown(t)
        for craft in stage.aircraft.values():
            if craft.name in now.surfaces:
                self._faults.spoil(t, craft.name, {"surfaces": now.surfaces[craft.name]})
                craft.take(now.surfaces[craft.name])
            else:
                craft.let_go()
            craft.fly_to(flown)
        self._collide(t, now.truth, now.objects)
        out, grounded = self._read_all(t), [o.name for o in now.objects.objects] if now.objects else []
        out.spawn = [stage.spawn(flown, r, grounded) for r in now.spawn]
        out.remove = [stage.remove(r) for r in now.remove]
        out.set_pose = [stage.set_pose(r) for r in now.set_pose]
        out.wind = [stage.blow(r) for r in now.wind]
        out.save = [stage.save(n, r) for r in now.save]
        out.restore = [stage.restore(n, r) for r in now.restore]
        out.spawned = self._spawned(t)
        if self._windsocks_due.at(t):
            out.windsocks = stage.windsocks.step(t, 1 / topics.WINDSOCKS.hz)
        return out

    def _flown(self, t: float) -> float:
        """s; the clock, unless a state was restored: then the aircraft's time, that of the state and what has passed since."""
        return (round(t * self.hz) - self._stage.late) / self.hz if self._stage.late else t

    def _spawned(self, t: float) -> SimObjects | None:
        """Told while there are any, and once when the last one has gone."""
        if not self._spawned_due.at(t):
            return None
        told = self._stage.objects(t)
        had, self._had_spawned = self._had_spawned, bool(told.objects)
        return told if told.objects or had else None

    def _collide(self, t: float, truth: Mapping[str, NavState], objects: SimObjects | None) -> None:
        """Whoever hits something falls from there; it is told once, of the first of a pair."""
        aircraft = self._stage.aircraft
        motions = {name: craft.motion for name, craft in aircraft.items()}
        self._stage.around.look(t, truth, objects, motions)
        for name, other in self._stage.collisions.step(motions):
            pair = [one for one in (aircraft[name], aircraft.get(other)) if one is not None]
            whole = [craft for craft in pair if craft.wreck is None]
            velocity = sum((one.motion.velocity for one in pair), np.zeros(3)) / 2 if other in truth or len(pair) > 1 else np.zeros(3)
            for i, craft in enumerate(whole):
                met = other if craft.name == name else name
                speed = np.linalg.norm(craft.motion.velocity)
                craft.end("" if i else f"{craft.name} hit {met} at {speed:.1f} m/s", craft.motion, velocity)

    def _read_all(self, t: float) -> Outputs:
        """What the sensors give, by output and aircraft, stamped by the clock."""
        stage, late = self._stage, self._stage.late / self.hz
        out = self.Outputs()
        for craft in stage.aircraft.values():
            for name, said in self._faults.spoil(t, craft.name, self._read(self._flown(t), craft)).items():
                out.add(name, craft.name, later(said, late) if late else said)
            if craft.name not in stage.told:
                out.add("tf_static", craft.name, sensor_frames(craft.name, craft.file.sensors, t))
                stage.told.add(craft.name)
        return out

    def _read(self, t: float, craft: Aircraft) -> dict[str, Value]:
        """What this aircraft's sensors give at ``t``."""
        motion = craft.motion
        read: dict[str, Value] = {}
        if craft.imu is not None and (reading := craft.imu.read(t, motion)) is not None:
            read["imu"] = imu_message(f"{craft.name}/{craft.imu.frame}", reading)
        if craft.gnss is not None and (fix := craft.gnss.read(t, motion)) is not None:
            read["gnss"] = gnss_message(craft.gnss.data, fix)
        if craft.pressures is not None and (sample := craft.pressures.read(t, craft.air)) is not None:
            read["air_data"] = readings.air_data(sample.t, sample.air)
        if craft.rangers is not None:
            read |= craft.rangers.read(t, motion, partial(self._stage.around.others, craft.name))
        if craft.charge is not None and craft.battery_due.at(t):
            read["battery"] = battery_message(t, craft.charge)
        if craft.joints_due.at(t):
            read["joints"] = readings.joints(t, craft.joints(), craft.throttle)
        if craft.ended:
            read["events"] = readings.crashed(t, craft.ended)
            craft.ended = ""
        if craft.truth_due.at(t):
            read["truth"] = readings.nav_state(t, motion, craft.wind)
        return read
