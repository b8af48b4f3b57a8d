"""The panel for driving a ground vehicle by hand. Its buttons are also the page's table of keys: ``data-keys`` are those that press one."""

from schemas.messages import Mode
from services.gcs.by_hand import ByHand
from services.gcs.commands import mode_name
from services.gcs.state import VehicleModel
from uvf.runtime.teleop_hand import DIRECTIONS

ROWS = (("q", "w", "e"), ("a", "", "d"), ("z", "s", "c"))
SIGNS = {"q": "↖", "w": "▲", "e": "↗", "a": "◀", "d": "▶", "z": "↙", "s": "▼", "c": "↘"}
WORDS = {
    "q": "forward left",
    "w": "forward",
    "e": "forward right",
    "a": "turn left",
    "d": "turn right",
    "z": "backward, turning right",
    "s": "backward",
    "c": "backward, turning left",
}
ARROWS = {"w": "ArrowUp", "a": "ArrowLeft", "s": "ArrowDown", "d": "ArrowRight"}


def wheel(v: VehicleModel, by_hand: ByHand) -> str:
    """Each page shows the part that is meant for it: the one that drives ``g-mine``, the others ``g-theirs``."""
    if not by_hand.can_drive(v.name):
        return ""
    take = "Take the wheel" if by_hand.page else "Drive by hand"
    theirs = f"<div>{'driven from another page' if by_hand.page else ''}</div><button type='button' data-gcs='wheel:@me:on'>{take}</button>"
    mine = f"<button type='button' data-gcs='wheel:@me:off'>Stop driving by hand</button>{_pad(v, by_hand)}" if by_hand.page else ""
    return f"<div id='gcs-wheel' data-driver='{by_hand.page}'><div class='g-theirs'>{theirs}</div><div class='g-mine'>{mine}</div></div>"


def _pad(v: VehicleModel, by_hand: ByHand) -> str:
    keys = "".join(_key(key) if key else "<span></span>" for row in ROWS for key in row)
    linear, angular = by_hand.scale(v.name)
    scales = _scale("rf", f"{linear:.2f} m/s", "speed") + _scale("tg", f"{angular:.2f} rad/s", "turn rate")
    return f"<div class='g-drives'>{_state(v)}</div><div class='g-keys'>{keys}</div>{scales}"


def _state(v: VehicleModel) -> str:
    if v.status is None or v.status.mode != Mode.MODE_MANUAL:
        mode = mode_name(v.status.mode) if v.status is not None else "unknown"
        return f"<span class='g-warn'>⚠ {v.name} does not obey: its mode is {mode}, not Manual</span>"
    return f"<b>▶ {v.name} goes while a key or button is held</b>"


def _key(key: str) -> str:
    forward, left = DIRECTIONS[key]
    keys = f"{key} {ARROWS.get(key, '')}".strip()
    return f"<button type='button' data-keys='{keys}' data-steer='{forward:g} {left:g}' aria-label='{WORDS[key]}'>{SIGNS[key]}</button>"


def _scale(keys: str, value: str, what: str) -> str:
    """keys: the one that raises it and the one that lowers it."""
    up, down = (
        f"<button type='button' data-keys='{key}' data-gcs='scale:@me:{key}' aria-label='{what} {word}' title='key {key}'>{sign}</button>"
        for key, word, sign in zip(keys, ("up", "down"), "+−", strict=True)
    )
    return f"<div class='g-scale'><span>{what}</span>{down}<b>{value}</b>{up}</div>"
