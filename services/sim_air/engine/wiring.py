"""Which properties of the model the commands are written to and the joints are read from."""

import math
import re
from collections.abc import Callable, Collection
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple, Protocol

from uvf.models.vehicle.air import STANDARD_JOINTS, AirBody, JointReading, Lever, Surface, unnumbered
from uvf.models.yaml_data import BadInput, FileLocation, nearest

THROTTLE = re.compile(r"fcs/throttle-cmd-norm(\[\d+\])?")
MIXTURE = re.compile(r"fcs/(mixture|advance)-cmd-norm(\[\d+\])?")
"""Rich and fine, so that engines run at the start."""
IGNITION = {"propulsion/magneto_cmd": 3.0, "propulsion/starter_cmd": 1.0}
"""A second beginning of a piston engine does not turn them on by itself."""
SIDES = {"fcs/left-brake-cmd-norm": "left_brake", "fcs/right-brake-cmd-norm": "right_brake"}
STEERING = "fcs/steer-cmd-norm"
"""JSBSim turns a steerable wheel to the right at a positive command."""


@dataclass(frozen=True)
class Controls:
    """Deflections [rad] with the signs of SurfaceCommand; throttle and brake 0..1, brake_difference -1..1."""

    aileron: float = 0.0
    elevator: float = 0.0
    rudder: float = 0.0
    throttle: float = 0.0
    flap: float = 0.0
    brake: float = 0.0
    brake_difference: float = 0.0

    @property
    def left_brake(self) -> float:
        """0..1."""
        return min(max(self.brake + max(self.brake_difference, 0.0), 0.0), 1.0)

    @property
    def right_brake(self) -> float:
        """0..1."""
        return min(max(self.brake - min(self.brake_difference, 0.0), 0.0), 1.0)


class JointAngle(NamedTuple):
    """A moving part: position [rad], or speed [rad/s] of what rotates."""

    name: str
    position: float = 0.0
    speed: float = 0.0


class Properties(Protocol):
    """The model's properties, by name."""

    def __getitem__(self, name: str) -> float: ...
    def __setitem__(self, name: str, value: float) -> None: ...


class CommandLine(NamedTuple):
    """A field of Controls, the property that it is written to, and how."""

    name: str
    target: str
    command: Callable[[float], float]


def _norm(control: Surface | Lever, value: float) -> float:
    return control.sign * control.norm(value) if isinstance(control, Surface) else value


class Wiring:
    """Maps the controls of one aircraft to the model's properties."""

    def __init__(self, properties: Properties, known: Collection[str], body: AirBody, place: FileLocation) -> None:
        """known: the names the model has; place: of ``air:`` in the vehicle's file. Raises BadInput for what the model has not."""
        self._properties = properties
        self._known = known
        self._lines = [line for name in body.controls.__struct_fields__ for line in self._command(name, body, place.at("controls", name))]
        if STEERING in known and STEERING not in (line[1] for line in self._lines):
            rudder = body.controls.rudder
            self._lines.append(CommandLine("rudder", STEERING, lambda deflection: -rudder.norm(deflection)))
        self._joints = list(self._readers(body, place.at("joints")))
        if body.battery is not None and body.battery.power is not None:
            self._there(body.battery.power, place.at("battery", "power"))
        running = {name: 1.0 for name in known if MIXTURE.fullmatch(name)} | {n: v for n, v in IGNITION.items() if n in known}
        self._settings = running | {self._there(name, place.at("settings", name)): value for name, value in body.settings.items()}

    def write(self, controls: Controls) -> None:
        """Writes deflections, throttle and brake."""
        for name, target, command in self._lines:
            self._properties[target] = command(getattr(controls, name))

    def set_up(self) -> None:
        """Writes the settings, which the engine forgets at each start."""
        for name, value in self._settings.items():
            self._properties[name] = value

    def joints(self) -> list[JointAngle]:
        """Angles of the surfaces and speeds of the propellers."""
        return [read() for read in self._joints]

    def _command(self, name: str, body: AirBody, place: FileLocation) -> list[CommandLine]:
        """Standard names that the model has not are left out; a surface that is not there leaves its property to others."""
        control = getattr(body.controls, name)
        if isinstance(control, Surface) and not control.limit:
            return []
        if control.property:
            targets = [self._there(target, place.at("property")) for target in body.controls.properties(name)]
        elif name == "throttle":
            targets = [target for target in self._known if THROTTLE.fullmatch(target)]
        else:
            targets = [target for target in body.controls.properties(name) if target in self._known]
        return [CommandLine(SIDES.get(target, name), target, partial(_norm, control)) for target in targets]

    def _there(self, name: str, place: FileLocation) -> str:
        plain = name.replace("[0]", "")
        if plain not in self._known:
            raise BadInput(f"{place}: the model has no property '{name}'; {_near(plain, self._known)}")
        return plain

    def _readers(self, body: AirBody, place: FileLocation) -> list[Callable[[], JointAngle]]:
        told = {name: joint for name, joint in STANDARD_JOINTS.items() if (joint.position or joint.speed) in self._known}
        for name, joint in body.joints.items():
            self._there(joint.position or joint.speed or "", place.at(name, "speed" if joint.position is None else "position"))
        return [_reader(self._properties, name, joint) for name, joint in (body.joints or told).items()]


def _reader(properties: Properties, name: str, joint: JointReading) -> Callable[[], JointAngle]:
    source = joint.position or joint.speed or ""
    unit = _unit(source, joint)
    if joint.position:
        return lambda: JointAngle(name, position=properties[source] * unit)
    return lambda: JointAngle(name, speed=properties[source] * unit)


def _unit(source: str, joint: JointReading) -> float:
    """rad or rad/s at 1."""
    name = unnumbered(source)
    if name.endswith("-deg"):
        return math.pi / 180
    if name.endswith("-rpm"):
        return math.pi / 30
    return joint.limit if name.endswith("-norm") else 1.0


def _near(name: str, known: Collection[str]) -> str:
    """Of hundreds of names only those beside it."""
    folder = name.rpartition("/")[0]
    beside = [k for k in known if k.rpartition("/")[0] == folder]
    return nearest(name, beside or [k for k in known if k.endswith("-cmd-norm")])
