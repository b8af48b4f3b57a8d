"""Parameters that mapping and localization share: how the correction of the odometry is told."""

from typing import Annotated

from msgspec import Meta

from uvf.models.keys import key
from uvf.models.params import Params

Positive = Annotated[float, Meta(gt=0)]


class PlacingParams(Params, frozen=True):
    """Parameters that mapping and localization share."""

    correction_speed: Annotated[Positive, key("m/s", "Largest speed at which the published correction follows the matched one.")] = 0.1
    correction_turn: Annotated[Positive, key("rad/s", "Largest rate at which the published correction follows the matched one.")] = 0.1
