"""Lets the bus be watched exactly while some page has the tab Graph open or plots something."""

from services.gcs.state.state import Model
from services.gcs.watch import BusWatch

TAB, PLOT_TAB = "graph", "plot"


class BusListening:
    """Starts and stops the watch, and hands over to the model what it hears."""

    def __init__(self, model: Model, watch: BusWatch) -> None:
        self._model = model
        self._watch = watch
        self._on = False

    def step(self, t: float) -> None:
        """Brings the watch to what the pages show at ``t`` [s, wall], and takes what it has heard."""
        sessions = self._model.sessions.values()
        plotted = {name for session in sessions for name in session.plot.series}
        looked_at = {session.plot.topic for session in sessions if session.tab == PLOT_TAB and session.plot.topic}
        self._model.plots.keep(plotted, looked_at)
        wanted = bool(plotted or looked_at) or any(session.tab == TAB for session in sessions)
        if wanted and not self._on:
            self._model.graph.begin(t)
            self._watch.start()
        elif self._on and not wanted:
            self._watch.stop()
        self._on = wanted
        if wanted:
            heard = self._watch.samples()
            self._model.graph.hear(t, heard, self._watch.tokens())
            self._model.plots.hear(heard)

    def close(self) -> None:
        """Ends the watch."""
        self._watch.close()
