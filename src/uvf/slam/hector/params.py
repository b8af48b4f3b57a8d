"""Parameters of scan matching on a pyramid of grids, by the names that hector_mapping gave them."""

from typing import Annotated

from msgspec import Meta

from uvf.models.keys import key, plain
from uvf.models.params import Params


class HectorParams(Params, frozen=True):
    """Parameters of ``HectorSlam``."""

    map_resolution: Annotated[float, Meta(ge=0.01, le=0.5), key("m", "Cell size of the finest map.")] = 0.05
    map_multi_res_levels: Annotated[
        int, Meta(ge=1, le=6), key("", "Maps of the pyramid; each has cells twice as large as the one before.")
    ] = 3
    update_factor_free: Annotated[
        float, Meta(gt=0.0, lt=0.5), key("", "Probability that a beam gives to a cell of probability 0.5 that it passes.")
    ] = 0.4
    update_factor_occupied: Annotated[
        float, Meta(gt=0.5, lt=1.0), key("", "Probability that a beam gives to a cell of probability 0.5 that it ends in.")
    ] = 0.9
    map_update_distance_thresh: Annotated[
        float, Meta(ge=0.0, le=5.0), key("m", "Distance driven between readings that are drawn into the maps.")
    ] = 0.4
    map_update_angle_thresh: Annotated[
        float, Meta(ge=0.0, le=3.2), key("rad", "Angle turned between readings that are drawn into the maps.")
    ] = 0.13
    laser_min_dist: Annotated[float, Meta(ge=0.0), key("m", "Shorter beams are not used.")] = 0.0
    laser_max_dist: Annotated[float, Meta(gt=0.0), key("m", "Longer beams are not used.")] = 30.0
    use_odometry: Annotated[bool, plain("The search starts where the odometry has the vehicle.")] = False
