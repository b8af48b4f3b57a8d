"""Where a vehicle of a simulated run truly was, for what judges it: nothing that does its job may read this."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from schemas import topics
from uvf.runtime.bus.interface import Sample
from uvf.runtime.messages.convert import seconds, yaw_of

Floats = NDArray[np.float64]


def true_poses(samples: Iterable[Sample], vehicle: str) -> Floats:
    """True poses (n, 4): t [s], x, y [m], yaw [rad, unwrapped] in the world frame, from the samples of a log."""
    key = topics.TRUTH.at(vehicle)
    states = [topics.TRUTH.message.FromString(s.payload) for s in samples if s.key == key]
    track = np.array([(seconds(s.timestamp), s.position.x, s.position.y, yaw_of(s.orientation)) for s in states]).reshape(-1, 4)
    track[:, 3] = np.unwrap(track[:, 3])
    return track


def within(track: Floats, stamps: Floats) -> NDArray[np.bool_]:
    """(m,) which of the stamps (m,) [s] lie within the time span of a track (n, 4)."""
    reached: NDArray[np.bool_] = (stamps >= track[0, 0]) & (stamps <= track[-1, 0])
    return reached
