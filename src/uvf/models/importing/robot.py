"""A robot as somebody else described it, whatever the format: body, what drives it, what it senses."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from math import inf
from typing import Any

from uvf.maths.se3 import IDENTITY, Transform
from uvf.models.importing.notes import Notes
from uvf.models.urdf.robot import UrdfModel
from uvf.models.yaml_data import BadInput, nearest

UNKNOWN = "kinds of joint that are not simulated, held fast"


@dataclass(frozen=True)
class ForeignSensor:
    """A sensor of an imported robot. link_from_sensor: where it sits on its link.

    element: its <sensor> tag of SDF; None where only a link's name tells of it.
    """

    kind: str
    link: str
    element: Any = None
    link_from_sensor: Transform = IDENTITY


SIDEWAYS = ("mecanum", "planar_move", "planarmove", "omni", "force_based_move")
"""In the names of plugins that drive a robot sideways, too."""
JOINTS = ("{}joint", "{}frontjoint", "{}rearjoint", "front{}joint", "back{}joint", "rear{}joint")
LIMITS = {
    "linear": "speed",
    "angular": "turn rate",
    "linear_acceleration": "acceleration",
    "angular_acceleration": "angular acceleration",
}


@dataclass(frozen=True)
class StatedLimits:
    """Largest speed [m/s], turn rate [rad/s] and accelerations [m/s^2, rad/s^2], None where nothing is said, and where they stand."""

    linear: float | None = None
    angular: float | None = None
    linear_acceleration: float | None = None
    angular_acceleration: float | None = None
    source: str = ""

    def filled_by(self, other: "StatedLimits") -> "StatedLimits":
        """These limits, and those of the other where these say nothing."""
        own = {name: value for name in LIMITS if (value := getattr(self, name)) is not None}
        more = {name: value for name in LIMITS if name not in own and (value := getattr(other, name)) is not None}
        sources = [limits.source for limits, told in ((self, own), (other, more)) if told]
        return StatedLimits(**own, **more, source=", ".join(sources))

    @property
    def missing(self) -> list[str]:
        """What nothing is said of."""
        return [words for name, words in LIMITS.items() if getattr(self, name) is None]


@dataclass(frozen=True)
class ImportedDrive:
    """What a plugin for a drive tells: the joints' names, and track and wheel radius [m] and limits where it gives them.

    has_rollers: it drives sideways, too.
    """

    left: tuple[str, ...] = ()
    right: tuple[str, ...] = ()
    track: float | None = None
    wheel_radius: float | None = None
    limits: StatedLimits = StatedLimits()
    has_rollers: bool = False


@dataclass
class Foreign:
    """An imported robot before it is rebuilt: body, drive, sensors, and the notes of the import.

    commanded: the joints that its makers move to a place.
    """

    model: UrdfModel
    drive: ImportedDrive = ImportedDrive()
    sensors: list[ForeignSensor] = field(default_factory=list)
    commanded: set[str] = field(default_factory=set)
    notes: Notes = field(default_factory=Notes)

    def command(self, joints: Iterable[str]) -> None:
        """Has these joints moved on command, too. Raises BadInput for one that is not there."""
        for name in joints:
            if name not in self.model.joints:
                raise BadInput(f"{self.model.path}: no joint '{name}'; {nearest(name, self.model.joints)}")
            self.commanded.add(name)

    def take_plugins(self, element: Any) -> None:
        """Takes over the first drive among the plugins below an element; all other plugins are dropped with a note."""
        for plugin in element.iter("plugin"):
            drive = drive_of(plugin)
            if drive is not None and self.drive == ImportedDrive():
                self.drive = drive
                self.notes.add("plugin of the drive: joints and measures taken, the rest dropped", plugin.get("filename") or "")
            elif drive is None:
                self.notes.add("plugins dropped", plugin.get("filename") or plugin.get("name") or "")


def stated(value: object) -> float | None:
    """A limit as a file states it; None for what is no limit."""
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) and 0.0 < value < inf else None


def drive_of(plugin: Any) -> ImportedDrive | None:
    """The joints and measures of a plugin for a drive, by the names that ROS 1, ROS 2 and Gazebo use."""
    name = f"{plugin.get('filename', '')} {plugin.get('name', '')}".lower()
    has_rollers = any(word in name for word in SIDEWAYS)
    if not has_rollers and not any(word in name for word in ("diff", "skid")):
        return None
    given = _all(plugin)
    texts = dict(given)
    left, right = (tuple(v for t, v in given if t in [place.format(side) for place in JOINTS]) for side in ("left", "right"))
    diameter, radius = _number(texts.get("wheeldiameter")), _number(texts.get("wheelradius"))
    track, limits = _number(texts.get("wheelseparation")), _limits(texts, plugin)
    return ImportedDrive(left, right, track, diameter / 2 if diameter else radius, limits, has_rollers)


def _limits(texts: Mapping[str, str], plugin: Any) -> StatedLimits:
    """As the plugin of the newer Gazebo has them."""
    linear, angular, fast, spinning = (
        stated(_number(texts.get(f"max{axis}{kind}"))) for kind in ("velocity", "acceleration") for axis in ("linear", "angular")
    )
    return StatedLimits(linear, angular, fast, spinning, f"the plugin {plugin.get('filename', '')}")


def _all(plugin: Any) -> list[tuple[str, str]]:
    return [(str(t.tag).lower().replace("_", ""), (t.text or "").strip()) for t in plugin if isinstance(t.tag, str)]


def _number(text: str | None) -> float | None:
    try:
        return float(text) if text else None
    except ValueError:
        return None
