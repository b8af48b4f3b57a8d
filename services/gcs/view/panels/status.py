"""The bar over the scene: link and time, the states that want attention as long as they last, and notices of late."""

from collections.abc import Iterator
from typing import NamedTuple

from schemas.messages import Clock, Event, NavStatus, Process, StopEngagement
from services.gcs.orders.offers import SOURCE
from services.gcs.state.control import called
from services.gcs.state.session import BrowserSession
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import VehicleModel, link_of
from services.gcs.view.controls import button
from services.gcs.view.markup import Html, html, joined
from uvf.runtime.state.stop_all import told

SEVERITY: dict[int, tuple[str, str]] = {
    Event.INFO: ("·", "info"),
    Event.NOTICE: ("i", "notice"),
    Event.WARNING: ("⚠", "warn"),
    Event.ERROR: ("✖", "bad"),
    Event.CRITICAL: ("✖", "bad"),
}
SOURCES = {SOURCE: "this page", "mavlink": "a MAVLink ground station", "launcher": "the launcher"}
STOPS_SHOWN = 3
ALERTS_SHOWN, ALERT_LENGTH = 5, 120  # letters
UNWELL = {Process.RESTARTING: ("is started again", "warn"), Process.FAILED: ("has failed for good", "bad")}


class Alert(NamedTuple):
    """A state that wants attention."""

    style: str
    """Class of the line: bad or warn."""
    text: str
    vehicle: str = ""
    """The one that it is about, if any."""


def clock_text(seconds: float) -> str:
    """Simulation time [s] as ``00:01:23``."""
    whole = int(seconds)
    return f"{whole // 3600:02d}:{whole // 60 % 60:02d}:{whole % 60:02d}"


def system_link(model: Model, t: float) -> tuple[str, str]:
    """(word, CSS class) for the whole link at ``t`` [s, wall]: by the clock, or by the vehicles where there is no clock."""
    heard = [v.heard for v in model.vehicles.values() if v.heard is not None]
    newest = model.clock_at if model.clock_at is not None else max(heard, default=None)
    word, style = link_of(newest, t)
    if style == "good" and model.clock is not None and model.clock.state != Clock.RUNNING:
        return "PAUSED", "warn"
    return word, style


def status_bar(model: Model, session: BrowserSession, chosen: VehicleModel | None, t: float) -> Html:
    """The bar of a page at ``t`` [s, wall]: link, time, vehicles, the newest alarm, recording, who has control."""
    word, style = system_link(model, t) if session.past is None else ("PAST", "warn")
    rate = f"× {model.clock.rate:.2f}" if model.clock is not None and model.clock.rate > 0 else ""
    live = sum(link_of(v.heard, t)[1] == "good" for v in model.vehicles.values())
    parts = [
        html("<b class='g-{}'>● {}</b>", style, word),
        html("<span>sim <b>{}</b> <i>{}</i></span>", clock_text(model.sim_time), rate),
        html("<span class='g-spare'>{} of {} vehicles</span>", live, len(model.vehicles)),
        _recording(model),
        _newest_alarm(model, t),
    ]
    if chosen is not None:
        if session.past is None:
            parts.append(_control(model, session, chosen))
        shown = "<span class='g-shown' hidden data-name='{}' data-kind='{}' data-distance='{}'></span>"
        parts.append(html(shown, chosen.name, chosen.member.file.kind, 40 if chosen.flies else 3))
    return html("<div class='g-status'>{}</div>", joined(parts))


def _recording(model: Model) -> Html:
    recorder = model.processes.told.get("recorder")
    if recorder is None:
        return html("")
    if recorder.state == Process.RUNNING:
        return html("<span class='g-bad' title='everything on the bus is written to a log'>● REC</span>")
    return html("<span class='g-warn'>⚠ not recorded</span>")


def _newest_alarm(model: Model, t: float) -> Html:
    """What wants attention most, or else the last grave event while it stands over the scene; pressed, it brings its vehicle into view."""
    grave = [notice.line for notice in model.log.notices(t) if notice.line.severity >= Event.ERROR and not notice.good]
    events = [Alert("bad", f"✖ {f'{line.vehicle}: ' if line.vehicle else ''}{line.text}", line.vehicle) for line in grave]
    found = next(iter(alerts(model, t) + events), None)
    if found is None:
        return html("<span class='g-alarm g-good g-spare'>✓ no alarm</span>")
    if found.vehicle not in model.vehicles:
        return html("<span class='g-alarm g-{}'>{}</span>", found.style, found.text)
    about = html("data-name='{}' title='Bring {} into view'", found.vehicle, found.vehicle)
    return html("<button type='button' class='g-alarm g-{}' {}>{}</button>", found.style, about, found.text)


def _control(model: Model, session: BrowserSession, chosen: VehicleModel) -> Html:
    holder = model.control.holders.get(chosen.name, "")
    if not holder or holder not in model.present:
        return html("<span class='g-spare g-idle'>nobody controls {}</span>", chosen.name)
    if holder == session.operator:
        return html("<span class='g-spare g-good'>you control {}</span>", chosen.name)
    return html("<span class='g-warn'>{} controls {}</span>", called(holder), chosen.name)


def alert_lines(model: Model, t: float) -> Html:
    """The states that want attention at ``t`` [s, wall], over the scene."""
    return joined(html("<div class='g-alert g-a-{}'>{}</div>", style, text) for style, text, _ in alerts(model, t))


def alerts(model: Model, t: float) -> list[Alert]:
    """The states that want attention at ``t`` [s, wall].

    Only so many are shown: first what concerns the mission and its vehicles, then external ones, then processes, of each the gravest
    first. So neither strangers nor a launcher that tells of many failures hide what a vehicle of the mission needs.
    """
    own: list[Alert] = []
    external: list[Alert] = []
    if model.clock is not None and model.clock.waiting_for:
        held = "⚠ simulation clock held" if model.clock.t_ns else "starting (the first start compiles, about a minute)"
        own.append(Alert("warn", f"{held}: waiting for {model.clock.waiting_for}"))
    for v in model.vehicles.values():
        (external if model.is_external(v.name) else own).extend(_of_vehicle(model, v, t))
    stop = [Alert("bad", f"■ STOP ALL ENGAGED {_by_whom(model)}".rstrip())] if model.stopped else []
    found = stop + [alert for group in (own, external, _of_processes(model)) for alert in sorted(group, key=_gravity)]
    shown, rest = found[:ALERTS_SHOWN], sorted(found[ALERTS_SHOWN:], key=_gravity)
    more = [Alert(rest[0].style, f"and {len(rest)} more")] if rest else []
    return [one if len(one.text) <= ALERT_LENGTH else one._replace(text=f"{one.text[: ALERT_LENGTH - 1]}…") for one in shown] + more


def _gravity(alert: Alert) -> bool:
    """Sorts what is bad before what is only a warning."""
    return alert.style != "bad"


def _of_vehicle(model: Model, v: VehicleModel, t: float) -> Iterator[Alert]:
    word, style = link_of(v.heard, t)
    if style == "bad":
        yield Alert("bad", f"✖ {v.name}: {word}", v.name)
    elif v.nav_status is not None and v.nav_status.state == NavStatus.BLOCKED and not model.stopped:
        yield Alert("warn", f"⚠ {v.name} is blocked{f': {v.nav_status.reason}' if v.nav_status.reason else ''}", v.name)


def _of_processes(model: Model) -> Iterator[Alert]:
    for name, process in sorted(model.processes.told.items()):
        if process.state in UNWELL:
            words, style = UNWELL[process.state]
            yield Alert(style, f"{'✖' if style == 'bad' else '⚠'} {name} {words}{f': {process.reason}' if process.reason else ''}")


def _by_whom(model: Model) -> str:
    stops = model.stops
    if not stops:
        return "as a vehicle reports"
    named = [StopEngagement(source=SOURCES.get(one.source, one.source), reason=one.reason) for one in stops[:STOPS_SHOWN]]
    words = [f"by {told([one])}, {clock_text(whole.since.seconds)}" for one, whole in zip(named, stops, strict=False)]
    return "; ".join(words) + (f" and {len(stops) - STOPS_SHOWN} more" if len(stops) > STOPS_SHOWN else "")


def notices(model: Model, t: float) -> Html:
    """The notices of late, over the scene."""
    rows = []
    for line, good, _ in model.log.notices(t):
        sign, style = ("✓", "good") if good else SEVERITY.get(line.severity, SEVERITY[Event.INFO])
        who = html("<b>{}</b> ", line.vehicle) if line.vehicle else ""
        rows.append(
            html("<div class='g-note'><b class='g-{}'>{}</b> {}{} <i>{}</i></div>", style, sign, who, line.text, clock_text(line.t))
        )
    return html("<div class='g-notices'>{}</div>", joined(rows)) if rows else html("")


def stop_panel(model: Model) -> Html:
    """STOP ALL, its release, and whether it is engaged: since when and by whom, which vehicles obey it."""
    stop = button("■ STOP ALL", "stop", style="g-stop", hint="Ground vehicles stop, aircraft circle; at once")
    if not model.stopped:
        return stop
    release = button("Release STOP", "release", style="g-btn g-wide", hint="Vehicles obey commands again")
    heeding = ", ".join(v.name for v in model.vehicles.values() if v.stopped)
    missing = ", ".join(v.name for v in model.vehicles.values() if not v.stopped)
    lines = [html("<b>■ ENGAGED</b> {}", _by_whom(model))]
    lines += [html("<span class='g-good'>✓ heeded by {}</span>", heeding)] if heeding else []
    lines += [html("<span class='g-bad'>✖ not confirmed by {}</span>", missing)] if missing else []
    return html("{}<div class='g-stopline g-engaged' role='status'>{}</div>{}", stop, joined(lines, html("<br>")), release)
