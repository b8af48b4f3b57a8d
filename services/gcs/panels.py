"""The page's words about vehicles: fleet cards, what was asked of one and how far it is, its facts. Text from the bus is escaped."""

from html import escape
from math import atan2, degrees, hypot, pi
from pathlib import Path

from schemas.convert import wxyz
from schemas.messages import MissionProgress, Mode, NavStatus
from services.gcs.commands import mode_name
from services.gcs.instruments import Drive, Flight, drive_panel, primary_flight_display
from services.gcs.state import Model, VehicleModel, link_of
from uvf.maths.rotations import to_euler

HELP = Path(__file__).with_name("help.html")


def fleet(model: Model, t: float) -> str:
    return "<div class='g-fleet'>" + "".join(_card(model, v, t) for v in model.vehicles.values()) + "</div>"


def _card(model: Model, v: VehicleModel, t: float) -> str:
    word, style = link_of(v.heard, t)
    badge, badge_style = badge_of(v)
    chosen = " g-chosen" if v.name == model.selected else ""
    rows = "".join(f"<tr><td>{name}</td><td>{value}</td></tr>" for name, value in _numbers(v))
    title = f"<b><i class='g-dot'></i>{'✈' if v.flies else '▣'} {v.name}</b><em class='g-badge g-b-{badge_style}'>{badge}</em>"
    return (
        f"<button type='button' class='g-card{chosen}' data-gcs='select:{v.name}' aria-label='Select {v.name}' style='--c:{v.colour}'>"
        f"<span class='g-top'>{title}</span><table>{rows}<tr><td>link</td><td class='g-{style}'>{word}</td></tr></table></button>"
    )


def badge_of(v: VehicleModel) -> tuple[str, str]:
    """(words, class): the one state that matters most."""
    if v.status is None:
        return "…", "idle"
    if v.status.stopped:
        return "■ STOPPED", "bad"
    if v.nav_status is not None and v.nav_status.state == NavStatus.BLOCKED:
        return "⚠ BLOCKED", "warn"
    if not v.status.armed:
        return "■ DISARMED", "idle"
    return f"▶ {mode_name(v.status.mode).upper()}", "good"


def _numbers(v: VehicleModel) -> list[tuple[str, str]]:
    if v.flies:
        airspeed = f"{v.nav.airspeed:.1f} m/s" if v.nav is not None else "–"
        height = f"{v.nav.position.z:.0f} m" if v.nav is not None else "–"
        return [("airspeed", airspeed), ("altitude", height), ("waypoint", waypoint_text(v))]
    mapped = f"{100 * v.mapped:.0f} %" if v.mapped is not None else "–"
    job = escape(v.nav_status.job) or "–" if v.nav_status is not None else "–"
    return [("speed", f"{v.speed:.2f} m/s"), ("job", job), ("mapped floor", mapped)]


def waypoint_text(v: VehicleModel) -> str:
    if v.progress is None or v.progress.total == 0:
        return "–"
    lap = f", lap {v.progress.laps + 1}" if v.progress.laps else ""
    places = sum(item.kind != item.JUMP for item in v.mission.items) if v.mission is not None else v.progress.total
    return f"{v.progress.current + 1} of {places}{lap}"


def signed(value: float) -> str:
    """``+1.4``, ``-0.3``, and never ``-0.0``."""
    return f"{round(value, 1) + 0.0:+.1f}"


def instrument(v: VehicleModel) -> str:
    mode = mode_name(v.status.mode).upper() if v.status is not None else "NO STATUS"
    armed = v.status is not None and v.status.armed
    place, ground = v.place, v.member.file.ground
    roll, pitch, yaw = to_euler(place.wxyz) if place is not None else (0.0, 0.0, pi / 2)
    heading = pi / 2 - yaw
    if ground is not None:
        left = v.nav_status.distance_left if v.nav_status is not None and v.nav_status.state == NavStatus.DRIVING else None
        return drive_panel(Drive(heading, v.speed, v.turn_rate, ground.max_linear, ground.max_angular, left, mode, armed))
    nav = v.nav
    if nav is None:
        return "<div class='g-empty'>No estimate of the motion yet</div>"
    roll, pitch, yaw = to_euler(wxyz(nav.orientation))
    speed = hypot(nav.velocity.x, nav.velocity.y)
    flight = Flight(roll, -pitch, pi / 2 - yaw, nav.airspeed, nav.position.z, nav.velocity.z, speed, mode, armed)
    return primary_flight_display(flight)


def facts(v: VehicleModel, t: float) -> str:
    """The chosen vehicle's facts as a table of two columns."""
    rows: list[tuple[str, str]] = []
    if v.place is not None:
        x, y, z = v.place.position
        rows.append(("position", f"{x:.2f}, {y:.2f}, {z:.2f} m"))
    if v.status is not None:
        s = v.status
        rows.append(("commands from", escape(s.command_source) or "–"))
        if s.reason:
            rows.append(("because", escape(s.reason)))
        if v.flies:
            rows += [("off the leg", f"{signed(s.cross_track)} m"), ("altitude error", f"{signed(s.altitude_error)} m")]
            rows += [("waypoint", f"{waypoint_text(v)}, {s.distance_to_waypoint:.0f} m"), ("throttle", f"{100 * s.throttle:.0f} %")]
        if s.battery_voltage > 0:
            rows.append(("battery", f"{100 * s.battery_remaining:.0f} %, {s.battery_voltage:.1f} V"))
    rows += _wind(v) + _job(v)
    return "<table class='g-facts'>" + "".join(f"<tr><td>{a}</td><td>{b}</td></tr>" for a, b in rows) + "</table>"


def _wind(v: VehicleModel) -> list[tuple[str, str]]:
    if not v.flies or v.nav is None:
        return []
    speed = hypot(v.nav.wind.x, v.nav.wind.y)
    if speed < 0.05:
        return []
    yaw = to_euler(wxyz(v.nav.orientation))[2]
    return [("wind", f"{speed:.1f} m/s"), ("course − heading", f"{_crab(v, yaw):+.0f}°")]


def _crab(v: VehicleModel, yaw: float) -> float:
    """Angle from the nose to the way over the ground, clockwise [deg]."""
    assert v.nav is not None
    off = yaw - atan2(v.nav.velocity.y, v.nav.velocity.x)
    return degrees((off + pi) % (2 * pi) - pi)


def _job(v: VehicleModel) -> list[tuple[str, str]]:
    if v.nav_status is None:
        return []
    state = NavStatus.State.Name(v.nav_status.state).lower()
    why = f": {escape(v.nav_status.reason)}" if v.nav_status.reason else ""
    return [("planner", f"{state}{why}"), ("explored, as it guesses", f"{100 * v.nav_status.explored:.0f} %")]


def orders(v: VehicleModel) -> str:
    """Under the buttons: what became of the last order, and how far the vehicle is with its job."""
    return f"{order_line(v)}{progress_line(v)}"


def progress_line(v: VehicleModel) -> str:
    """The mission, the way to the goal or the station behind a leader: in words, and as a bar where there is an end to it."""
    p = v.progress
    if v.status is not None and v.status.mode == Mode.MODE_FOLLOW:
        return _progress(f"{escape(v.status.reason)}: {v.status.distance_to_waypoint:.0f} m from its station", None)
    if p is not None and p.state != MissionProgress.NO_MISSION:
        state = MissionProgress.State.Name(p.state).lower().replace("_", " ")
        done = 1.0 if p.state == MissionProgress.COMPLETE else p.current / max(p.total, 1)
        left = f", {v.status.distance_to_waypoint:.0f} m to go" if v.status is not None and p.state == MissionProgress.ACTIVE else ""
        return _progress(f"mission {state}: waypoint {waypoint_text(v)}{left}", done)
    if v.leader:
        return _progress(f"does not follow {v.leader}: ask for Follow leader", None)
    if v.flies or (p is not None and v.nav_status is None):
        return _progress("no mission is loaded: upload one with a ground station", None)
    if v.nav_status is None:
        return ""
    state = NavStatus.State.Name(v.nav_status.state).lower()
    left = f", {v.nav_status.distance_left:.1f} m to go" if v.nav_status.state == NavStatus.DRIVING else ""
    why = f": {escape(v.nav_status.reason)}" if v.nav_status.reason else ""
    return _progress(f"{escape(v.nav_status.job) or 'no job'}: {state}{left}{why}", None)


def drives_to_goal(v: VehicleModel) -> bool:
    """Whether there is a person's goal that can be cancelled."""
    ended = (NavStatus.REACHED, NavStatus.CANCELLED)
    return v.nav_status is not None and v.nav_status.job == "goal" and v.nav_status.state not in ended


def _progress(text: str, share: float | None) -> str:
    bar = "" if share is None else f"<span class='g-meter'><i style='width:{100 * share:.0f}%'></i></span>"
    return f"<div class='g-progress'>{text}{bar}</div>"


def order_line(v: VehicleModel) -> str:
    """The last order: sent, accepted or refused and why."""
    if v.order is None:
        return "<div class='g-order g-idle'>Nothing asked yet</div>"
    sign, style = {"sent": ("…", "warn"), "accepted": ("✓", "good"), "refused": ("✖", "bad")}[v.order.state]
    reason = f": {escape(v.order.reason)}" if v.order.reason else ""
    return f"<div class='g-order g-{style}' role='status'>{sign} {escape(v.order.text)} – {v.order.state}{reason}</div>"
