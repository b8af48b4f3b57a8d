"""What became of the last order to a vehicle, and how far its job is."""

from schemas.messages import MissionProgress, Mode, NavStatus
from services.gcs.state.vehicle_model import Order, VehicleModel
from services.gcs.view.markup import Html, html
from uvf.runtime.messages.enum_names import enum_name


def waypoint_text(v: VehicleModel) -> str:
    """The current waypoint, number of waypoints and lap, in words."""
    if v.progress is None or v.progress.total == 0:
        return "–"
    lap = f", lap {v.progress.laps + 1}" if v.progress.laps else ""
    places = sum(item.kind != item.JUMP for item in v.mission.items) if v.mission is not None else v.progress.total
    return f"{v.progress.current + 1} of {places}{lap}"


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


def _progress(text: str, share: float | None) -> Html:
    bar = "" if share is None else html("<span class='g-meter'><i style='width:{:.0f}%'></i></span>", 100 * share)
    return html("<div class='g-progress'>{}{}</div>", text, bar)


def order_line(order: Order | None) -> Html:
    """The last order: sent, accepted or refused and why."""
    if order is None:
        return html("<div class='g-order g-idle'>Nothing asked yet</div>")
    sign, style = {"sent": ("…", "warn"), "accepted": ("✓", "good"), "refused": ("✖", "bad")}[order.state]
    reason = f": {order.reason}" if order.reason else ""
    return html("<div class='g-order g-{}' role='status'>{} {} – {}{}</div>", style, sign, order.text, order.state, reason)
