"""What one browser has chosen, of vehicle, tab, view, camera and layers; another one's clicks change nothing of it."""

from collections.abc import Set
from dataclasses import dataclass, field
from math import inf

from services.gcs.state.graph.graph_choice import GraphChoice
from services.gcs.state.past_choice import PastChoice
from services.gcs.state.plots.plot_choice import PlotChoice
from services.gcs.state.pointing import Pointed

ROOTS = {
    "Map": ("/map",),
    "Scan": ("/scan",),
    "Paths": ("/path", "/goal", "/mission"),
    "Fences": ("/fence",),
    "Tracks": ("/track",),
    "Labels": ("/label", "/height"),
    "Obstacles": ("/moving",),
    "Markers": ("/marker",),
    "Uncertainty": ("/sigma", "/particles"),
    "Costmaps": ("/costmap", "/costs"),
    "Octree": ("/octree",),
    "Frames": ("/frame",),
    "Walls": ("/world/walls",),
    "Team maps": ("/team",),
    "True pose": ("/true",),
}
"""Layer -> the nodes that bear it; each bears nothing else."""
LIVE_ROOTS = ("/vehicles", "/spawned", "/world/moving", *(root for roots in ROOTS.values() for root in roots if root != "/world/walls"))
"""The nodes that bear all that changes with time."""
PAST_ROOT = "/past"
"""The node that bears the same as it was at the moment that a browser looks at."""
SHOWN_AT_FIRST = frozenset(ROOTS) - {"Team maps", "True pose", "Costmaps", "Octree", "Frames"}
VIEWS = ("Scene", "All", "Top", "Follow")
"""From where a scene can be looked at; the first one at first."""
CONFIRM_WITHIN = 5.0  # s
SHED_AFTER = 1.0  # s that a page may be behind until it gets no more pictures
OLD_AFTER = 2.0  # s: a page that shows what is older must not do what cannot be undone


def hidden_roots(layers: Set[str], in_the_past: bool) -> frozenset[str]:
    """The scene nodes that a browser with these layers hides, with all below them."""
    unchecked = frozenset(root for layer, roots in ROOTS.items() if layer not in layers for root in roots)
    return unchecked | {PAST_ROOT + root for root in unchecked} | set(LIVE_ROOTS) if in_the_past else unchecked


@dataclass
class BrowserSession:
    """One connection of one browser; it ends with the connection."""

    page: int
    """Which; never given to another one in the life of this ground station."""
    vehicle: str
    """The name of the one that it shows and commands."""
    operator: str = ""
    """Who sits before it: the token that the browser keeps; "" until it has said so."""
    tab: str = ""
    table: bool = False
    """Whether it shows the fleet as a table."""
    theme: str = "light"
    aspect: float | None = None
    """Width over height [-] of its 3-D view; None until it has told."""
    touched: bool = False
    """Whether somebody has turned the view by hand since it was chosen."""
    view: str = VIEWS[0]
    """The named view that it has chosen."""
    views_chosen: int = 0
    layers: set[str] = field(default_factory=lambda: set(SHOWN_AT_FIRST))
    """What it shows of the scene."""
    plan_part: str = "mission"
    """What it draws in the tab Plan: a key of ``area_draft.PARTS``."""
    plot: PlotChoice = field(default_factory=PlotChoice)
    camera: str = ""
    """The field of the vehicle whose picture is on show, where it has that camera."""
    looked_at: float = -inf
    """When it last said that somebody has the picture before his eyes [s, wall]."""
    seen: float = -inf
    """Of when [s, wall] the newest status bar is that it has shown."""
    to_confirm: tuple[str, str, float] | None = None
    """(vehicle, command, when [s, wall]) of the first of the two clicks that some commands take."""
    past: PastChoice | None = None
    """The moment of the past that it looks at; None: the present."""
    pointed: Pointed | None = None
    """The place on the ground that was clicked."""

    graph: GraphChoice = field(default_factory=GraphChoice)
    """What it shows of the graph of services and topics."""

    def confirm(self, vehicle: str, key: str, t: float) -> bool:
        """Whether this click at ``t`` [s, wall] is the second one for a command; a first one is noted."""
        sure = self.confirms(vehicle, key, t)
        self.to_confirm = None if sure else (vehicle, key, t)
        return sure

    def confirms(self, vehicle: str, key: str, t: float) -> bool:
        """Whether a second click at ``t`` [s, wall] would carry out a risky command."""
        asked = self.to_confirm
        return asked is not None and asked[:2] == (vehicle, key) and t - asked[2] <= CONFIRM_WITHIN

    def behind(self, t: float) -> float:
        """Age [s] of what it shows at ``t`` [s, wall]."""
        return t - self.seen
