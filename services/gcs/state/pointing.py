"""A place on the ground that was clicked, and what is to be done there."""

from dataclasses import dataclass

from schemas.messages import PreviewReply

TOOLS = ("go", "face", "measure", "home", "here")
"""Send the vehicle there; send it there and click again whither it is to look; measure to the next click; make it the vehicle's home;
say that it stands there, and click again whither it looks."""


@dataclass
class Pointed:
    """A clicked place [m, world]. vehicle: the one that was on show then."""

    x: float
    y: float
    vehicle: str
    tool: str = ""
    """What waits for a second click here: face, here or measure; "" while the menu is open."""
    to: tuple[float, float] | None = None
    """The second place of a measured distance."""
    preview: PreviewReply | None = None
    """The way there, once the planner has answered."""
