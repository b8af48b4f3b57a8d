"""Which moment each page looks at: the present, or one of the last ten minutes, which stands or runs on."""

from math import isfinite

from services.gcs.actions.times import ExportMinute, OfTime, PlayPast, PlayRate, ShowLive, ShowMoment, ShowPast, StepEvent
from services.gcs.export import Exporter
from services.gcs.state.history import RecentHistory
from services.gcs.state.past import PastModel
from services.gcs.state.past_choice import RATES, PastChoice
from services.gcs.state.session import BrowserSession
from services.gcs.state.state import Model

NEAR = 0.5  # s: nearer to the present, or to an event, is the same
HALF = 30.0  # s


class TimeTravel:
    """Follows what the pages ask of their time bars. models: of the pages that look at the past, as they see it."""

    def __init__(self, model: Model, history: RecentHistory, exporter: Exporter) -> None:
        self._model = model
        self._history = history
        self._exporter = exporter
        self._t: float | None = None
        self.models: dict[int, PastModel] = {}

    def ask(self, t: float, session: BrowserSession, action: OfTime) -> None:
        """Carries out what a page asks of its time bar at ``t`` [s, wall]."""
        now = session.past
        match action:
            case ShowPast(_, ago):
                self._show(t, session, t + ago)
            case ShowMoment(_, at):
                self._show(t, session, at)
            case ShowLive():
                session.past = None
            case StepEvent(_, step):
                self._show_event(t, session, step)
            case PlayPast(_, on) if now is not None:
                session.past = now._replace(running=on)
            case PlayRate(_, name) if now is not None and name in RATES:
                session.past = now._replace(rate=RATES[name], running=True)
            case ExportMinute(_, kind):
                middle = now.t if now is not None else t
                until = min(middle + HALF, t)
                self._exporter.begin(kind, t - until, 2 * HALF)

    def _show(self, t: float, session: BrowserSession, at: float) -> None:
        begin = self._history.begin
        if begin is None or not isfinite(at) or at > t - NEAR:
            session.past = None
            return
        if session.past is None:
            session.pointed = session.to_confirm = None
        before = session.past or PastChoice(at)
        session.past = before._replace(t=max(at, begin))

    def _show_event(self, t: float, session: BrowserSession, step: int) -> None:
        now = session.past.t if session.past is not None else t
        times = [timed.t for timed in self._history.ticks(t)]
        there = [at for at in times if (at < now - NEAR if step < 0 else at > now + NEAR)]
        if there:
            self._show(t, session, there[-1] if step < 0 else there[0])

    def step(self, t: float) -> None:
        """Brings the models of the past to the moments on show at ``t`` [s, wall]."""
        passed = t - self._t if self._t is not None else 0.0
        self._t = t
        for session in self._model.sessions.values():
            now = session.past
            if now is not None and now.running:
                self._show(t, session, now.t + passed * now.rate)
        looking = {s.page: s.past for s in self._model.sessions.values() if s.past is not None}
        for page in self.models.keys() - looking.keys():
            del self.models[page]
        for page, choice in looking.items():
            if page not in self.models:
                self.models[page] = PastModel(self._model.site, self._history)
                self.models[page].model.sessions[page] = self._model.sessions[page]
            self.models[page].go_to(choice.t)
