"""Parameters of the localization on a known map."""

from typing import Annotated

from msgspec import Meta

from uvf.slam.placing_params import PlacingParams

Variance = Annotated[float, Meta(ge=0, le=10)]


class FilterParams(PlacingParams, frozen=True):
    """turn_by_turn, turn_by_way, way_by_way, way_by_turn: alpha1 to alpha4 of the odometry's noise (Thrun et al. 2005, table 5.6)."""

    least_particles: Annotated[int, Meta(ge=20, le=100_000)] = 100
    most_particles: Annotated[int, Meta(ge=100, le=100_000)] = 5000
    beams: Annotated[int, Meta(ge=10, le=1000)] = 90
    turn_by_turn: Variance = 0.03  # rad^2 per rad^2
    turn_by_way: Variance = 0.03  # rad^2 per m^2
    way_by_way: Variance = 0.03  # m^2 per m^2
    way_by_turn: Variance = 0.002  # m^2 per rad^2
