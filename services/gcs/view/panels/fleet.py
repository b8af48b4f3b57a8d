"""The fleet: a card for each vehicle, or one table of all of them."""

from schemas.messages import NavStatus
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import VehicleModel, link_of
from services.gcs.state.wording import mode_name
from services.gcs.view.controls import does
from services.gcs.view.markup import Html, html, joined
from services.gcs.view.panels.vehicle.progress import waypoint_text

COLUMNS = ("vehicle", "kind", "state", "speed", "position m", "battery", "doing", "link")


def fleet(model: Model, chosen: VehicleModel, t: float) -> Html:
    """The cards of all vehicles at ``t`` [s, wall]."""
    return html("<div class='g-fleet'>{}</div>", joined(_card(model, v, v is chosen, t) for v in model.vehicles.values()))


def fleet_table(model: Model, t: float) -> Html:
    """The same as one table, for those who read or hear it as such."""
    head = joined(html("<th scope='col'>{}</th>", name) for name in COLUMNS)
    rows = joined(_row(v, t) for v in model.vehicles.values())
    return html("<table class='g-facts g-table'><caption>All vehicles</caption><tr>{}</tr>{}</table>", head, rows)


def _row(v: VehicleModel, t: float) -> Html:
    word, style = link_of(v.heard, t)
    badge, _ = badge_of(v)
    numbers = dict(_numbers(v))
    place = "–" if v.place is None else ", ".join(f"{c:.1f}" for c in v.place.position[: 3 if v.flies else 2])
    cells = (
        badge,
        numbers.get("airspeed") or numbers.get("speed", "–"),
        place,
        numbers.get("battery", "–"),
        numbers.get("job") or numbers.get("waypoint", "–"),
    )
    link = html("<td class='g-{}'>{}</td>", style, word)
    kind = "aircraft" if v.flies else "rover"
    return html("<tr><th scope='row'>{}</th><td>{}</td>{}{}</tr>", v.name, kind, joined(html("<td>{}</td>", cell) for cell in cells), link)


def _card(model: Model, v: VehicleModel, is_chosen: bool, t: float) -> Html:
    word, style = link_of(v.heard, t)
    badge, badge_style = badge_of(v)
    old = "g-old" if style == "bad" else ""
    numbers = joined(html("<span>{}</span><b class='{}'>{}</b>", name, old, value) for name, value in _numbers(v))
    top = html("<b>{} {}</b><em class='g-badge g-b-{}'>{}</em>", "✈" if v.flies else "▣", v.name, badge_style, badge)
    return html(
        "<button type='button' class='g-card{}' data-key='{}' data-name='{}' data-kind='{}' {} aria-label='Select {}' aria-pressed='{}' "
        "style='--c:{}'><span class='g-top'>{}</span><span class='g-numbers'>{}<span>link</span><b class='g-{}'>{}</b></span></button>",
        " g-chosen" if is_chosen else "",
        v.name,
        v.name,
        v.member.file.kind,
        does("select", v.name),
        v.name,
        "true" if is_chosen else "false",
        v.colour,
        top,
        numbers,
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
    battery = [("battery", f"{100 * v.status.battery_remaining:.0f} %")] if v.status is not None and v.status.battery_voltage > 0 else []
    if v.flies:
        airspeed = f"{v.nav.airspeed:.1f} m/s" if v.nav is not None else "–"
        height = f"{v.nav.position.z:.0f} m" if v.nav is not None else "–"
        return [("airspeed", airspeed), ("altitude", height), ("waypoint", waypoint_text(v)), *battery]
    mapped = [("mapped floor", f"{100 * v.mapped:.0f} %")] if v.mapped is not None else []
    job = v.nav_status.job or "–" if v.nav_status is not None else "–"
    return [("speed", f"{v.speed:.2f} m/s"), ("job", job), *mapped, *battery]
