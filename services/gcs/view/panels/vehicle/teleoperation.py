"""The panel for driving a ground vehicle by hand. Its buttons are also the page's table of keys: ``data-keys`` are those that press one."""

from schemas.messages import Mode
from services.gcs.orders.by_hand import ManualDriving
from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.state.wording import mode_name
from services.gcs.view.controls import button
from services.gcs.view.markup import Html, html, joined
from uvf.control.teleop_drive import DIRECTIONS, SIDEWAYS

ROWS = (("q", "w", "e"), ("a", "", "d"), ("z", "s", "c"))
SIDEWAYS_ROWS = (("Q", "", "E"), ("A", "", "D"), ("Z", "", "C"))
SIGNS = {
    "q": "↖",
    "w": "▲",
    "e": "↗",
    "a": "◀",
    "d": "▶",
    "z": "↙",
    "s": "▼",
    "c": "↘",
    "Q": "⇖",
    "E": "⇗",
    "A": "⇐",
    "D": "⇒",
    "Z": "⇙",
    "C": "⇘",
}
WORDS = {
    "q": "forward left",
    "w": "forward",
    "e": "forward right",
    "a": "turn left",
    "d": "turn right",
    "z": "backward, turning right",
    "s": "backward",
    "c": "backward, turning left",
    "Q": "forward and to the left, without turning",
    "E": "forward and to the right, without turning",
    "A": "sideways to the left",
    "D": "sideways to the right",
    "Z": "backward and to the left, without turning",
    "C": "backward and to the right, without turning",
}
ARROWS = {"w": "ArrowUp", "a": "ArrowLeft", "s": "ArrowDown", "d": "ArrowRight"}


def wheel(v: VehicleModel, by_hand: ManualDriving, page: int) -> Html:
    """The controls for driving by hand as this page sees them: it drives the vehicle itself, another page does, or nobody."""
    if not by_hand.can_drive(v.name):
        return html("")
    holder = by_hand.holder(v.name)
    if holder == page:
        stop = button("Stop driving by hand", "leave-wheel", style="g-btn g-wide")
        return html("<div id='gcs-wheel' data-driver='mine'><div class='g-mine'>{}{}</div></div>", stop, _pad(v, by_hand))
    driver, who = ("nobody", "") if holder is None else ("theirs", "driven from another page")
    take = button("Drive by hand", "take-wheel", v.name, style="g-btn g-wide", hint="Mode Manual, then keys, buttons or a gamepad")
    return html("<div id='gcs-wheel' data-driver='{}'><div class='g-theirs'><div>{}</div>{}</div></div>", driver, who, take)


def _pad(v: VehicleModel, by_hand: ManualDriving) -> Html:
    linear, angular, lateral = by_hand.scale(v.name)
    rows = (*ROWS, *SIDEWAYS_ROWS) if lateral > 0 else ROWS
    keys = joined(_key(key) if key else html("<span></span>") for row in rows for key in row)
    scales = joined((_scale("rf", f"{linear:.2f} m/s", "speed"), _scale("tg", f"{angular:.2f} rad/s", "turn rate")))
    return html("<div class='g-drives'>{}</div><div class='g-keys'>{}</div>{}", _state(v), keys, scales)


def _state(v: VehicleModel) -> Html:
    if v.status is None or v.status.mode != Mode.MODE_MANUAL:
        mode = mode_name(v.status.mode) if v.status is not None else "unknown"
        return html("<span class='g-warn'>⚠ {} does not obey: its mode is {}, not Manual</span>", v.name, mode)
    return html("<b>▶ {} goes while a key or button is held</b>", v.name)


def _key(key: str) -> Html:
    way = (DIRECTIONS | SIDEWAYS)[key]
    keys = f"{key} {ARROWS.get(key, '')}".strip()
    return html(
        "<button type='button' class='g-btn' data-keys='{}' data-steer='{:g} {:g} {:g}' aria-label='{}'>{}</button>",
        keys,
        *way,
        WORDS[key],
        SIGNS[key],
    )


def _scale(keys: str, value: str, what: str) -> Html:
    """keys: the one that raises it and the one that lowers it."""
    up, down = (
        button(sign, "scale", key, more=html("data-keys='{}' aria-label='{} {}'", key, what, word), hint=f"key {key}")
        for key, word, sign in zip(keys, ("up", "down"), "+−", strict=True)
    )
    return html("<div class='g-scale'><span>{}</span>{}<b>{}</b>{}</div>", what, down, value, up)
