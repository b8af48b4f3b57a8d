"""What a page shows of its vehicle's cameras: one picture at a time, its age, and of a gimbal where it looks.

A picture goes to the page only while somebody has it before his eyes: each page says so once a second (``Looking``).
"""

from dataclasses import dataclass
from math import degrees

from schemas.messages import GimbalCommand
from services.gcs.state.session import BrowserSession
from services.gcs.state.state import STALE_AFTER, VehicleModel
from services.gcs.view.markup import Html, html, joined

SHOWN = {"gimbal": "gimbal", "chase": "chase", "image": "camera"}
"""Field of the model (the first one there is shown at first) -> what the camera is called in the vehicle's file."""
SEEN_FOR = 10.0  # s that a page's word that it looks holds: one that draws without a graphics card may say it late
MODES = {"Follow": GimbalCommand.FOLLOW, "Lock": GimbalCommand.LOCK, "Body": GimbalCommand.BODY}


@dataclass(frozen=True)
class GimbalPanel:
    """The gimbal controls of a vehicle: range of the sliders [rad], and what was last requested here."""

    vehicle: str
    pan_max: float
    tilts: tuple[float, float]
    pan: float
    tilt: float
    mode: str


def cameras_of(v: VehicleModel) -> list[str]:
    """The fields of the model that hold the vehicle's cameras."""
    sensors = v.member.file.sensors
    return [name for name, kind in SHOWN.items() if getattr(sensors, kind) is not None]


def shown_camera(v: VehicleModel, session: BrowserSession) -> str:
    """Field of the camera on show; "" when there is none."""
    there = cameras_of(v)
    return session.camera if session.camera in there else next(iter(there), "")


def is_watched(session: BrowserSession, t: float) -> bool:
    """Whether the page had its camera picture visible at ``t`` [s, wall]."""
    return t - session.looked_at <= SEEN_FOR


def picture(v: VehicleModel, session: BrowserSession, t: float) -> bytes | None:
    """JPEG of the camera on show at ``t`` [s, wall]; None when there is none, or nobody watches."""
    name = shown_camera(v, session)
    if not name or not is_watched(session, t):
        return None
    image = getattr(v, name)
    return None if image is None else image.data


def gimbal_panel(v: VehicleModel, session: BrowserSession) -> GimbalPanel | None:
    """The gimbal controls; None unless the gimbal's picture is on show."""
    if shown_camera(v, session) != "gimbal" or (gimbal := v.member.file.sensors.gimbal) is None:
        return None
    mode = next(name for name, value in MODES.items() if value == v.aim.mode)
    return GimbalPanel(v.name, gimbal.pan_max, (gimbal.tilt_min, gimbal.tilt_max), v.aim.pan, v.aim.tilt, mode)


def panel(v: VehicleModel, session: BrowserSession, t: float) -> Html:
    """The row of cameras, and below it the picture's age at ``t`` [s, wall]; empty when the vehicle has none."""
    shown = shown_camera(v, session)
    if not shown:
        return html("")
    keys = joined(
        html("<button type='button' data-gcs='camera:{}'{}>{}</button>", name, _pressed(name == shown), SHOWN[name])
        for name in cameras_of(v)
    )
    return html("<div id='gcs-cameras'><div class='g-views' role='group' aria-label='Camera'>{}</div>{}</div>", keys, _age(v, shown, t))


def _pressed(on: bool) -> Html:
    return html(" aria-pressed='{}'", "true" if on else "false")


def _age(v: VehicleModel, shown: str, t: float) -> Html:
    at = v.heard_at.get(shown)
    if at is None:
        return html("<span class='g-idle'>no picture yet</span>")
    age, style = t - at, "g-idle" if t - at < STALE_AFTER else "g-warn"
    where = _joints(v) if shown == "gimbal" else ""
    return html("<span class='{}'>{}{:.1f} s old{}</span>", style, "⚠ " if style == "g-warn" else "", age, where)


def _joints(v: VehicleModel) -> str:
    if v.gimbal_joints is None:
        return ""
    return " – joints " + ", ".join(f"{joint.name} {degrees(joint.position):.0f}°" for joint in v.gimbal_joints.joints)
