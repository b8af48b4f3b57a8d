"""What a page shows of its vehicle's cameras: one picture at a time, its age, and of a gimbal where it looks.

A picture goes to the page only while somebody has it before his eyes: each page says so once a second (``Looking``).
"""

from base64 import b64encode
from math import degrees

from services.gcs.state.session import SHED_AFTER, BrowserSession
from services.gcs.state.vehicle_model import STALE_AFTER, VehicleModel
from services.gcs.state.wording import GIMBAL_MODES
from services.gcs.view.controls import button, choice, does
from services.gcs.view.markup import Html, html, joined

SHOWN = {"gimbal": "gimbal", "chase": "chase", "image": "camera"}
"""Field of the model (the first one there is shown at first) -> what the camera is called in the vehicle's file."""
SEEN_FOR = 10.0  # s that a page's word that it looks holds: one that draws without a graphics card may say it late


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


def panel(v: VehicleModel, session: BrowserSession, t: float) -> Html:
    """The row of cameras, the picture and its age at ``t`` [s, wall], and the gimbal's sliders; empty when the vehicle has none."""
    shown = shown_camera(v, session)
    if not shown:
        return html("")
    keys = joined(button(SHOWN[name], "camera", name, pressed=name == shown) for name in cameras_of(v))
    gimbal = _gimbal(v) if shown == "gimbal" else html("")
    views = html("<div class='g-views' role='group' aria-label='Camera'>{}</div>", keys)
    return html("<div id='gcs-cameras'><h2 class='g-h'>Camera {}</h2>{}{}</div>", _age(v, session, shown, t), views, gimbal)


def picture(v: VehicleModel, session: BrowserSession, t: float) -> Html:
    """The newest picture of the camera on show at ``t`` [s, wall]; empty when there is none, or nobody watches."""
    shown = shown_camera(v, session)
    image = getattr(v, shown) if shown and is_watched(session, t) else None
    if image is None:
        return html("")
    kind = "png" if image.data.startswith(b"\x89PNG") else "jpeg"
    return html("<img alt='{} of {}' src='data:image/{};base64,{}'>", SHOWN[shown], v.name, kind, b64encode(image.data).decode())


def _age(v: VehicleModel, session: BrowserSession, shown: str, t: float) -> Html:
    if session.past is None and session.behind(t) > SHED_AFTER:
        return html("<span class='g-warn'>⚠ no pictures: this page is {:.0f} s behind</span>", session.behind(t))
    at = v.heard_at.get(shown)
    if at is None:
        return html("<span class='g-idle'>no picture yet</span>")
    age, style = t - at, "g-idle" if t - at < STALE_AFTER else "g-warn"
    return html("<span class='{}'>{}{:.1f} s old</span>", style, "⚠ " if style == "g-warn" else "", age)


def _gimbal(v: VehicleModel) -> Html:
    gimbal = v.member.file.sensors.gimbal
    if gimbal is None:
        return html("")
    mode = next(name for name, value in GIMBAL_MODES.items() if value == v.aim.mode)
    turns = [("pan", -gimbal.pan_max, gimbal.pan_max, v.aim.pan), ("tilt", gimbal.tilt_min, gimbal.tilt_max, v.aim.tilt)]
    modes = choice("Gimbal follows", GIMBAL_MODES, mode, "gimbal-mode", v.name)
    return html("{}{}{}", joined(_slider(v, *turn) for turn in turns), modes, _joints(v))


def _slider(v: VehicleModel, axis: str, low: float, high: float, now: float) -> Html:
    scale = html("min='{:.0f}' max='{:.0f}' step='1' value='{:.0f}'", *map(degrees, (low, high, now)))
    bar = html("<input type='range' {} {} aria-label='{} of {}'>", does("gimbal", v.name, axis), scale, axis, v.name)
    return html("<label>{}{}<b>{:.0f}°</b></label>", axis, bar, degrees(now))


def _joints(v: VehicleModel) -> Html:
    if v.gimbal_joints is None:
        return html("")
    words = ", ".join(f"{joint.name} {degrees(joint.position):.0f}°" for joint in v.gimbal_joints.joints)
    return html("<p class='g-why'>joints: {}</p>", words)
