"""The tables of the tabs Log and System. Text from the bus is escaped."""

from collections.abc import Sequence
from html import escape

from schemas.messages import Event, Process
from services.gcs.journal import Journal, Line
from services.gcs.state import Model
from services.gcs.status import SEVERITY, clock_text
from services.gcs.vitals import Vitals

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


def event_log(journal: Journal) -> str:
    """What the operator has done stays on top; below, everything, filtered by the page itself (``data-log``)."""
    lines = list(journal)
    if not lines:
        return "<div class='g-empty'>Nothing has happened yet</div>"
    mine = [line for line in lines if line.of_operator][-OF_OPERATOR:]
    asked = _rows(mine) if mine else "<tr><td>Nothing has been asked for on this page yet</td></tr>"
    choice = "".join(f"<button type='button' data-log='{key}'>{name}</button>" for key, name in FILTERS.items())
    rest = _rows([line for line in lines if not line.of_operator])
    return (
        f"<h4 class='g-h'>Asked for on this page</h4><table class='g-log' aria-live='polite'>{asked}</table>"
        f"<h4 class='g-h'>Events <span class='g-filter' role='group' aria-label='events shown'>{choice}</span></h4>"
        f"<table class='g-log g-events'>{rest}</table>"
    )


def _rows(lines: Sequence[Line]) -> str:
    """Newest first; of those that a filter would leave, enough whatever the filter."""
    rows, shown = [], dict.fromkeys(("operator", *FILTERS), 0)
    for line in reversed(lines):
        shown[line.kind] += 1
        if shown[line.kind] > SHOWN:
            continue
        sign, style = SEVERITY.get(line.severity, SEVERITY[Event.INFO])
        who = f"<b>{escape(line.vehicle)}</b> " if line.vehicle else ""
        cells = f"<td>{clock_text(line.t)}</td><td class='g-{style}'>{sign}</td><td>{who}{escape(line.text)}</td>"
        rows.append(f"<tr class='g-k-{line.kind}'>{cells}</tr>")
    return "".join(rows)


def processes(model: Model, t: float) -> str:
    """One row a process: what the launchers say of it, and what it says of itself."""
    names = sorted(model.processes.keys() | model.health.keys())
    if not names:
        return "<div class='g-empty'>No process has spoken yet</div>"
    head = "".join(f"<th title='{hint}'>{name}</th>" for name, hint in zip(HEADINGS, HINTS, strict=True))
    rows = "".join(_process(name, model.processes.get(name), model.health.get(name), t) for name in names)
    loads = [v.load for v in model.health.values() if v.load is not None]
    total = f"<tr><td>together</td><td></td><td></td><td>{100 * sum(loads):.0f}</td><td colspan='3'></td></tr>"
    return f"<table class='g-system'><tr>{head}</tr>{rows}{total}</table>"


def _process(name: str, process: Process | None, vitals: Vitals | None, t: float) -> str:
    word, style = STATES[process.state] if process is not None else ("by hand", "idle")
    if vitals is not None and vitals.silence(t) and word in ("running", "by hand"):
        word, style = f"silent {vitals.silence(t):.0f} s", "bad"
    starts = str(process.restarts) if process is not None else "–"
    more = [process.reason] if process is not None and process.reason else []
    if vitals is not None and vitals.report.missing and process is not None and process.state == Process.RUNNING:
        more.append(f"waits for {', '.join(vitals.report.missing)}")
    why = f"<tr class='g-why'><td colspan='7'>{escape('; '.join(more))}</td></tr>" if more else ""
    figures = "".join(_figures(vitals))
    return f"<tr><td>{escape(name)}</td><td class='g-{style}'>{word}</td><td>{starts}</td>{figures}</tr>{why}"


def _figures(vitals: Vitals | None) -> list[str]:
    if vitals is None:
        return ["<td>–</td>"] * 4
    worst = vitals.report.worst_lateness
    return [
        f"<td>{100 * vitals.load:.0f}</td>" if vitals.load is not None else "<td>…</td>",
        f"<td{_marked(vitals.late > LATE)}>{100 * vitals.late:.1f}</td>",
        f"<td{_marked(worst > LATENESS)}>{1e3 * worst:.0f}</td>",
        f"<td{_marked(vitals.gaps > 0)}>{vitals.gaps}</td>",
    ]


def _marked(bad: bool) -> str:
    return " class='g-warn'" if bad else ""
