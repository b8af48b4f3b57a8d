"""The bar over the scene: link and time, the states that want attention as long as they last, and notices of late."""

from collections.abc import Iterator
from html import escape

from schemas.messages import Clock, Event, NavStatus, Process
from services.gcs.commands import SOURCE
from services.gcs.state import Model, link_of

SEVERITY: dict[int, tuple[str, str]] = {
    Event.INFO: ("·", "info"),
    Event.NOTICE: ("i", "notice"),
    Event.WARNING: ("⚠", "warn"),
    Event.ERROR: ("✖", "bad"),
    Event.CRITICAL: ("✖", "bad"),
}
SOURCES = {SOURCE: "this page", "mavlink": "a MAVLink ground station", "launcher": "the launcher, because a service failed"}
UNWELL = {Process.RESTARTING: ("is started again", "warn"), Process.FAILED: ("has failed for good", "bad")}


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
    live = sum(link_of(v.heard, t)[1] == "good" for v in model.vehicles.values())
    chosen = model.chosen
    parts = [
        f"<b class='g-{style}'>● {word}</b>",
        f"<span>sim <b>{clock_text(model.sim_time)}</b> <i>{rate}</i></span>",
        f"<span>{live} of {len(model.vehicles)} vehicles</span>",
    ]
    if chosen is not None:
        parts.append(f"<span class='g-follow' hidden data-name='{chosen.name}' data-distance='{40 if chosen.flies else 3}'></span>")
    states = "".join(f"<div class='g-alert g-a-{style}'>{escape(text)}</div>" for style, text in alerts(model, t))
    return f"<div class='g-status'>{''.join(parts)}</div>{states}{_notices(model, t)}"


def alerts(model: Model, t: float) -> Iterator[tuple[str, str]]:
    """(class, text) of each state that wants attention now; each goes when its state goes."""
    if model.stopped:
        yield "bad", f"■ STOP ALL ENGAGED {_by_whom(model)}".rstrip()
    if model.clock is not None and model.clock.waiting_for:
        yield "warn", f"⚠ time stands: waits for {model.clock.waiting_for}"
    for name, process in sorted(model.processes.items()):
        if process.state in UNWELL:
            words, style = UNWELL[process.state]
            yield style, f"{'✖' if style == 'bad' else '⚠'} {name} {words}{f': {process.reason}' if process.reason else ''}"
    for v in model.vehicles.values():
        word, style = link_of(v.heard, t)
        if style == "bad":
            yield "bad", f"✖ {v.name}: {word}"
        elif v.nav_status is not None and v.nav_status.state == NavStatus.BLOCKED and not model.stopped:
            yield "warn", f"⚠ {v.name} is blocked{f': {v.nav_status.reason}' if v.nav_status.reason else ''}"


def _by_whom(model: Model) -> str:
    stop = model.stop
    if stop is None or not stop.engaged:
        return "as a vehicle reports"
    return f"by {SOURCES.get(stop.source, stop.source or 'somebody unnamed')}, {clock_text(stop.timestamp.seconds)}"


def _notices(model: Model, t: float) -> str:
    rows = []
    for line, good, _ in model.log.notices(t):
        sign, style = ("✓", "good") if good else SEVERITY.get(line.severity, SEVERITY[Event.INFO])
        who = f"<b>{escape(line.vehicle)}</b> " if line.vehicle else ""
        rows.append(f"<div class='g-note'><b class='g-{style}'>{sign}</b> {who}{escape(line.text)} <i>{clock_text(line.t)}</i></div>")
    return f"<div class='g-notices' aria-live='polite'>{''.join(rows)}</div>" if rows else ""


def stop_line(model: Model) -> str:
    """Under STOP ALL: whether it is engaged, since when and by whom, which vehicles heed it, how it ends."""
    if not model.stopped:
        return "<div class='g-stopline'>STOP ALL is not engaged</div>"
    heeding = [v.name for v in model.vehicles.values() if v.stopped]
    missing = [v.name for v in model.vehicles.values() if not v.stopped]
    told = f"<span class='g-good'>✓ heeded by {', '.join(heeding)}</span>" if heeding else ""
    silent = f"<span class='g-bad'>✖ not confirmed by {', '.join(missing)}</span>" if missing else ""
    who = escape(_by_whom(model))
    return (
        f"<div class='g-stopline g-engaged' role='status'><b>■ ENGAGED</b> {who}<br>{'<br>'.join(filter(None, (told, silent)))}"
        "<br>Holds until <b>Release STOP</b></div>"
    )
