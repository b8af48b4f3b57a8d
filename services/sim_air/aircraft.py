"""One aircraft of the simulation: its body, its servos, its sensors, the air about it, and how it ends."""

import copy
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol, Self

import numpy as np

from schemas import topics
from schemas.messages import SurfaceCommand
from services.sim_air.actuators import Actuators
from services.sim_air.contact.crash import Resting, Wreck, crash_of
from services.sim_air.engine.contacts import GroundTouch
from services.sim_air.engine.engine_state import EngineState
from services.sim_air.engine.states import Air, AircraftMotion, InitialState, Runaway
from services.sim_air.engine.trim import TrimAttitude
from services.sim_air.engine.wiring import Controls, JointAngle
from services.sim_air.environment.wind import CALM, AirMass, AirMotion, AirRelativeState
from services.sim_air.launcher import AircraftLauncher
from services.sim_air.rangers import Rangers
from services.sim_air.sensors import Gnss, Imu, PressureSensors
from uvf.maths.rotations import Floats
from uvf.models.mission import file as mission_file
from uvf.models.vehicle.battery import Charge
from uvf.models.vehicle.file import VehicleFile
from uvf.sensors.sampling import Due

STILL = np.zeros(3)


class AircraftBody(Protocol):
    """The flight dynamics: ``airframe.Airframe`` or a test's own. ``step`` may raise Runaway."""

    def command(self, controls: Controls) -> None:
        """Sets deflections, throttle and brake, held until the next call."""
        ...

    def step(self) -> None:
        """Makes one physics step."""
        ...

    def motion(self) -> AircraftMotion:
        """True motion now."""
        ...

    def air(self) -> Air:
        """The air about the aircraft now."""
        ...

    def set_wind(self, air: AirMotion) -> None:
        """Sets velocity and rotation of the air until the next call."""
        ...

    def flight(self) -> AirRelativeState:
        """The state that the wind model depends on."""
        ...

    def joints(self) -> list[JointAngle]:
        """Angles and speeds of the moving parts."""
        ...

    def release(self, start: InitialState, lies: TrimAttitude, wind: Floats) -> None:
        """Lets it go in flight: velocity over ground of ``start``, attitude, wind (3,) [m/s, world]."""
        ...

    def touches(self) -> list[GroundTouch]:
        """Its points that touch the ground."""
        ...

    def save(self) -> EngineState:
        """Its state, from which ``restored`` makes another one."""
        ...

    def restored(self, state: EngineState) -> "AircraftBody":
        """Another body that goes on from a saved state."""
        ...

    @property
    def motor_power(self) -> float:
        """Electric power [W] drawn by all motors; 0 without a battery."""
        ...


Begin = Callable[[mission_file.StartPose], tuple[AircraftBody, Controls, Controls]]
"""A new body of an aircraft, its controls there and those of level flight. Raises BadInput."""


class Aircraft:
    """One simulated aircraft. Absent sensors are None. ``trim``: the controls of level flight, used without a command."""

    def __init__(self, name: str, file: VehicleFile, body: AircraftBody, actuators: Actuators, trim: Controls) -> None:
        assert file.air is not None
        self.name = name
        self.file = file
        self.body = body
        self.actuators = actuators
        self.trim = trim
        self.command = actuators.position
        self.dt = 1 / file.air.physics_hz
        self.physics_steps = 0
        self.motion = body.motion()
        self.wreck: Wreck | None = None
        self.launcher: AircraftLauncher | None = None
        """What holds it until it flies."""
        self.ended = ""
        """Why it lies where it lies, until it is told."""
        self.imu: Imu | None = None
        self.gnss: Gnss | None = None
        self.pressures: PressureSensors | None = None
        self.rangers: Rangers | None = None
        self.air_mass: AirMass | None = None
        self.wind = CALM
        """(3,) m/s, world: the air about it now."""
        self.charge = Charge(file.air.battery) if file.air.battery else None
        self.joints_due = Due(topics.JOINTS.hz)
        self.truth_due = Due(topics.TRUTH.hz)
        self.battery_due = Due(topics.BATTERY.hz)
        self.begin: Begin | None = None
        self.rests: Resting | None = None
        """How it lies when it is a wreck; without it that stays in the air."""
        self._max_sink = file.air.max_sink

    def begin_anew(self, start: mission_file.StartPose) -> None:
        """Restarts it elsewhere, undamaged; sensors and battery go on. Raises BadInput, and is then as it was."""
        assert self.file.air is not None and self.begin is not None
        body, now, level = self.begin(start)
        self.body, self.trim, self.command = body, level, now
        self.actuators = Actuators(now, self.file.air)
        self.motion = body.motion()
        self.wreck, self.launcher, self.ended = None, None, ""

    def wait_until(self, t: float) -> None:
        """Sets its time to ``t`` [s], at which it begins."""
        self.physics_steps = round(t / self.dt)

    def keep(self) -> "SavedAircraft":
        """Saves its state. A wreck's body does nothing any more, and its numbers may be invalid: it is left out."""
        return SavedAircraft(copy.deepcopy(self), None if self.wreck else self.body.save())

    def __deepcopy__(self, memo: dict[int, object]) -> Self:
        """One that goes on from here by itself but for the body, which ``SavedAircraft.again`` makes anew."""
        memo |= {id(part): part for part in (self.file, self.body, self.begin)}
        twin = object.__new__(type(self))
        twin.__dict__ = copy.deepcopy(self.__dict__, memo)
        return twin

    def take(self, command: SurfaceCommand) -> None:
        """Takes a surface command; one with a non-finite number is ignored, for the engine would not recover from it."""
        s = (command.aileron, command.elevator, command.rudder, command.throttle, command.flap, command.brake, command.brake_difference)
        if all(map(math.isfinite, s)):
            self.command = Controls(*s)

    def let_go(self) -> None:
        """Without a command: servos go to the trim of level flight. A motor that was off stays off, and the wheels are braked."""
        self.command = self.trim if self.command.throttle > 0 else replace(self.trim, throttle=0.0, brake=1.0)

    def fly_to(self, t: float) -> None:
        """Makes physics steps up to ``t`` [s]."""
        due = round(t / self.dt)
        while self.physics_steps < due:
            if self.wreck is not None:
                self.wreck.fall(self.dt)
            elif self.launcher is not None:
                self._wait_for(self.launcher)
            else:
                self._step()
            self.physics_steps += 1
            if self.charge is not None:
                self.charge.draw(0.0 if self.wreck or self.launcher else self.body.motor_power, self.dt)
        self.motion = self._motion()

    def blow(self, steady: Floats) -> None:
        """Puts it into another mean wind (3,) [m/s, world], without shear."""
        if self.air_mass is None:
            return
        self.air_mass.blow(steady)
        if self.air_mass.is_steady:
            self.wind = self.air_mass.mean(self.body.flight().height)
            self.body.set_wind(AirMotion(self.wind, CALM))

    def _motion(self) -> AircraftMotion:
        if self.wreck is not None:
            return self.wreck.motion
        return self.body.motion() if self.launcher is None else self.launcher.motion(self.wind)

    def _wait_for(self, launcher: AircraftLauncher) -> None:
        """Held, or pushed; its surfaces move. It is ready when the brakes are let go of: it is armed."""
        self.actuators.step(self.command, self.dt)
        if self.air_mass is not None and not self.air_mass.is_steady:
            self.wind = self.air_mass.step(self.physics_steps * self.dt, self.dt, launcher.flight(self.wind)).velocity
        released = launcher.step(self.command.brake == 0.0, self.dt)
        if released is not None:
            self.body.release(released.start, released.lies, self.wind)
            self.body.command(self.actuators.position)
            self.launcher = None

    def _step(self) -> None:
        if self.air_mass is not None and not self.air_mass.is_steady:
            moving = self.air_mass.step(self.physics_steps * self.dt, self.dt, self.body.flight())
            self.body.set_wind(moving)
            self.wind = moving.velocity
        wanted = self.command
        if self.charge is not None:
            left = self.charge.throttle(wanted.throttle)
            wanted = wanted if left == wanted.throttle else replace(wanted, throttle=left)
        self.body.command(self.actuators.step(wanted, self.dt))
        try:
            self.body.step()
        except Runaway as error:
            self.end(f"its motion ran away ({error}); a higher physics_hz may help", self.motion)
            return
        if touches := self.body.touches():
            motion = self.body.motion()
            if reason := crash_of(touches, motion, self._max_sink):
                self.end(reason, motion)

    def end(self, reason: str, motion: AircraftMotion, velocity: Floats = STILL) -> None:
        """Makes it a wreck: motor off, it falls from where it is with a remaining ``velocity`` (3,) [m/s, world]."""
        self.ended = reason
        self.wreck = Wreck(replace(motion, velocity=velocity), self.body.air(), self.body.joints(), self.rests)

    def air(self) -> Air:
        """The air about the aircraft now."""
        if self.wreck is not None:
            return self.wreck.air
        return self.body.air() if self.launcher is None else self.launcher.air(self.wind)

    def joints(self) -> list[JointAngle]:
        """Angles and speeds of the moving parts."""
        return self.wreck.joints if self.wreck else self.body.joints()

    @property
    def throttle(self) -> float:
        """Throttle after its servo, 0..1 [-]; 0 of a wreck."""
        return 0.0 if self.wreck else self.actuators.position.throttle


@dataclass(frozen=True)
class SavedAircraft:
    """A saved aircraft and the state of its engine."""

    aircraft: Aircraft
    engine: EngineState | None

    def again(self) -> Aircraft:
        """A new aircraft that goes on from there, identically each time."""
        twin = copy.deepcopy(self.aircraft)
        if self.engine is not None:
            twin.body = twin.body.restored(self.engine)
        return twin
