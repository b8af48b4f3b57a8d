"""The tables of the tabs Log and System."""

from collections.abc import Sequence

from schemas.messages import Event, Process
from services.gcs.state.event_log import EventHistory, EventLine
from services.gcs.state.state import Model
from services.gcs.state.vitals import Vitals
from services.gcs.view.markup import Html, html, joined
from services.gcs.view.panels.status import SEVERITY, clock_text
from uvf.runtime.messages.enum_names import enum_name

SHOWN, OF_OPERATOR = 40, 6  # lines of each kind
FILTERS = {"routine": "All", "notice": "No routine", "warning": "Warnings"}
STATES = {
    Process.STARTING: ("starting", "warn"),
    Process.RUNNING: ("running", "good"),
    Process.RESTARTING: ("restart", "warn"),
    Process.FAILED: ("failed", "bad"),
    Process.ENDED: ("ended", "idle"),
}
LATE, LATENESS = 0.005, 0.05  # share of the steps, s: beyond these a figure is marked
REFUSALS = 8  # keys of a process that are listed
HEADINGS = ("process", "state", "restarts", "CPU %", "late %", "worst ms", "gaps")
HINTS = (
    "",
    "",
    "how often it was started again",
    "share of one core over the last 5 s",
    "steps begun more than a period late, of all",
    "the latest that a step ever began",
    "messages missed, of all keys",
)


def event_log(journal: EventHistory) -> Html:
    """The log: operator's actions on top; below, all lines, filtered by the page itself (``data-log``)."""
    lines = list(journal)
    if not lines:
        return html("<div class='g-empty'>Nothing has happened yet</div>")
    mine = [line for line in lines if line.of_operator][-OF_OPERATOR:]
    asked = _rows(mine) if mine else html("<tr><td>Nothing has been asked for on this page yet</td></tr>")
    choice = joined(html("<button type='button' data-log='{}'>{}</button>", key, name) for key, name in FILTERS.items())
    rest = _rows([line for line in lines if not line.of_operator])
    return html(
        "<h2 class='g-h'>Asked for on this page</h2><table class='g-log' aria-live='polite'>{}</table>"
        "<h2 class='g-h'>Events <span class='g-filter' role='group' aria-label='events shown'>{}</span></h2>"
        "<table class='g-log g-events'>{}</table>",
        asked,
        choice,
        rest,
    )


def _rows(lines: Sequence[EventLine]) -> Html:
    """Newest first; of those that a filter would leave, enough whatever the filter."""
    rows, shown = [], dict.fromkeys(("operator", *FILTERS), 0)
    for line in reversed(lines):
        shown[line.kind] += 1
        if shown[line.kind] > SHOWN:
            continue
        sign, style = SEVERITY.get(line.severity, SEVERITY[Event.INFO])
        who = html("<b>{}</b> ", line.vehicle) if line.vehicle else ""
        cells = html("<td>{}</td><td class='g-{}'>{}</td><td>{}{}</td>", clock_text(line.t), style, sign, who, line.text)
        rows.append(html("<tr class='g-k-{}'>{}</tr>", line.kind, cells))
    return joined(rows)


def processes(model: Model, t: float) -> Html:
    """The table of processes at ``t`` [s, wall], a row each, from the launchers' and their own reports."""
    refused = html("<div class='g-warn'>⚠ not taken in from the bus: {}</div>", model.refused) if str(model.refused) else html("")
    names = sorted(model.processes.told.keys() | model.processes.vitals.keys())
    if not names:
        return html("<div class='g-empty'>No process has spoken yet</div>{}", refused)
    head = joined(html("<th title='{}'>{}</th>", hint, name) for name, hint in zip(HEADINGS, HINTS, strict=True))
    rows = joined(_process(name, model.processes.told.get(name), model.processes.vitals.get(name), t) for name in names)
    loads = [v.load for v in model.processes.vitals.values() if v.load is not None]
    total = html("<tr><td>together</td><td></td><td></td><td>{:.0f}</td><td colspan='3'></td></tr>", 100 * sum(loads))
    return html("<table class='g-system'><tr>{}</tr>{}{}</table>{}{}", head, rows, total, _refusals(model), refused)


def _refusals(model: Model) -> Html:
    """Which messages the processes have not taken, and why; empty when they have taken all."""
    found = [(name, refusal) for name, vitals in sorted(model.processes.vitals.items()) for refusal in vitals.report.refusals[:REFUSALS]]
    if not found:
        return html("")
    head = html("<tr><th>messages refused by</th><th>key</th><th>count</th><th>the first, because</th></tr>")
    rows = [html("<tr><td>{}</td><td>{}</td><td class='g-warn'>{}</td><td>{}</td></tr>", name, r.key, r.count, r.why) for name, r in found]
    return html("<table class='g-system g-refusals'>{}{}</table>", head, joined(rows))


def _process(name: str, process: Process | None, vitals: Vitals | None, t: float) -> Html:
    word, style = _state(process)
    if vitals is not None and vitals.silence(t) and word in ("running", "by hand"):
        word, style = f"silent {vitals.silence(t):.0f} s", "bad"
    starts = str(process.restarts) if process is not None else "–"
    more = [process.reason] if process is not None and process.reason else []
    if vitals is not None and vitals.report.missing and process is not None and process.state == Process.RUNNING:
        more.append(f"waits for {', '.join(vitals.report.missing)}")
    why = html("<tr class='g-why'><td colspan='7'>{}</td></tr>", "; ".join(more)) if more else ""
    figures = joined(_figures(vitals))
    return html("<tr><td>{}</td><td class='g-{}'>{}</td><td>{}</td>{}</tr>{}", name, style, word, starts, figures, why)


def _state(process: Process | None) -> tuple[str, str]:
    """(words, class)."""
    if process is None:
        return "by hand", "idle"
    return STATES.get(process.state) or (enum_name(Process.State, process.state), "warn")


def _figures(vitals: Vitals | None) -> list[Html]:
    if vitals is None:
        return [html("<td>–</td>")] * 4
    worst = vitals.report.worst_lateness
    return [
        html("<td>{:.0f}</td>", 100 * vitals.load) if vitals.load is not None else html("<td>…</td>"),
        html("<td{}>{:.1f}</td>", _marked(vitals.late > LATE), 100 * vitals.late),
        html("<td{}>{:.0f}</td>", _marked(worst > LATENESS), 1000.0 * worst),
        html("<td{}>{}</td>", _marked(vitals.gaps > 0), vitals.gaps),
    ]


def _marked(bad: bool) -> Html:
    return html(" class='g-warn'" if bad else "")
