"""The time bar: the last ten minutes with what happened in them, the moment on show, and a minute of them to keep."""

from collections.abc import Mapping
from typing import NamedTuple

from services.gcs.export import Exporter, ExportState
from services.gcs.state.history import LENGTH, RecentHistory, TimedLine
from services.gcs.state.past import PastModel
from services.gcs.state.past_choice import RATES
from services.gcs.state.session import BrowserSession
from services.gcs.view.controls import button, choice, does
from services.gcs.view.markup import Html, html, joined
from services.gcs.view.panels.status import SEVERITY, clock_text

TICKS_MOST = 60
TICK_TEXT = 120  # letters
KINDS = {"mcap": "log (MCAP)", "html": "page (HTML)"}


class TimeBar(NamedTuple):
    """What the time bar tells of."""

    history: RecentHistory
    exporter: Exporter
    pasts: Mapping[int, PastModel]
    """By page, of those that look at the past."""


def timeline(bar: TimeBar, session: BrowserSession, sim_time: float, t: float) -> Html:
    """The time bar of a page at ``t`` [s, wall]. sim_time: of what it shows [s]."""
    history, exported = bar.history, bar.exporter.state
    past = session.past
    begin = history.begin if history.begin is not None else t
    ago = t - past.t if past is not None else 0.0
    live = button("● LIVE", "live", pressed=past is None, hint="Show the present")
    steps = [
        button("|◀", "past-event", -1, more=html(" aria-label='Event before'"), hint="Event before", style="g-btn g-step"),
        button("▶|", "past-event", 1, more=html(" aria-label='Next event'"), hint="Next event", style="g-btn g-step"),
    ]
    running = past is not None and past.running
    if past is None:
        play = button("↶ 10 s", "past", -10.0, hint="Show how things stood ten seconds ago")
    else:
        play = button("⏸" if running else "▶", "past-play", not running, more=html(" aria-label='{}'", "Hold" if running else "Play"))
    rates = choice("Speed", RATES, f"× {past.rate:g}", "past-rate") if past is not None else html("")
    slider = html(
        "<input type='range' id='gcs-past' min='{:.0f}' max='0' step='0.5' value='{:.1f}' aria-label='Time shown, seconds before now' "
        "aria-valuetext='{}' {}>",
        -LENGTH,
        -ago,
        _ago(ago),
        does("past"),
    )
    unknown = html("<span class='g-before' style='width:{:.2f}%'></span>", 100 * max(1 - (t - begin) / LENGTH, 0.0))
    marks = joined(_tick(timed, t) for timed in history.ticks(t)[-TICKS_MOST:])
    line = html("<div class='g-past'>{}{}{}</div>", unknown, marks, slider)
    moment = html("<span class='g-moment'><b>{}</b> <i>{}</i></span>", clock_text(sim_time), _ago(ago))
    parts = (live, *steps, play, rates, line, moment, _export(exported))
    then = "" if past is None else " g-then"
    return html("<div class='g-timeline{}' role='group' aria-label='Time bar'>{}</div>", then, joined(parts))


def _ago(seconds: float) -> str:
    return f"−{int(seconds) // 60}:{int(seconds) % 60:02d}" if seconds > 0 else "now"


def _tick(timed: TimedLine, t: float) -> Html:
    line = timed.line
    sign, style = SEVERITY.get(line.severity, SEVERITY[0])
    words = f"{clock_text(line.t)} {f'{line.vehicle}: ' if line.vehicle else ''}{line.text}"[:TICK_TEXT]
    place = 100 * (1 - (t - timed.t) / LENGTH)
    about = html(" tabindex='-1' aria-hidden='true' data-key='{:.3f}' style='left:{:.2f}%'", timed.t, place)
    return button("", "past-at", round(timed.t - 0.5, 3), style=f"g-tick g-t-{style}", more=about, hint=f"{sign} {words}")


def _export(exported: ExportState) -> Html:
    """Why no minute can be kept; that one is being made; or where the last one is."""
    if exported.why_not:
        return html("<span class='g-keep g-idle' title='{}'>no log to keep</span>", exported.why_not)
    if exported.making:
        return html("<span class='g-keep' role='status'>making the {} …</span>", KINDS[exported.making])
    hint = "The minute around the moment on show, as a file"
    keys = [button(f"Keep as {what}", "export", kind, hint=hint) for kind, what in KINDS.items()]
    fault = html("<span class='g-bad' role='alert'>{}</span>", exported.fault) if exported.fault else html("")
    ready = html("")
    if exported.path:
        ready = html("<a href='{}' download>⤓ {} ({:.1f} MB)</a>", exported.path, exported.name, exported.size / 1e6)
    menu = html(
        "<details class='g-keep'><summary>Keep<span class='g-spell'> this minute</span></summary><div class='g-row'>{}</div></details>",
        joined(keys),
    )
    return html("{}{}{}", menu, ready, fault)
