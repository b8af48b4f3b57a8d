"""The map of the ground vehicle on show: how much of the floor it knows, and what can be done with it."""

from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.view.controls import button, does
from services.gcs.view.markup import Html, html


def map_panel(v: VehicleModel) -> Html:
    """The panel; empty for an aircraft."""
    if v.flies:
        return html("")
    if v.grid is None:
        state = html("<span class='g-idle'>no map yet</span>")
    else:
        known = f"{100 * v.mapped:.0f} % of the floor" if v.mapped is not None else f"{v.grid.column_count} cells wide"
        state = html("<span>{}</span>", known)
    field = html("<input type='text' name='name' placeholder='house-1' aria-label='Name of the map' maxlength='40' required>")
    save = html("<form class='g-form' {}>{}<button type='submit' class='g-btn'>Save map</button></form>", does("save-map", v.name), field)
    return html("<h2 class='g-h'>Map{}</h2>{}{}", state, save, _localizing(v))


def is_localized(v: VehicleModel) -> bool:
    """Whether it is localized on a known map instead of drawing one."""
    maps = v.member.entry.maps
    return maps is not None and maps.localize is not None


def _localizing(v: VehicleModel) -> Html:
    if not is_localized(v):
        return html("")
    look = button("Look for it in the whole map", "relocalize", v.name, style="g-btn g-wide")
    return html("<p class='g-why'>Localized on a known map: click where it stands and choose <b>It stands here</b>.</p>{}", look)
