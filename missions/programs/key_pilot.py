"""Flies a circuit by hand: reads the instruments and presses the keys of ``uvf teleop``, from take-off to standing on the strip.

What a pilot does with four keys: for each surface it knows where it wants it, and presses the key that moves it there, one step at a
time. The elevator follows pitch, the ailerons bank, the rudder the direction on the ground; throttle and flaps the phase of the flight.
"""

from enum import Enum
from math import atan, atan2, remainder, tau
from typing import Annotated, NamedTuple

from msgspec import Meta

from schemas import topics
from schemas.messages import Mode, NavState, Range, SurfaceCommand, VehicleStatus
from uvf.control.teleop_flight import STEP, FlightTeleop, SurfaceLimits
from uvf.maths.rotations import to_euler
from uvf.models.keys import key
from uvf.models.params import Params
from uvf.models.scenario import MissionVehicle
from uvf.runtime.contract.declaration import Reads, Writes, optional, topic
from uvf.runtime.contract.program import Program
from uvf.runtime.messages.convert import stamp, wxyz

Positive = Annotated[float, Meta(gt=0)]
RUNWAY = 0.0  # m, y of the strip, which runs from west to east
MOST_BANK = 0.5  # rad


class PilotParams(Params, frozen=True):
    """The circuit."""

    height: Annotated[Positive, key("m", "Height of the circuit.")] = 60.0
    east: Annotated[float, key("m", "Where it turns downwind.")] = 350.0
    abeam: Annotated[Positive, key("m", "Distance of the downwind leg from the strip.")] = 320.0
    west: Annotated[float, key("m", "Where it turns to the approach.")] = -800.0
    aim: Annotated[float, key("m", "Place on the strip that the approach leads to.")] = -90.0
    glide: Annotated[Positive, key("rad", "Angle of the approach.")] = 0.07
    flare: Annotated[Positive, key("m", "Height at which the throttle is closed.")] = 4.0


class Phase(Enum):
    """Parts of the flight, in their order."""

    ROLL = "take-off"
    CLIMB = "climb"
    CROSSWIND = "turn to downwind"
    DOWNWIND = "downwind"
    BASE = "turn to the approach"
    FINAL = "approach"
    FLARE = "flare"
    STOP = "roll-out"


class Instruments(NamedTuple):
    """What the pilot sees: m, m/s, rad, rad/s; roll right, pitch up, course and heading from east to the left."""

    x: float
    y: float
    height: float
    climb: float
    airspeed: float
    roll: float
    pitch: float
    heading: float
    course: float
    roll_rate: float
    pitch_rate: float


class KeyPilot(Program):
    """Flies in mode Manual as soon as it is armed, and presses nothing while somebody else flies."""

    name = "key_pilot"
    hz = 20.0

    class Inputs(Reads):
        """Instruments, the altimeter near the ground, and whether the pilot has the aircraft."""

        nav: NavState = topic(topics.NAV_STATE)
        status: VehicleStatus = topic(topics.STATUS)
        altimeter: Range | None = optional(topics.RANGE)

    class Outputs(Writes):
        """The surfaces as the keys have left them."""

        surfaces: SurfaceCommand | None = topic(topics.SURFACES.by("client"))

    def __init__(self, vehicle: MissionVehicle) -> None:
        super().__init__(vehicle)
        air = vehicle.file.air
        assert air is not None, "only aircraft have surfaces"
        controls = air.controls
        self._limits = SurfaceLimits(controls.aileron.limit, controls.elevator.limit, controls.rudder.limit, controls.flap.limit)
        self._cruise = air.trim_speed
        self._stick = FlightTeleop(self._limits)
        self._trim = 0.0  # rad, the elevator for level flight, as it is found
        self._power = 0.7
        self._stood: float | None = None  # rad, its pitch on its wheels
        self.params: PilotParams = vehicle.params(self.name, PilotParams)
        self.phase = Phase.ROLL

    def step(self, t: float, now: Inputs) -> Outputs:
        """Looks, presses, and sends what the surfaces are now."""
        if now.status.mode == Mode.MODE_MANUAL and now.status.armed:
            seen = _instruments(now)
            self._next_phase(seen)
            self._press(seen)
        return self.Outputs(surfaces=SurfaceCommand(timestamp=stamp(t), **self._stick.setting._asdict()))

    def _next_phase(self, seen: Instruments) -> None:
        p = self.params
        begins = {
            Phase.CLIMB: seen.height > 1.5,
            Phase.CROSSWIND: seen.x > p.east,
            Phase.DOWNWIND: seen.y > p.abeam - 40.0,
            Phase.BASE: seen.x < p.west,
            Phase.FINAL: seen.y < RUNWAY + 60.0,
            Phase.FLARE: seen.height < p.flare,
            Phase.STOP: seen.height < 0.9 and seen.climb > -0.5,
        }
        order = list(Phase)
        following = order[min(order.index(self.phase) + 1, len(order) - 1)]
        if begins.get(following, False):
            self.phase = following

    def _press(self, seen: Instruments) -> None:
        """At most one key for each surface: a key that is held repeats about as often."""
        on_ground = self.phase in (Phase.ROLL, Phase.STOP)
        pitch, bank = self._wanted_pitch(seen), 0.0 if on_ground else self._wanted_bank(seen)
        self._trim += 0.4 * (seen.pitch - pitch) / self.hz if not on_ground else 0.0
        limits = self._limits
        self._towards("elevator", self._trim + 1.0 * (seen.pitch - pitch) + 0.25 * seen.pitch_rate, limits.elevator, ("w", "s"))
        self._towards("aileron", 0.3 * (bank - seen.roll) - 0.06 * seen.roll_rate, limits.aileron, ("d", "a"))
        off = remainder(-seen.heading - 0.02 * (seen.y - RUNWAY), tau) if on_ground else 0.0
        self._towards("rudder", 0.8 * off, limits.rudder, ("q", "e"))
        self._towards("throttle", self._wanted_throttle(seen), 1.0, ("r", "f"))
        self._towards("flap", 0.5 * limits.flap if self.phase in (Phase.BASE, Phase.FINAL, Phase.FLARE) else 0.0, limits.flap, ("t", "g"))
        # Brakes only with the tail down, as it stood: an aircraft with a tail wheel would go over its nose.
        self._stood = seen.pitch if self._stood is None else self._stood
        if bool(self._stick.setting.brake) != (self.phase == Phase.STOP and seen.pitch > self._stood - 0.08):
            self._stick.key("b")

    def _towards(self, surface: str, wanted: float, limit: float, keys: tuple[str, str]) -> None:
        off = wanted - getattr(self._stick.setting, surface)
        if abs(off) > 0.5 * STEP * limit:
            self._stick.key(keys[0] if off > 0 else keys[1])

    def _wanted_pitch(self, seen: Instruments) -> float:
        if self.phase == Phase.ROLL:
            return 0.14 if seen.airspeed > 0.8 * self._cruise else 0.0
        if self.phase == Phase.FLARE:
            return min(0.06 + 0.1 * (-seen.climb - 0.4), 0.14)
        if self.phase == Phase.STOP:
            return 0.3  # more than it can have on its wheels: the stick is held back
        wanted_climb = min(max(0.25 * (self._wanted_height(seen) - seen.height), -2.5), 2.5)
        if self.phase == Phase.FINAL:
            wanted_climb -= self.params.glide * seen.airspeed
        return min(max(0.04 + (wanted_climb + 0.8 * (wanted_climb - seen.climb)) / self._cruise, -0.2), 0.2)

    def _wanted_height(self, seen: Instruments) -> float:
        if self.phase != Phase.FINAL:
            return self.params.height
        return min(self.params.height, (self.params.aim - seen.x) * self.params.glide)

    def _wanted_throttle(self, seen: Instruments) -> float:
        if self.phase in (Phase.ROLL, Phase.CLIMB) and seen.height < self.params.height - 10.0:
            return 1.0
        if self.phase in (Phase.FLARE, Phase.STOP):
            return 0.0
        speed = 0.8 * self._cruise if self.phase == Phase.FINAL else self._cruise
        self._power = min(max(self._power + 0.02 * (speed - seen.airspeed) / self.hz, 0.0), 1.0)
        return min(max(self._power + 0.08 * (speed - seen.airspeed), 0.0), 1.0)

    def _wanted_bank(self, seen: Instruments) -> float:
        """To the right; a line is followed by the course that leads to it, a turn ends in the next line."""
        if self.phase in (Phase.CROSSWIND, Phase.DOWNWIND):
            course = atan2(0.0, -1.0) + atan(0.01 * (seen.y - self.params.abeam))
        else:
            course = -atan(0.01 * (seen.y - RUNWAY))
        off = remainder(course - seen.course, tau)
        return min(max(-1.2 * off, -MOST_BANK), MOST_BANK)


def _instruments(now: KeyPilot.Inputs) -> Instruments:
    nav = now.nav
    roll, pitch, heading = to_euler(wxyz(nav.orientation))
    height = nav.position.z
    if now.altimeter is not None and 0.0 < now.altimeter.range < 20.0 and abs(roll) < 0.3:
        height = now.altimeter.range
    return Instruments(
        nav.position.x,
        nav.position.y,
        height,
        nav.velocity.z,
        nav.airspeed,
        roll,
        -pitch,  # the body's y is to the left: nose down is positive
        heading,
        atan2(nav.velocity.y, nav.velocity.x),
        nav.angular_velocity.x,
        -nav.angular_velocity.y,
    )
