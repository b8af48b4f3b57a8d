"""What the page shows of the chosen vehicle's cameras: one picture at a time, its age, and of a gimbal where it looks.

A picture goes to the page only while somebody has it before his eyes: each page says so once a second (``Looking``).
"""

from dataclasses import dataclass
from math import degrees

from schemas.messages import GimbalCommand
from services.gcs.state import STALE_AFTER, Model, VehicleModel

SHOWN = {"gimbal": "gimbal", "chase": "chase", "image": "camera"}
"""Field of the model (the first one there is shown at first) -> what the camera is called in the vehicle's file."""
SEEN_FOR = 10.0  # s that a page's word that it looks holds: one that draws without a graphics card may say it late
MODES = {"Follow": GimbalCommand.FOLLOW, "Lock": GimbalCommand.LOCK, "Body": GimbalCommand.BODY}


@dataclass(frozen=True)
class GimbalPanel:
    """Of which vehicle, how far the sliders go [rad], and what it was last asked here."""

    vehicle: str
    pan_max: float
    tilts: tuple[float, float]
    pan: float
    tilt: float
    mode: str


def cameras_of(v: VehicleModel) -> list[str]:
    """The fields of those it has."""
    sensors = v.member.file.sensors
    return [name for name, kind in SHOWN.items() if getattr(sensors, kind) is not None]


def shown_camera(model: Model) -> str:
    """Field of the camera that is on show; empty when there is none."""
    there = cameras_of(model.chosen) if model.chosen is not None else []
    return model.camera if model.camera in there else next(iter(there), "")


def is_watched(model: Model, t: float) -> bool:
    return any(t - at <= SEEN_FOR for at in model.looking.values())


def picture(model: Model, t: float) -> bytes | None:
    """JPEG of the camera on show; None when there is none, or nobody to see it."""
    v, name = model.chosen, shown_camera(model)
    if v is None or not name or not is_watched(model, t):
        return None
    image = getattr(v, name)
    return None if image is None else image.data


def gimbal_panel(model: Model) -> GimbalPanel | None:
    """Only while the gimbal's picture is on show."""
    v = model.chosen
    if v is None or shown_camera(model) != "gimbal" or (gimbal := v.member.file.sensors.gimbal) is None:
        return None
    mode = next(name for name, value in MODES.items() if value == v.aim.mode)
    return GimbalPanel(v.name, gimbal.pan_max, (gimbal.tilt_min, gimbal.tilt_max), v.aim.pan, v.aim.tilt, mode)


def panel(model: Model, t: float) -> str:
    """The row of cameras, and below it the age of the picture; empty when the vehicle has none."""
    v, shown = model.chosen, shown_camera(model)
    if v is None or not shown:
        return ""
    keys = "".join(
        f"<button type='button' data-gcs='camera:{name}'{_pressed(name == shown)}>{SHOWN[name]}</button>" for name in cameras_of(v)
    )
    return f"<div id='gcs-cameras'><div class='g-views' role='group' aria-label='Camera'>{keys}</div>{_age(v, shown, t)}</div>"


def _pressed(on: bool) -> str:
    return f" aria-pressed='{'true' if on else 'false'}'"


def _age(v: VehicleModel, shown: str, t: float) -> str:
    at = v.heard_at.get(shown)
    if at is None:
        return "<span class='g-idle'>no picture yet</span>"
    age, style = t - at, "g-idle" if t - at < STALE_AFTER else "g-warn"
    where = _joints(v) if shown == "gimbal" else ""
    return f"<span class='{style}'>{'⚠ ' if style == 'g-warn' else ''}{age:.1f} s old{where}</span>"


def _joints(v: VehicleModel) -> str:
    if v.gimbal_joints is None:
        return ""
    return " – joints " + ", ".join(f"{joint.name} {degrees(joint.position):.0f}°" for joint in v.gimbal_joints.joints)
