"""The ``air:`` section of a vehicle.yaml: a JSBSim aircraft and how to command and read it."""

import re
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from uvf.models.quantities import Name, NotNegative, PhysicsRate, Positive
from uvf.models.vehicle.looks import Looks
from uvf.models.yaml_data import BadInput, FileLocation

Deflection = Annotated[float, Meta(ge=0.01, le=1.6)]
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

    property: Properties = []
    limit: Deflection = 0.35  # rad, at full command
    sign: Literal[1, -1] = 1
    rate: Positive | None = None  # rad/s
    lag: NotNegative | None = None  # s


class Lever(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What goes from 0 to 1: a throttle, with one property an engine, or brakes."""

    property: Properties = []
    lag: NotNegative = 0.0  # s


class CommandProperties(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What each field of a SurfaceCommand is written to."""

    aileron: Surface = Surface()
    elevator: Surface = Surface()
    rudder: Surface = Surface()
    flap: Surface = Surface(limit=0.6)
    throttle: Lever = Lever()
    brake: Lever = Lever()

    def properties(self, name: str) -> tuple[str, ...]:
        """The names of what this command is written to."""
        given: str | list[str] = getattr(self, name).property
        return (given,) if isinstance(given, str) else tuple(given) or STANDARD[name]


class JointReading(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Where a joint is told from; the unit is the end of the property's name, of ``-norm`` times ``limit``."""

    position: PropertyName | None = None  # -rad, -deg or -norm
    speed: PropertyName | None = None  # -rpm or -rad_sec
    limit: Deflection = 1.0  # rad at 1, of a -norm
    sign: Literal[1, -1] = 1


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

    energy: Positive  # J
    full: Positive  # V
    empty: Positive  # V
    resistance: Annotated[float, Meta(ge=0, le=10)] = 0.0  # ohm, of cells and wires
    rated: Positive | None = None  # V
    avionics: NotNegative = 0.0  # W, drawn at all times
    power: PropertyName | None = None
    efficiency: Annotated[float, Meta(gt=0, le=1)] = 0.85  # of motor and speed controller together


class AirBody(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A JSBSim aircraft: the model's name in the vehicle's folder, how to command it and what to read of it.

    settings: properties that are set once, before it flies: mixture, gear down.
    """

    model: Name
    physics_hz: PhysicsRate
    trim_speed: Positive  # m/s
    servo_rate: Positive  # rad/s
    servo_lag: NotNegative  # s
    controls: CommandProperties = CommandProperties()
    joints: dict[Name, JointReading] = {}
    settings: dict[PropertyName, float] = {}
    max_sink: Positive = 3.05  # m/s at which the landing gear still holds; 10 ft/s, the most that 14 CFR 23.473 asks for
    mesh: Name | None = None
    battery: BatteryPack | None = None
    looks: Looks = Looks()


def unnumbered(name: str) -> str:
    """A property's name without the number at its end."""
    return re.sub(r"\[\d+\]$", "", name)


def check_battery(pack: BatteryPack, place: FileLocation) -> None:
    """Raises BadInput."""
    if pack.empty >= pack.full:
        raise BadInput(f"{place}: empty at {pack.empty:g} V, full at {pack.full:g} V; exchange them")
    if pack.rated is not None and pack.rated > pack.full:
        raise BadInput(f"{place.at('rated')}: {pack.rated:g} V, but full it has {pack.full:g} V; give it more cells")


def check_air(air: AirBody, place: FileLocation) -> None:
    """What the types do not say. Raises BadInput."""
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
