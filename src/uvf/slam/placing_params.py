"""Parameters that mapping and localization share: how the correction of the odometry is told."""

from typing import Annotated

from msgspec import Meta

from uvf.models.params import Params

Positive = Annotated[float, Meta(gt=0)]


class PlacingParams(Params, frozen=True):
    correction_speed: Positive = 0.1  # m/s, how fast the published correction follows the matched one
    correction_turn: Positive = 0.1  # rad/s
