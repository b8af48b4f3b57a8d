"""The instrument and the facts of the vehicle on show."""

from collections.abc import Iterable
from math import atan2, degrees, hypot, pi

from schemas.messages import NavStatus
from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.state.wording import mode_name
from services.gcs.view.markup import Html, html, joined
from services.gcs.view.panels.vehicle.instruments import DriveInstruments, FlightInstruments, drive_panel, primary_flight_display
from services.gcs.view.panels.vehicle.progress import waypoint_text
from uvf.maths.rotations import to_euler
from uvf.runtime.messages.convert import wxyz
from uvf.runtime.messages.enum_names import enum_name


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
