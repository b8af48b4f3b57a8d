"""What one browser has chosen; another one's clicks change nothing of it."""

from dataclasses import dataclass, field
from math import inf

from services.gcs.state.layers import SHOWN_AT_FIRST


@dataclass
class BrowserSession:
    """One connection of one browser; it ends with the connection."""

    page: int
    """Which; never given to another one in the life of this ground station."""
    vehicle: str
    """The name of the one that it shows and commands."""
    layers: set[str] = field(default_factory=lambda: set(SHOWN_AT_FIRST))
    """What it shows of the scene."""
    camera: str = ""
    """The field of the vehicle whose picture is on show, where it has that camera."""
    looked_at: float = -inf
    """When it last said that somebody has the picture before his eyes [s, wall]."""
    to_confirm: tuple[str, bool, float] | None = None
    """(vehicle, arm or disarm, when [s, wall]) of the first of the two clicks that arming takes."""
