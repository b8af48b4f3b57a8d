"""Lets the bus be watched exactly while some page has the tab Graph open."""

from services.gcs.state.state import Model
from services.gcs.watch import BusWatch

TAB = "graph"


class BusListening:
    """Starts and stops the watch, and hands over to the model what it hears."""

    def __init__(self, model: Model, watch: BusWatch) -> None:
        self._model = model
        self._watch = watch
        self._on = False

    def step(self, t: float) -> None:
        """Brings the watch to what the pages show at ``t`` [s, wall], and takes what it has heard."""
        wanted = any(session.tab == TAB for session in self._model.sessions.values())
        if wanted and not self._on:
            self._model.graph.begin(t)
            self._watch.start()
        elif self._on and not wanted:
            self._watch.stop()
        self._on = wanted
        if wanted:
            self._model.graph.hear(t, self._watch.samples(), self._watch.tokens())

    def close(self) -> None:
        """Ends the watch."""
        self._watch.close()
