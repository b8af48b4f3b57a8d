"""Parameters of the localization on a known map."""

from typing import Annotated

from msgspec import Meta

from uvf.models.keys import key
from uvf.slam.placing_params import PlacingParams

Variance = Annotated[float, Meta(ge=0, le=10)]


class FilterParams(PlacingParams, frozen=True):
    """turn_by_turn, turn_by_way, way_by_way, way_by_turn: alpha1 to alpha4 of the odometry's noise (Thrun et al. 2005, table 5.6)."""

    least_particles: Annotated[int, Meta(ge=20, le=100_000), key("", "Fewest particles.")] = 100
    most_particles: Annotated[int, Meta(ge=100, le=100_000), key("", "Most particles.")] = 5000
    beams: Annotated[int, Meta(ge=10, le=1000), key("", "Beams of a scan that are compared with the map.")] = 90
    turn_by_turn: Annotated[Variance, key("rad^2/rad^2", "alpha1 of the odometry's noise (Thrun et al. 2005, table 5.6).")] = 0.03
    turn_by_way: Annotated[Variance, key("rad^2/m^2", "alpha2, likewise.")] = 0.03
    way_by_way: Annotated[Variance, key("m^2/m^2", "alpha3, likewise.")] = 0.03
    way_by_turn: Annotated[Variance, key("m^2/rad^2", "alpha4, likewise.")] = 0.002
