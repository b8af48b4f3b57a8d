"""The aircraft of a mission, flown by JSBSim: surfaces in, sensors and truth out."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Protocol

from schemas import topics
from schemas.messages import NavState, SurfaceCommand
from services.sim_air import readings
from services.sim_air.actuators import Actuators
from services.sim_air.airframe import Air, Controls, Motion
from services.sim_air.sensors import Charge, Gnss, Imu, Pressures
from uvf.maths.rotations import Floats
from uvf.maths.sampling import Due
from uvf.runtime.sensor_frames import sensor_frames
from uvf.runtime.sensor_messages import gnss_message, imu_message
from uvf.runtime.service import Outputs, Service, Value, each_vehicle, optional
from uvf.runtime.vehicle_file import VehicleFile


class Body(Protocol):
    """What flies: ``airframe.Airframe`` or a test's own."""

    def command(self, controls: Controls) -> None: ...
    def step(self) -> None: ...
    def motion(self) -> Motion: ...
    def air(self) -> Air: ...

    @property
    def propeller_speed(self) -> float: ...
    @property
    def shaft_power(self) -> float: ...


class Aircraft:
    """One aircraft with its servos and sensors; absent sensors are not fitted."""

    def __init__(self, name: str, file: VehicleFile, body: Body, actuators: Actuators) -> None:
        assert file.air is not None
        self.name = name
        self.file = file
        self.body = body
        self.actuators = actuators
        self.trim = actuators.position
        self.command = actuators.position
        self.dt = 1 / file.air.physics_hz
        self.physics_steps = 0
        self.imu: Imu | None = None
        self.gnss: Gnss | None = None
        self.pressures: Pressures | None = None
        self.charge = Charge(file.air.battery) if file.air.battery else None
        self.joints_due = Due(topics.JOINTS.hz)
        self.truth_due = Due(topics.TRUTH.hz)
        self.battery_due = Due(topics.BATTERY.hz)

    def take(self, command: SurfaceCommand) -> None:
        """A command with a number that is not finite is none: the engine would not recover from it."""
        s = (command.aileron, command.elevator, command.rudder, command.throttle)
        if all(map(math.isfinite, s)):
            self.command = Controls(*s)

    def let_go(self) -> None:
        """Nobody steers: what servos fall back to, the start's trim of level flight. A motor that was off stays off."""
        self.command = self.trim if self.command.throttle > 0 else replace(self.trim, throttle=0.0)

    def fly_to(self, t: float) -> None:
        """Physics steps up to ``t`` [s]."""
        due = round(t / self.dt)
        while self.physics_steps < due:
            self.body.command(self.actuators.step(self.command, self.dt))
            self.body.step()
            self.physics_steps += 1
            if self.charge is not None:
                self.charge.draw(self.body.shaft_power, self.dt)


class SimAir(Service):
    """All aircraft of the mission in one steady wind; without a command for 0.5 s surfaces and throttle go to trim."""

    name = "sim_air"
    hz = 100.0
    scope = "world"
    simulator = True
    inputs = {"surfaces": each_vehicle(optional(topics.SURFACE_COMMAND))}
    outputs = {
        "imu": topics.IMU,
        "gnss": topics.GNSS,
        "air_data": topics.AIR_DATA,
        "battery": topics.BATTERY,
        "joints": topics.JOINTS,
        "truth": topics.TRUTH,
        "tf_static": topics.TF_STATIC,
    }

    def __init__(self, aircraft: list[Aircraft], wind: Floats) -> None:
        self._aircraft = aircraft
        self._wind = wind
        self._first = True

    def step(self, t: float, surfaces: Mapping[str, SurfaceCommand]) -> Outputs:
        out: dict[str, dict[str, Value]] = {name: {} for name in self.outputs}
        for craft in self._aircraft:
            if craft.name in surfaces:
                craft.take(surfaces[craft.name])
            else:
                craft.let_go()
            craft.fly_to(t)
            for name, message in self._read(t, craft).items():
                out[name][craft.name] = message
        self._first = False
        return out

    def _read(self, t: float, craft: Aircraft) -> dict[str, Value]:
        """What this aircraft's sensors give at ``t``."""
        motion = craft.body.motion()
        read: dict[str, Value] = {}
        if self._first:
            read["tf_static"] = sensor_frames(craft.name, craft.file.sensors, t)
        if craft.imu is not None and (reading := craft.imu.read(t, motion)) is not None:
            read["imu"] = imu_message(f"{craft.name}/{craft.imu.frame}", reading)
        if craft.gnss is not None and (fix := craft.gnss.read(t, motion)) is not None:
            read["gnss"] = gnss_message(craft.gnss.data, fix)
        if craft.pressures is not None and (sample := craft.pressures.read(t, craft.body.air)) is not None:
            read["air_data"] = readings.air_data(sample.t, sample.air)
        if craft.charge is not None and craft.battery_due.at(t):
            read["battery"] = readings.battery(t, craft.charge)
        if craft.joints_due.at(t):
            read["joints"] = readings.joints(t, craft.actuators.position, craft.body.propeller_speed)
        if craft.truth_due.at(t):
            read["truth"] = self._truth(t, motion)
        return read

    def _truth(self, t: float, motion: Motion) -> NavState:
        return readings.nav_state(t, motion, self._wind)
