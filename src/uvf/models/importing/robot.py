"""A robot as somebody else described it, whatever the format: body, what drives it, what it senses."""

from dataclasses import dataclass, field
from typing import Any

from uvf.maths.se3 import IDENTITY, Transform
from uvf.models.importing.notes import Notes
from uvf.models.urdf.robot import UrdfModel

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


@dataclass(frozen=True)
class ImportedDrive:
    """What a plugin for differential drive tells: the joints' names, and track and wheel radius [m] where it gives them."""

    left: tuple[str, ...] = ()
    right: tuple[str, ...] = ()
    track: float | None = None
    wheel_radius: float | None = None


@dataclass
class Foreign:
    """An imported robot before it is rebuilt: body, drive, sensors, and the notes of the import."""

    model: UrdfModel
    drive: ImportedDrive = ImportedDrive()
    sensors: list[ForeignSensor] = field(default_factory=list)
    notes: Notes = field(default_factory=Notes)

    def take_plugins(self, element: Any) -> None:
        """Takes over the first drive among the plugins below an element; all other plugins are dropped with a note."""
        for plugin in element.iter("plugin"):
            drive = drive_of(plugin)
            if drive is not None and self.drive == ImportedDrive():
                self.drive = drive
                self.notes.add("plugin for differential drive: joints and measures taken, the rest dropped", plugin.get("filename") or "")
            elif drive is None:
                self.notes.add("plugins dropped", plugin.get("filename") or plugin.get("name") or "")


def drive_of(plugin: Any) -> ImportedDrive | None:
    """The joints and measures of a plugin for differential or skid-steer drive, by the names that ROS 1, ROS 2 and Gazebo use."""
    name = f"{plugin.get('filename', '')} {plugin.get('name', '')}".lower()
    if not any(word in name for word in ("diff", "skid")):
        return None
    given = _all(plugin)
    texts = dict(given)
    left, right = (tuple(v for t, v in given if t in (f"{s}joint", f"{s}frontjoint", f"{s}rearjoint")) for s in ("left", "right"))
    diameter, radius = _number(texts.get("wheeldiameter")), _number(texts.get("wheelradius"))
    return ImportedDrive(left, right, _number(texts.get("wheelseparation")), diameter / 2 if diameter else radius)


def _all(plugin: Any) -> list[tuple[str, str]]:
    return [(str(t.tag).lower().replace("_", ""), (t.text or "").strip()) for t in plugin if isinstance(t.tag, str)]


def _number(text: str | None) -> float | None:
    try:
        return float(text) if text else None
    except ValueError:
        return None
