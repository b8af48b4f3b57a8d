"""Vehicles that another simulator moves: aircraft, as they were told of last."""

from collections.abc import Collection, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.messages import NavState
from uvf.runtime.messages.convert import array, seconds, wxyz
from uvf.sensors.surroundings import Whereabouts

Floats = NDArray[np.float64]
LONGEST = 0.1  # s, for which it is taken to go straight on


class Course(NamedTuple):
    """State at ``t`` [s] of a body that another simulator moves: position (3,) [m], velocity (3,) [m/s], world; world_from_body wxyz."""

    t: float
    position: Floats
    velocity: Floats
    world_from_body: Floats

    def at(self, t: float) -> Whereabouts:
        """Its pose extrapolated to ``t`` [s]."""
        return Whereabouts(self.position + self.velocity * min(max(t - self.t, 0.0), LONGEST), self.world_from_body)


def courses(truth: Mapping[str, NavState], names: Collection[str]) -> dict[str, Course]:
    """The courses of the named vehicles that have published their true motion."""
    return {
        name: Course(seconds(told.timestamp), array(told.position), array(told.velocity), wxyz(told.orientation))
        for name, told in truth.items()
        if name in names
    }
