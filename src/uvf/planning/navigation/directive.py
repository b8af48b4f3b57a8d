"""What the navigator tells the local controller to do, and what it hears of it."""

from dataclasses import dataclass, field
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from uvf.planning.local.controller import Drive

Floats = NDArray[np.float64]


class Action(Enum):
    """Kinds of directives."""

    STOP = "stop"
    FOLLOW = "follow the path"
    SPIN = "turn on the spot"
    BACK_UP = "back up"


@dataclass(frozen=True)
class Directive:
    """One thing to do until the next one comes. number: rises with each new one; a controller begins anew when it changes."""

    number: int
    action: Action = Action.STOP
    path: Floats = field(default_factory=lambda: np.zeros((0, 2)))
    """(n, 2) m, for FOLLOW."""
    heading: float | None = None  # rad, wanted at the path's end
    amount: float = 0.0  # rad, anticlockwise, for SPIN; m for BACK_UP, at least: it goes on to where there is room to turn
    until: float | None = None
    """m along the path that may be driven now; None: all of it."""
    clear_beyond: float | None = None
    """m: obstacles farther away than this are forgotten when the directive comes."""


@dataclass(frozen=True)
class Report:
    """How the controller fares with the directive of ``number``. done: it is carried out; impossible: it cannot be."""

    number: int
    how: Drive = Drive.DRIVING
    done: bool = False
    impossible: bool = False
