"""What hangs over a clicked place: what can be done there, the way there, a measured distance; and the line that tells how to begin."""

from math import atan2, degrees, hypot

from services.gcs.state.pointing import Pointed
from services.gcs.state.session import BrowserSession
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.view.controls import button
from services.gcs.view.markup import Html, html, joined
from services.gcs.view.panels.vehicle.map_panel import is_localized


def menu(model: Model, session: BrowserSession) -> Html:
    """What hangs over the place that this page has clicked; empty when it has clicked none."""
    at = session.pointed
    vehicle = model.vehicles.get(at.vehicle) if at is not None else None
    if at is None or vehicle is None:
        return html("")
    if at.to is not None:
        return _hung(at.to, _distance(at, at.to))
    if at.tool == "measure":
        return _hung((at.x, at.y), html("<b>Measure</b><span>Click the other end</span>{}", _close()))
    if at.tool == "here":
        return _hung((at.x, at.y), html("<b>It stands here</b><span>Click where {} looks now</span>{}", vehicle.name, _close()))
    if at.tool == "face":
        return _hung((at.x, at.y), html("<b>Heading</b><span>Click where {} is to look</span>{}", vehicle.name, _close()))
    if session.tab == "plan" and session.plan_part != "mission":
        return _hung((at.x, at.y), joined((_adding(at, vehicle, session.plan_part), _close())))
    where = html("<span class='g-where'><span>x {:.1f} m, y {:.1f} m</span><span>{}</span></span>", at.x, at.y, vehicle.name)
    return _hung((at.x, at.y), joined((where, _way(at, vehicle), *_choices(at, vehicle), _close())))


def _adding(at: Pointed, v: VehicleModel, part: str) -> Html:
    """What a click means while an area is drawn."""
    draft = v.areas.of(part)
    if draft is None or not draft.rings:
        return html("<b>Fence</b><span>Add a zone in the tab Plan first</span>")
    label = "Add rally point" if part == "rally" else "Add corner"
    return button(label, "area-add", v.name, part, round(at.x, 2), round(at.y, 2), style="g-btn g-main")


def _hung(place: tuple[float, float], content: Html) -> Html:
    return html("<div class='g-menu' role='group' aria-label='At this place' data-x='{:.3f}' data-y='{:.3f}'>{}</div>", *place, content)


def _choices(at: Pointed, v: VehicleModel) -> list[Html]:
    go = button(f"Circle here: {v.name}" if v.flies else f"Go here: {v.name}", "point", "go", style="g-btn g-main")
    face = [] if v.flies else [button("Go here and look …", "point", "face")]
    kinds = (("Add waypoint", "waypoint"), ("Add circle", "orbit")) if v.flies else (("Add waypoint", "waypoint"),)
    add = [button(label, "plan-add", v.name, kind, round(at.x, 2), round(at.y, 2), more=html("data-tab='plan'")) for label, kind in kinds]
    here = [button("It stands here and looks …", "point", "here")] if not v.flies and is_localized(v) else []
    return [go, *face, *here, *add, button("Measure from here", "point", "measure"), button("Set home here", "point", "home")]


def _close() -> Html:
    return button("Close", "point", "", style="g-btn", more=html("data-key='close'"))


def _way(at: Pointed, v: VehicleModel) -> Html:
    """What the planner says of the way there."""
    if v.flies:
        return html("")
    if at.preview is None:
        return html("<span class='g-idle'>looking for a way …</span>")
    if not at.preview.accepted:
        return html("<span class='g-bad'>✖ {}</span>", at.preview.reason)
    p = at.preview
    return html("<span class='g-good'>✓ {:.1f} m, {:.0f} s, {:.2f} m clear</span>", p.length, p.duration, p.clearance)


def _distance(at: Pointed, to: tuple[float, float]) -> Html:
    east, north = to[0] - at.x, to[1] - at.y
    bearing = degrees(atan2(east, north)) % 360
    return html("<b>{:.2f} m</b><span>bearing {:03.0f}°</span>{}", hypot(east, north), bearing, _close())


def hint(model: Model, v: VehicleModel, session: BrowserSession) -> Html:
    """One sentence that tells a newcomer how to begin; gone with the first order."""
    if session.pointed is not None or any(one.order is not None for one in model.vehicles.values()):
        return html("")
    text = f"Click the ground to let {v.name} circle there" if v.flies else f"Click the floor to send {v.name} there"
    return html("<div class='g-hint'>{}</div>", text)
