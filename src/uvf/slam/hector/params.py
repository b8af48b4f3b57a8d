"""Parameters of scan matching on a pyramid of grids, by the names that hector_mapping gave them."""

from typing import Annotated

from msgspec import Meta

from uvf.models.params import Params


class HectorParams(Params, frozen=True):
    map_resolution: Annotated[float, Meta(ge=0.01, le=0.5)] = 0.05  # m, side of a cell of the finest map
    map_multi_res_levels: Annotated[int, Meta(ge=1, le=6)] = 3  # maps, each of cells twice as large as those of the one before
    update_factor_free: Annotated[float, Meta(gt=0.0, lt=0.5)] = 0.4  # what a beam makes of the probability 0.5 of a cell it goes through
    update_factor_occupied: Annotated[float, Meta(gt=0.5, lt=1.0)] = 0.9  # and of one that it ends in
    map_update_distance_thresh: Annotated[float, Meta(ge=0.0, le=5.0)] = 0.4  # m driven between readings that go into the maps
    map_update_angle_thresh: Annotated[float, Meta(ge=0.0, le=3.2)] = 0.13  # rad turned, the same
    laser_min_dist: Annotated[float, Meta(ge=0.0)] = 0.0  # m, beams that are shorter are not used
    laser_max_dist: Annotated[float, Meta(gt=0.0)] = 30.0  # m, beams that are longer
    use_odometry: bool = False  # begin where the odometry has the vehicle, not where the last reading was
