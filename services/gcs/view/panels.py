"""The page's words about vehicles: fleet cards, what was asked of one and how far it is, its facts."""

from collections.abc import Iterable
from math import atan2, degrees, hypot, pi
from pathlib import Path

from schemas.messages import MissionProgress, Mode, NavStatus
from services.gcs.state.state import Model, VehicleModel, link_of
from services.gcs.state.wording import mode_name
from services.gcs.view.instruments import DriveInstruments, FlightInstruments, drive_panel, primary_flight_display
from services.gcs.view.markup import Html, html, joined
from uvf.maths.rotations import to_euler
from uvf.runtime.messages.convert import wxyz
from uvf.runtime.messages.enum_names import enum_name

HELP = Path(__file__).with_name("help.html")


def fleet(model: Model, chosen: VehicleModel, t: float) -> Html:
    """The cards of all vehicles at ``t`` [s, wall]."""
    return html("<div class='g-fleet'>{}</div>", joined(_card(v, v is chosen, t) for v in model.vehicles.values()))


def _card(v: VehicleModel, is_chosen: bool, t: float) -> Html:
    word, style = link_of(v.heard, t)
    badge, badge_style = badge_of(v)
    chosen = " g-chosen" if is_chosen else ""
    rows = _rows(_numbers(v))
    title = html("<b><i class='g-dot'></i>{} {}</b><em class='g-badge g-b-{}'>{}</em>", "✈" if v.flies else "▣", v.name, badge_style, badge)
    return html(
        "<button type='button' class='g-card{}' data-gcs='select:{}' aria-label='Select {}' style='--c:{}'>"
        "<span class='g-top'>{}</span><table>{}<tr><td>link</td><td class='g-{}'>{}</td></tr></table></button>",
        chosen,
        v.name,
        v.name,
        v.colour,
        title,
        rows,
        style,
        word,
    )


def badge_of(v: VehicleModel) -> tuple[str, str]:
    """(words, CSS class) of the vehicle's most important state."""
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
    job = v.nav_status.job or "–" if v.nav_status is not None else "–"
    return [("speed", f"{v.speed:.2f} m/s"), ("job", job), ("mapped floor", mapped)]


def waypoint_text(v: VehicleModel) -> str:
    """The current waypoint, number of waypoints and lap, in words."""
    if v.progress is None or v.progress.total == 0:
        return "–"
    lap = f", lap {v.progress.laps + 1}" if v.progress.laps else ""
    places = sum(item.kind != item.JUMP for item in v.mission.items) if v.mission is not None else v.progress.total
    return f"{v.progress.current + 1} of {places}{lap}"


def signed(value: float) -> str:
    """A number [any unit] as ``+1.4`` or ``-0.3``, and never ``-0.0``."""
    return f"{round(value, 1) + 0.0:+.1f}"


def instrument(v: VehicleModel) -> Html:
    """The primary flight display of an aircraft, or the driver's panel of a ground vehicle."""
    mode = html("{}", mode_name(v.status.mode).upper() if v.status is not None else "NO STATUS")
    armed = v.status is not None and v.status.armed
    place, ground = v.place, v.member.file.ground
    if ground is not None:
        heading = pi / 2 - to_euler(place.wxyz)[2] if place is not None else 0.0
        left = v.nav_status.distance_left if v.nav_status is not None and v.nav_status.state == NavStatus.DRIVING else None
        return drive_panel(DriveInstruments(heading, v.speed, v.turn_rate, ground.max_linear, ground.max_angular, left, mode, armed))
    nav = v.nav
    if nav is None:
        return html("<div class='g-empty'>No estimate of the motion yet</div>")
    roll, pitch, yaw = to_euler(wxyz(nav.orientation))
    speed = hypot(nav.velocity.x, nav.velocity.y)
    flight = FlightInstruments(roll, -pitch, pi / 2 - yaw, nav.airspeed, nav.position.z, nav.velocity.z, speed, mode, armed)
    return primary_flight_display(flight)


def facts(v: VehicleModel, t: float) -> Html:
    """The chosen vehicle's facts as a table of two columns; ``t`` [s] is not used."""
    rows: list[tuple[str, str]] = []
    if v.place is not None:
        x, y, z = v.place.position
        rows.append(("position", f"{x:.2f}, {y:.2f}, {z:.2f} m"))
    if v.status is not None:
        s = v.status
        rows.append(("commands from", s.command_source or "–"))
        if s.reason:
            rows.append(("because", s.reason))
        if v.flies:
            rows += [("off the leg", f"{signed(s.cross_track)} m"), ("altitude error", f"{signed(s.altitude_error)} m")]
            rows += [("waypoint", f"{waypoint_text(v)}, {s.distance_to_waypoint:.0f} m"), ("throttle", f"{100 * s.throttle:.0f} %")]
        if s.battery_voltage > 0:
            rows.append(("battery", f"{100 * s.battery_remaining:.0f} %, {s.battery_voltage:.1f} V"))
    rows += _wind(v) + _job(v)
    return html("<table class='g-facts'>{}</table>", _rows(rows))


def _rows(pairs: Iterable[tuple[str, str]]) -> Html:
    return joined(html("<tr><td>{}</td><td>{}</td></tr>", *pair) for pair in pairs)


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
    state = enum_name(NavStatus.State, v.nav_status.state)
    why = f": {v.nav_status.reason}" if v.nav_status.reason else ""
    return [("planner", f"{state}{why}"), ("explored (estimate)", f"{100 * v.nav_status.explored:.0f} %")]


def orders(v: VehicleModel) -> Html:
    """Under the buttons: the outcome of the last order, and the progress of the vehicle's job."""
    return joined((order_line(v), progress_line(v)))


def progress_line(v: VehicleModel) -> Html:
    """Progress of the mission, the way to the goal or the formation slot: in words, and as a bar where there is an end to it."""
    p = v.progress
    if v.status is not None and v.status.mode == Mode.MODE_FOLLOW:
        return _progress(f"{v.status.reason}: {v.status.distance_to_waypoint:.0f} m from its station", None)
    if p is not None and p.state != MissionProgress.NO_MISSION:
        state = enum_name(MissionProgress.State, p.state)
        done = 1.0 if p.state == MissionProgress.COMPLETE else p.current / max(p.total, 1)
        left = f", {v.status.distance_to_waypoint:.0f} m to go" if v.status is not None and p.state == MissionProgress.ACTIVE else ""
        return _progress(f"mission {state}: waypoint {waypoint_text(v)}{left}", done)
    if v.leader:
        return _progress(f"does not follow {v.leader}: ask for Follow leader", None)
    if v.flies or (p is not None and v.nav_status is None):
        return _progress("no mission is loaded: upload one with a ground station", None)
    if v.nav_status is None:
        return html("")
    state = enum_name(NavStatus.State, v.nav_status.state)
    left = f", {v.nav_status.distance_left:.1f} m to go" if v.nav_status.state == NavStatus.DRIVING else ""
    why = f": {v.nav_status.reason}" if v.nav_status.reason else ""
    return _progress(f"{v.nav_status.job or 'no job'}: {state}{left}{why}", None)


def drives_to_goal(v: VehicleModel) -> bool:
    """Whether it drives to a person's goal, which can be cancelled."""
    ended = (NavStatus.REACHED, NavStatus.CANCELLED)
    return v.nav_status is not None and v.nav_status.job == "goal" and v.nav_status.state not in ended


def _progress(text: str, share: float | None) -> Html:
    bar = "" if share is None else html("<span class='g-meter'><i style='width:{:.0f}%'></i></span>", 100 * share)
    return html("<div class='g-progress'>{}{}</div>", text, bar)


def order_line(v: VehicleModel) -> Html:
    """The last order: sent, accepted or refused and why."""
    if v.order is None:
        return html("<div class='g-order g-idle'>Nothing asked yet</div>")
    sign, style = {"sent": ("…", "warn"), "accepted": ("✓", "good"), "refused": ("✖", "bad")}[v.order.state]
    reason = f": {v.order.reason}" if v.order.reason else ""
    return html("<div class='g-order g-{}' role='status'>{} {} – {}{}</div>", style, sign, v.order.text, v.order.state, reason)
