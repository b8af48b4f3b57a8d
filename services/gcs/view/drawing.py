"""The words in which the view speaks to a page: things in the scene, buttons, panels; plain data, no viser."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from services.gcs.actions.page import PageAction
from services.gcs.state.vehicle_model import DisplayPose
from services.gcs.view.markup import Html
from uvf.models.shapes.textured import TexturedMesh

Floats = NDArray[np.float64]
Colour = tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class MeshNode:
    """A mesh. vertices: (n, 3) [m, parent's frame]; faces: (m, 3) indices."""

    vertices: Floats
    faces: NDArray[np.int64]
    colour: Colour
    opacity: float = 1.0
    selects: str = ""
    """A click on it selects this vehicle."""


@dataclass(frozen=True, eq=False)
class TexturedNode:
    """A mesh under a picture, its vertices [m, parent's frame]."""

    mesh: TexturedMesh
    selects: str = ""
    """A click on it selects this vehicle."""


@dataclass(frozen=True, eq=False)
class Polyline:
    """A line. points: (n, 3) [m, parent's frame]."""

    points: Floats
    colour: Colour
    width: float = 2.0  # px


@dataclass(frozen=True, eq=False)
class Points:
    """A point cloud. points: (n, 3) [m, parent's frame]."""

    points: Floats
    colour: Colour
    size: float  # m


@dataclass(frozen=True, eq=False)
class FloorPicture:
    """A PNG lying on the ground: its sizes [m] and the position of its centre [m, world]."""

    png: bytes
    width: float
    height: float
    centre: tuple[float, float, float]
    yaw: float = 0.0


@dataclass(frozen=True, eq=False)
class TextNode:
    """A label at a position [m, parent's frame]."""

    text: str
    position: tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class Axes:
    """The axes of a frame, ``length`` [m] each; position (3,) [m] and quaternion (4,) wxyz in the parent's frame."""

    length: float
    position: Floats = field(default_factory=lambda: np.zeros(3))
    wxyz: Floats = field(default_factory=lambda: np.array((1.0, 0.0, 0.0, 0.0)))


@dataclass(frozen=True, eq=False)
class Boxes:
    """Cubes: middles (n, 3) [m, parent's frame], sides (n,) [m], colours (n, 3) of 0 to 255."""

    middles: Floats
    sides: Floats
    colours: NDArray[np.uint8]


Node = MeshNode | TexturedNode | Polyline | Points | FloorPicture | TextNode | Axes | Boxes


@dataclass(frozen=True)
class CameraView:
    """A camera's position and the point it looks at [m, world]."""

    position: tuple[float, float, float]
    look_at: tuple[float, float, float]


@dataclass(frozen=True)
class PagePanel:
    """What one browser alone is shown."""

    html: Mapping[str, Html] = field(default_factory=dict)
    """Markup by the slot of the page that it fills."""
    nodes: Mapping[str, Node] = field(default_factory=dict)
    """What only this browser sees in the scene."""
    places: Mapping[str, DisplayPose] = field(default_factory=dict)
    """Poses of the frames that only this browser has."""
    hidden: frozenset[str] = frozenset()
    """Nodes of the scene that it does not show, with all that hangs below them."""
    theme: str = "light"
    camera: CameraView | None = None
    """From where it looks; None: as its operator has turned the view."""
    views_chosen: int = 0
    """Rises with each view that is chosen: then the camera is set, wherever it was."""
    t: float = 0.0
    """Of when all this is [s, wall]."""


@dataclass(frozen=True)
class Picture:
    """What the page shows after a step, in common and per browser. A node that is the same object as before has not changed."""

    nodes: Mapping[str, Node] = field(default_factory=dict)
    places: Mapping[str, DisplayPose] = field(default_factory=dict)
    panels: Mapping[int, PagePanel] = field(default_factory=dict)
    """By page, as in ``BrowserSession.page``."""


class Page(Protocol):
    """Where pictures are shown and people click: viser, or a list in a test."""

    def show(self, picture: Picture) -> None:
        """Shows a picture in all browsers."""
        ...

    def actions(self) -> list[PageAction]:
        """Actions requested since the last call, oldest first."""

    def close(self) -> None:
        """Ends the page."""
        ...
