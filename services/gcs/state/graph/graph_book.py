"""What the tab Graph knows: declared and heard, and the graph that follows, made anew when it is asked for and old."""

from collections.abc import Sequence

from schemas.messages import Clock
from services.gcs.state.graph.endpoints import ServiceBook
from services.gcs.state.graph.node_graph import NodeGraph, graph_of, pace_of
from services.gcs.state.graph.traffic import BusTraffic
from services.gcs.state.process_book import ProcessBook
from services.gcs.state.refusals import PageRefusals
from services.gcs.watch import WatchedMessage

EVERY = 0.5  # s, wall, between two graphs


class GraphBook:
    """Services and traffic; services that were seen stay known while nobody listens, traffic does not."""

    def __init__(self, processes: ProcessBook, refused: PageRefusals) -> None:
        self.services = ServiceBook(refused)
        self.traffic = BusTraffic(refused)
        self._processes = processes
        self._since: float | None = None
        self._tokens: Sequence[str] | None = None
        self._made: tuple[float, NodeGraph] | None = None

    def begin(self, t: float) -> None:
        """Listening begins at ``t`` [s, wall]."""
        self._since, self._tokens, self._made = t, None, None
        self.traffic.clear()

    def hear(self, t: float, messages: Sequence[WatchedMessage], tokens: Sequence[str] | None) -> None:
        """Takes messages and the newest list of tokens at ``t`` [s, wall]; a list that was taken before is ignored."""
        self.traffic.hear(t, messages)
        if tokens is not None and tokens is not self._tokens:
            self._tokens = tokens
            self.services.hear(t, tokens)

    @property
    def has_looked(self) -> bool:
        """Whether the services have been asked who they are since listening began."""
        return self._tokens is not None

    def graph(self, t: float, clock: Clock | None, clock_at: float | None) -> NodeGraph:
        """The graph at ``t`` [s, wall], at most half a second old. clock_at: when the clock was heard last [s, wall]."""
        if self._made is None or t - self._made[0] >= EVERY:
            listened = t - self._since if self._since is not None else 0.0
            self._made = t, graph_of(self.services, self.traffic, self._processes, t, listened, pace_of(clock, clock_at, t))
        return self._made[1]
