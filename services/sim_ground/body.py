"""What is known of a ground vehicle's body at one moment."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.kinematics import WheelSpeeds

Floats = NDArray[np.float64]


class Touch(NamedTuple):
    """other: name of what is touched; bearing: where on the body, rad from its x axis, counter-clockwise."""

    other: str
    bearing: float


class BodyState(NamedTuple):
    """Motion of base_link: the point on the floor under the axle's middle.

    position: (3,) m, world; velocity: (3,) m/s, world; world_from_body: wxyz; angular_velocity: (3,) rad/s, body (FLU);
    wheel_angles: left, right [rad] since the start, unwrapped.
    """

    position: Floats
    world_from_body: Floats
    velocity: Floats
    angular_velocity: Floats
    wheel_angles: tuple[float, float]
    wheel_speeds: WheelSpeeds
