"""State estimation: attitude, navigation and air data filters of aircraft, wheel odometry of ground vehicles."""

from typing import TYPE_CHECKING

from uvf.lazy import lazily

if TYPE_CHECKING:
    from uvf.estimation.attitude import AttitudeFilter as AttitudeFilter
    from uvf.estimation.beard_mclain import BookEstimator as BookEstimator
    from uvf.estimation.ekf.datasheet import Datasheet as Datasheet
    from uvf.estimation.ekf.estimator import FullEstimator as FullEstimator
    from uvf.estimation.odometry.filter import DriveFilter as DriveFilter
    from uvf.estimation.sensor_inputs import GnssFix as GnssFix
    from uvf.estimation.sensor_inputs import InertialSample as InertialSample
    from uvf.estimation.sensor_inputs import Pressures as Pressures
    from uvf.estimation.sensor_inputs import Sensed as Sensed
    from uvf.estimation.state import Estimate as Estimate

OFFERED = {
    "FullEstimator": "uvf.estimation.ekf.estimator:FullEstimator",
    "BookEstimator": "uvf.estimation.beard_mclain:BookEstimator",
    "AttitudeFilter": "uvf.estimation.attitude:AttitudeFilter",
    "Estimate": "uvf.estimation.state:Estimate",
    "Sensed": "uvf.estimation.sensor_inputs:Sensed",
    "InertialSample": "uvf.estimation.sensor_inputs:InertialSample",
    "GnssFix": "uvf.estimation.sensor_inputs:GnssFix",
    "Pressures": "uvf.estimation.sensor_inputs:Pressures",
    "Datasheet": "uvf.estimation.ekf.datasheet:Datasheet",
    "DriveFilter": "uvf.estimation.odometry.filter:DriveFilter",
}
__all__ = list(OFFERED)
__getattr__, __dir__ = lazily(__name__, OFFERED)
