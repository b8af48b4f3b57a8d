"""The ``air:`` section of a vehicle.yaml: a JSBSim aircraft and how to command and read it."""

import re
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from uvf.models.keys import key, plain
from uvf.models.quantities import Name, NotNegative, PhysicsRate, Positive
from uvf.models.vehicle.looks import Looks
from uvf.models.yaml_data import BadInput, FileLocation

Deflection = Annotated[float, Meta(ge=0.01, le=1.6)]
Travel = Annotated[float, Meta(ge=0, le=1.6)]
PropertyName = Annotated[str, Meta(pattern=r"^/?[A-Za-z_][A-Za-z0-9_./\[\]-]*\Z", max_length=200)]
"""Of a JSBSim property: fcs/aileron-cmd-norm, fcs/throttle-cmd-norm[1]."""
Properties = str | list[str]  # not of PropertyName: constraints in such a union end some processes with a crash (msgspec issue 717)
UNITS = ("-rad", "-deg", "-norm", "-rpm", "-rad_sec")
STANDARD: dict[str, tuple[str, ...]] = {
    "aileron": ("fcs/aileron-cmd-norm",),
    "elevator": ("fcs/elevator-cmd-norm",),
    "rudder": ("fcs/rudder-cmd-norm",),
    "flap": ("fcs/flap-cmd-norm",),
    "throttle": ("fcs/throttle-cmd-norm",),
    "brake": ("fcs/left-brake-cmd-norm", "fcs/right-brake-cmd-norm"),
}
"""What JSBSim's own aircraft are commanded by."""


class Surface(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Deflection to property: sign * deflection / limit. No ``property`` = JSBSim's standard one; rate and lag, where not the servos'."""

    property: Annotated[Properties, plain("JSBSim property or properties that are written; left out: the standard one.")] = []
    limit: Annotated[Travel, key("rad", "Deflection at full command; 0: there is no such surface.")] = 0.35
    negative_limit: Annotated[Travel | None, key("rad", "Deflection at full command the other way; left out: `limit`.")] = None
    sign: Annotated[Literal[1, -1], plain("1 or -1: the property's sense against that of the [convention](frames.md).")] = 1
    rate: Annotated[Positive | None, key("rad/s", "Largest rate; left out: `servo_rate`.")] = None
    lag: Annotated[NotNegative | None, key("s", "Time constant; left out: `servo_lag`.")] = None

    def lowest(self) -> float:
        """The most negative deflection [rad]."""
        return -(self.limit if self.negative_limit is None else self.negative_limit)

    def reaches(self, deflection: float) -> bool:
        """Whether a deflection [rad] lies within the stops."""
        return self.lowest() <= deflection <= self.limit

    def norm(self, deflection: float) -> float:
        """Command of a deflection [rad], 1 and -1 at full; 0 where there is no such surface."""
        full = self.limit if deflection >= 0 else -self.lowest()
        return deflection / full if full else 0.0

    def deflection(self, norm: float) -> float:
        """Deflection [rad] at a command, 1 and -1 at full."""
        return norm * (self.limit if norm >= 0 else -self.lowest())


class Lever(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What goes from 0 to 1: a throttle, with one property an engine, or brakes."""

    property: Annotated[Properties, plain("JSBSim property or properties that are written; left out: the standard one.")] = []
    lag: Annotated[NotNegative, key("s", "Time constant.")] = 0.0


class CommandProperties(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What each field of a SurfaceCommand is written to."""

    aileron: Annotated[Surface, plain("Ailerons; positive rolls right.")] = Surface()
    elevator: Annotated[Surface, plain("Elevator; positive pitches down.")] = Surface()
    rudder: Annotated[Surface, plain("Rudder; positive yaws left.")] = Surface()
    flap: Annotated[Surface, plain("Flaps; positive is down.")] = Surface(limit=0.6)
    throttle: Annotated[Lever, plain("Throttle of the engines, 0 to 1.")] = Lever()
    brake: Annotated[Lever, plain("Wheel brakes, 0 to 1.")] = Lever()

    def properties(self, name: str) -> tuple[str, ...]:
        """Names of the JSBSim properties that this command is written to."""
        given: str | list[str] = getattr(self, name).property
        return (given,) if isinstance(given, str) else tuple(given) or STANDARD[name]


class JointReading(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """JSBSim properties that a joint is read from; the unit is the suffix of the property's name, ``-norm`` counts in ``limit``."""

    position: Annotated[PropertyName | None, plain("JSBSim property of the joint's position; it ends in -rad, -deg or -norm.")] = None
    speed: Annotated[PropertyName | None, plain("JSBSim property of the joint's speed; it ends in -rpm or -rad_sec.")] = None
    limit: Annotated[Deflection, key("rad", "Angle at 1, of a property in -norm.")] = 1.0
    sign: Annotated[Literal[1, -1], plain("1 or -1.")] = 1


STANDARD_JOINTS = {
    "left_aileron": JointReading(position="fcs/left-aileron-pos-rad"),
    "right_aileron": JointReading(position="fcs/right-aileron-pos-rad"),
    "elevator": JointReading(position="fcs/elevator-pos-rad"),
    "rudder": JointReading(position="fcs/rudder-pos-rad"),
    "flap": JointReading(position="fcs/flap-pos-rad"),
    "propeller": JointReading(speed="propulsion/engine/propeller-rpm"),
}
"""Told when the vehicle's file names none, as far as the model has them."""


class BatteryPack(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A pack whose open-circuit voltage falls in a straight line with its charge, behind a resistance.

    rated: the motors' voltage at full throttle, of which they get no more than the battery has; without it they do not feel the
    voltage. power: the property that tells what the motors draw [W]; without it, their shaft power over ``efficiency``.
    """

    energy: Annotated[Positive, key("J", "Energy of the full pack.")]
    full: Annotated[Positive, key("V", "Open-circuit voltage of the full pack.")]
    empty: Annotated[Positive, key("V", "Open-circuit voltage of the empty pack.")]
    resistance: Annotated[float, Meta(ge=0, le=10), key("ohm", "Resistance of cells and wires.")] = 0.0
    rated: Annotated[
        Positive | None, key("V", "Voltage of an aircraft's motors at full throttle; left out: they do not feel the battery's voltage.")
    ] = None
    avionics: Annotated[NotNegative, key("W", "Power that is drawn at all times.")] = 0.0
    power: Annotated[
        PropertyName | None,
        plain("JSBSim property of the power that the motors draw [W]; left out: their shaft power over `efficiency`. Aircraft only."),
    ] = None
    efficiency: Annotated[float, Meta(gt=0, le=1), key("", "Efficiency of motor and speed controller together.")] = 0.85


class AirBody(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A JSBSim aircraft: the model's name in the vehicle's folder, how to command it and what to read of it.

    settings: properties that are set once, before it flies: mixture, gear down.
    """

    model: Annotated[Name, plain("Name of the JSBSim model: the folder and the XML file in it.")]
    physics_hz: Annotated[PhysicsRate, key("Hz", "Physics steps per second of simulation time.")]
    trim_speed: Annotated[Positive, key("m/s", "Airspeed at which the aircraft starts in level flight.")]
    servo_rate: Annotated[Positive | None, key("rad/s", "Largest rate of a surface; `null`: none.")]
    servo_lag: Annotated[NotNegative, key("s", "Time constant of a servo.")]
    controls: Annotated[CommandProperties, plain("What the commands are written to.")] = CommandProperties()
    joints: Annotated[
        dict[Name, JointReading], plain("Joints that `sensor/joints` reports, by name; left out: the standard surfaces and the propeller.")
    ] = {}
    settings: Annotated[dict[PropertyName, float], plain("JSBSim properties that are set at the start: mixture, gear down.")] = {}
    max_sink: Annotated[
        Positive, key("m/s", "Sink rate at touchdown that the landing gear survives; 10 ft/s of 14 CFR 23.473 by default.")
    ] = 3.05
    skids: Annotated[list[str], plain("Parts of its structure, contacts of the JSBSim model, on which it may slide over the ground.")] = []
    mesh: Annotated[Name | None, plain("STL or OBJ file that is drawn instead of `looks`.")] = None
    battery: Annotated[BatteryPack | None, plain("Battery of an electric aircraft.")] = None
    looks: Annotated[Looks, plain("How the aircraft is drawn; left out: derived from the JSBSim model.")] = Looks()

    def lag_of(self, surface: Surface) -> float:
        """Time constant [s] of the servo of a surface."""
        return self.servo_lag if surface.lag is None else surface.lag


def unnumbered(name: str) -> str:
    """Name of a property without the number at its end."""
    return re.sub(r"\[\d+\]$", "", name)


def check_battery(pack: BatteryPack, place: FileLocation) -> None:
    """Checks the voltages of a battery. Raises BadInput."""
    if pack.empty >= pack.full:
        raise BadInput(f"{place}: empty at {pack.empty:g} V, full at {pack.full:g} V; exchange them")
    if pack.rated is not None and pack.rated > pack.full:
        raise BadInput(f"{place.at('rated')}: {pack.rated:g} V, but full it has {pack.full:g} V; give it more cells")


def check_air(air: AirBody, place: FileLocation) -> None:
    """Checks what the types of the ``air`` section do not say. Raises BadInput."""
    if air.battery is not None:
        check_battery(air.battery, place.at("battery"))
    for name, joint in air.joints.items():
        at = place.at("joints", name)
        if (joint.position is None) == (joint.speed is None):
            raise BadInput(f"{at}: give either position: or speed:, the property that tells it")
        wanted = UNITS[:3] if joint.speed is None else UNITS[3:]
        told = joint.position or joint.speed or ""
        if not unnumbered(told).endswith(wanted):
            raise BadInput(f"{at}: the unit of '{told}' is not known; take a property that ends in {', '.join(wanted)}")
