"""The page's words: status bar, fleet cards, facts of the chosen vehicle, log, processes, help. Text from the bus is escaped."""

from collections.abc import Sequence
from html import escape
from math import atan2, degrees, hypot, pi
from pathlib import Path

from schemas.convert import wxyz
from schemas.messages import Clock, Event, MissionProgress, NavStatus, Process
from services.gcs.commands import mode_name
from services.gcs.instruments import Drive, Flight, drive_panel, primary_flight_display
from services.gcs.state import Line, Model, VehicleModel, link_of
from uvf.maths.rotations import to_euler

SEVERITY: dict[int, tuple[str, str]] = {
    Event.INFO: ("·", "info"),
    Event.NOTICE: ("i", "notice"),
    Event.WARNING: ("⚠", "warn"),
    Event.ERROR: ("✖", "bad"),
    Event.CRITICAL: ("✖", "bad"),
}
LOG_SHOWN = 60
HELP = Path(__file__).with_name("help.html")


def clock_text(seconds: float) -> str:
    """``00:01:23`` of simulation time [s]."""
    whole = int(seconds)
    return f"{whole // 3600:02d}:{whole // 60 % 60:02d}:{whole % 60:02d}"


def system_link(model: Model, t: float) -> tuple[str, str]:
    """(word, class) for the whole link: by the clock, or by the vehicles where there is no clock."""
    heard = [v.heard for v in model.vehicles.values() if v.heard is not None]
    newest = model.clock_at if model.clock_at is not None else max(heard, default=None)
    word, style = link_of(newest, t)
    if style == "good" and model.clock is not None and model.clock.state != Clock.RUNNING:
        return "PAUSED", "warn"
    return word, style


def status_bar(model: Model, t: float) -> str:
    word, style = system_link(model, t)
    rate = f"× {model.clock.rate:.2f}" if model.clock is not None and model.clock.rate > 0 else ""
    waiting = escape(model.clock.waiting_for) if model.clock is not None else ""
    live = sum(link_of(v.heard, t)[1] == "good" for v in model.vehicles.values())
    chosen = model.chosen
    parts = [
        f"<b class='g-{style}'>● {word}</b>",
        f"<span>sim <b>{clock_text(model.sim_time)}</b> <i>{rate}</i></span>",
        f"<span>{live} of {len(model.vehicles)} vehicles</span>",
    ]
    if waiting:
        parts.append(f"<span class='g-warn'>waits for {waiting}</span>")
    if model.stopped:
        parts.append("<b class='g-stop'>■ STOP ALL ENGAGED</b>")
    elif alarm := _alarm(model):
        parts.append(f"<span class='g-{SEVERITY[alarm.severity][1]}'>⚠ {escape(alarm.vehicle)} {escape(alarm.text[:60])}</span>")
    if chosen is not None:
        parts.append(f"<span class='g-follow' hidden data-name='{chosen.name}' data-distance='{40 if chosen.flies else 3}'></span>")
    return "".join(parts)


def _alarm(model: Model) -> Line | None:
    """The newest warning or worse of the last 15 s of simulation time."""
    recent = (line for line in reversed(model.log) if line.severity >= Event.WARNING and model.sim_time - line.t < 15.0)
    return next((line for line in recent if line.severity in SEVERITY), None)


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
    explored = f"{100 * v.nav_status.explored:.0f} %" if v.nav_status is not None else "–"
    job = escape(v.nav_status.job) or "–" if v.nav_status is not None else "–"
    return [("speed", f"{v.speed:.2f} m/s"), ("job", job), ("explored", explored)]


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
    return "<table class='g-facts'>" + "".join(f"<tr><td>{a}</td><td>{b}</td></tr>" for a, b in rows) + f"</table>{order_line(v)}"


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
    rows = []
    if v.nav_status is not None:
        state = NavStatus.State.Name(v.nav_status.state).lower()
        why = f": {escape(v.nav_status.reason)}" if v.nav_status.reason else ""
        rows.append(("planner", f"{state}{why}"))
    if v.progress is not None and v.flies:
        rows.append(("mission", MissionProgress.State.Name(v.progress.state).lower().replace("_", " ")))
    return rows


def order_line(v: VehicleModel) -> str:
    """The last order: sent, accepted or refused and why."""
    if v.order is None:
        return ""
    sign, style = {"sent": ("…", "warn"), "accepted": ("✓", "good"), "refused": ("✖", "bad")}[v.order.state]
    reason = f": {escape(v.order.reason)}" if v.order.reason else ""
    return f"<div class='g-order g-{style}' role='status'>{sign} {escape(v.order.text)} – {v.order.state}{reason}</div>"


def event_log(lines: Sequence[Line]) -> str:
    if not lines:
        return "<div class='g-empty'>Nothing has happened yet</div>"
    rows = []
    for line in list(lines)[: -LOG_SHOWN - 1 : -1]:
        sign, style = SEVERITY.get(line.severity, SEVERITY[Event.INFO])
        who = f"<b>{escape(line.vehicle)}</b> " if line.vehicle else ""
        rows.append(f"<tr><td>{clock_text(line.t)}</td><td class='g-{style}'>{sign}</td><td>{who}{escape(line.text)}</td></tr>")
    return f"<table class='g-log' aria-live='polite'>{''.join(rows)}</table>"


def processes(model: Model) -> str:
    if not model.processes:
        return "<div class='g-empty'>No launcher has spoken; services may have been started by hand</div>"
    rows = []
    for _, p in sorted(model.processes.items()):
        state = Process.State.Name(p.state).lower()
        style = {"running": "good", "failed": "bad", "ended": "idle"}.get(state, "warn")
        more = f" · {p.restarts} restarts" if p.restarts else ""
        why = f"<br><small>{escape(p.reason)}</small>" if p.reason else ""
        rows.append(f"<tr><td>{escape(p.name)}</td><td><span class='g-{style}'>{state}</span>{more}{why}</td></tr>")
    return f"<table class='g-facts'>{''.join(rows)}</table>"
