"""The map of the ground vehicle on show: how much of the floor it knows, and what can be done with it."""

from services.gcs.state.session import BrowserSession
from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.view.controls import button, does
from services.gcs.view.markup import Html, html, joined

METHODS = ("graph", "rbpf", "hector", "odometry")


def map_panel(v: VehicleModel, session: BrowserSession, t: float) -> Html:
    """The panel at ``t`` [s, wall] as one page sees it; empty for an aircraft."""
    if v.flies:
        return html("")
    if v.grid is None:
        state = html("<span class='g-idle'>no map yet</span>")
    else:
        known = f"{100 * v.mapped:.0f} % of the floor" if v.mapped is not None else f"{v.grid.column_count} cells wide"
        state = html("<span>{}</span>", known)
    field = html("<input type='text' name='name' placeholder='house-1' aria-label='Name of the map' maxlength='40' required>")
    save = html("<form class='g-form' {}>{}<button type='submit' class='g-btn'>Save map</button></form>", does("save-map", v.name), field)
    return html("<h2 class='g-h'>Map{}</h2>{}{}", state, save, _localizing(v) if is_localized(v) else _mapping(v, session, t))


def is_localized(v: VehicleModel) -> bool:
    """Whether it is localized on a known map instead of drawing one."""
    maps = v.member.entry.maps
    return maps is not None and maps.localize is not None


def _localizing(v: VehicleModel) -> Html:
    look = button("Look for it in the whole map", "relocalize", v.name, style="g-btn g-wide")
    return html("<p class='g-why'>Localized on a known map: click where it stands and choose <b>It stands here</b>.</p>{}", look)


def _mapping(v: VehicleModel, session: BrowserSession, t: float) -> Html:
    """SLAM: held or drawn on, and another map with another method, which takes two clicks."""
    state = v.mapping
    hold = button("▶ Go on mapping", "mapping", v.name, True) if state.held else button("❚❚ Hold the map", "mapping", v.name, False)
    sure = next((method for method in METHODS if session.confirms(v.name, f"begin {method}", t)), "")
    keys = joined(
        button(
            f"Confirm: {name}" if name == sure else name,
            "begin-map",
            v.name,
            name,
            style="g-sure" if name == sure else "",
            pressed=name == _method(v),
        )
        for name in METHODS
    )
    group = html("<div class='g-pressed-group g-gap' role='group' aria-label='Begin another map with'>{}</div>", keys)
    return html("<div class='g-row g-gap'>{}</div><p class='g-why'>Begin another map, where it is, with:</p>{}", hold, group)


def _method(v: VehicleModel) -> str:
    """The one in force: the last that was begun from here, or that of the vehicle's file."""
    return v.mapping.method or str(v.member.file.params.get("mapping", {}).get("method", METHODS[0]))
