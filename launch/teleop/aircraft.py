"""``uvf teleop`` of an aircraft: its surfaces, throttle and brakes, and where it is."""

from math import degrees
from typing import NamedTuple, Protocol

from launch.teleop.link import SOURCE, TeleopLink
from schemas import topics
from schemas.messages import Mode, SurfaceCommand
from uvf.client import Client
from uvf.control.teleop_drive import GamepadState
from uvf.control.teleop_flight import PARKED, FlightTeleop, SurfaceLimits, SurfaceSetting
from uvf.maths.rotations import enu_flu_from_ned_frd, to_euler
from uvf.models.vehicle.air import AirBody
from uvf.runtime.messages.convert import wxyz

GREETING = """w s or up, down: nose down, up    a d or left, right: roll    q e: rudder    space, c: centre    n: trim the elevator here
r f: throttle up, down    t g: flaps out, in    b: brakes on, off    m: take over again    x or Ctrl-C: end (the autopilot holds)
gamepad: hold the left shoulder button; left stick: roll, pitch; right: throttle, rudder; d-pad: trim, flaps; B: brakes"""
UNHEARD = "no state heard yet"
HEARD_WITHIN = 5.0  # s, before it is taken over
BANKED = 0.5  # rad, from where on a turn takes 14 % more lift: its elevator is not that of straight flight
TURNING = "taken over in a turn: n trims the elevator once it flies level"
TOLD = (topics.STATUS, topics.NAV_STATE, topics.SURFACE_COMMAND)


class FlownState(NamedTuple):
    """What is known of the aircraft's state."""

    by_hand: bool
    """It is in mode Manual."""
    landed: bool
    surfaces: SurfaceSetting
    airspeed: float = 0.0  # m/s
    height: float = 0.0  # m above the world's origin
    attitude: tuple[float, float, float] = (0.0, 0.0, 0.0)  # rad: roll right, pitch up, heading from north


class AircraftPost(Protocol):
    """The connection to one aircraft."""

    def send(self, setting: SurfaceSetting) -> None:
        """Sends deflections of the surfaces, throttle and brakes."""
        ...

    def take_over(self) -> str:
        """Asks for mode MANUAL and arms; what was refused and why, "" if nothing."""
        ...

    def state(self) -> str:
        """State of the connection, in words."""
        ...

    def flight(self, patience: float = 0.0) -> FlownState | None:
        """State of the aircraft; None when not all of it has been heard within ``patience`` [s]."""


class AirLink:
    """The connection to an aircraft over the bus."""

    def __init__(self, client: Client, name: str) -> None:
        self._client, self._name = client, name
        self._link = TeleopLink(client)

    def send(self, setting: SurfaceSetting) -> None:
        """Publishes the surface command."""
        self._client.send(self._name, topics.SURFACES.by(SOURCE), SurfaceCommand(**setting._asdict()))

    def take_over(self) -> str:
        """Asks for mode MANUAL and arms; what was refused and why, "" if nothing."""
        return self._link.take_over(self._name)

    def state(self) -> str:
        """State of the connection, in words."""
        return self._link.state(self._name)

    def flight(self, patience: float = 0.0) -> FlownState | None:
        """State of the aircraft from its newest messages; None when not all have been heard within ``patience`` [s]."""
        client, name = self._client, self._name
        try:
            client.wait(lambda: min(client.heard(name, topic) for topic in TOLD) > 0, patience)
        except TimeoutError:
            return None
        status, nav = client.read(name, topics.STATUS), client.read(name, topics.NAV_STATE)
        told = client.read(name, topics.SURFACE_COMMAND)
        return FlownState(
            by_hand=status.mode == Mode.MODE_MANUAL,
            landed=status.landed,
            surfaces=SurfaceSetting(*(getattr(told, field) for field in SurfaceSetting._fields)),
            airspeed=nav.airspeed,
            height=nav.position.z,
            attitude=to_euler(enu_flu_from_ned_frd(wxyz(nav.orientation))),
        )


class Cockpit:
    """The control post of an aircraft's pilot. It sends commands all the time, so that the autopilot notices a pilot who falls silent."""

    def __init__(self, stick: FlightTeleop, aircraft: AircraftPost) -> None:
        self._stick, self._aircraft = stick, aircraft
        self._ours = False
        """The stick is where the surfaces are."""

    def take_over(self) -> str:
        """Takes over once the surfaces' deflections are known: a flying aircraft is not taken over with its motor off."""
        flight = self._aircraft.flight(HEARD_WITHIN)
        if flight is None:
            return f"{UNHEARD}: m tries again"
        self._follow(flight)
        self._aircraft.send(self._stick.setting)
        return self._aircraft.take_over() or ("" if _straight(flight) else TURNING)

    def key(self, t: float, name: str) -> None:
        """Passes a key on to the stick; ``t`` [s] is not used."""
        self._stick.key(name.lower())

    def turn(self, t: float, pad: GamepadState) -> None:
        """Takes the gamepad at ``t`` [s], and sends the surface command once the stick has been aligned with the surfaces."""
        self._stick.pad(t, pad)
        flight = self._aircraft.flight()
        if flight is not None and self._ours:
            self._follow(flight)
            self._aircraft.send(self._stick.setting)

    def line(self, t: float, pad: str) -> str:
        """Status line for the terminal: link, instruments, surfaces, gamepad ``pad``; ``t`` [s] is not used."""
        flight, s = self._aircraft.flight(), self._stick.setting
        parts = [self._aircraft.state(), _instruments(flight) if flight is not None else UNHEARD]
        parts.append(f"ail {_deg(s.aileron)} ele {_deg(s.elevator)} rud {_deg(s.rudder)} flap {degrees(s.flap):.0f}")
        parts.append(f"thr {100 * s.throttle:.0f} %" + (" BRAKES" if s.brake else ""))
        return " | ".join([*parts, pad] if pad else parts)

    def leave(self) -> None:
        """Sends nothing more: in the air the autopilot holds, on the ground the motor stops and the brakes are on."""

    def _follow(self, flight: FlownState) -> None:
        """While somebody else flies, the stick goes along; an aircraft on the ground is taken over from the autopilot parked."""
        if not flight.by_hand:
            self._stick.follow(PARKED if flight.landed else flight.surfaces, _straight(flight))
        elif not self._ours:
            self._stick.follow(flight.surfaces, _straight(flight))
        self._ours = True


def cockpit(client: Client, name: str, body: AirBody) -> Cockpit:
    """The control post of a vehicle, with the travel of its surfaces."""
    controls = body.controls
    limits = SurfaceLimits(controls.aileron.limit, controls.elevator.limit, controls.rudder.limit, controls.flap.limit)
    return Cockpit(FlightTeleop(limits), AirLink(client, name))


def _straight(flight: FlownState) -> bool:
    return abs(flight.attitude[0]) < BANKED


def _instruments(flight: FlownState) -> str:
    roll, pitch, heading = (degrees(angle) for angle in flight.attitude)
    return f"{flight.airspeed:.1f} m/s {flight.height:.0f} m roll {roll:+.0f} pitch {pitch:+.0f} hdg {heading % 360:03.0f}"


def _deg(angle: float) -> str:
    return f"{degrees(angle):+.1f}"
