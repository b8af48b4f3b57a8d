"""What is known of the sensors before the flight: their data sheets, as the vehicle's file states them, and what no sheet is below."""

import math
from dataclasses import dataclass

from uvf.estimation.ekf.states import MAGNETIC
from uvf.models.vehicle.sensors import Sensors

PA_PER_M = 11.7  # near the ground


@dataclass(frozen=True, slots=True)
class Datasheet:
    """Sensor noise, 1 sigma each. Defaults are those of small MEMS sensors, and the least that is believed of any."""

    gyro_noise: float = 0.001  # rad/s of a sample
    gyro_bias: float = 0.005  # rad/s at turn-on
    gyro_walk: float = 2e-5  # rad/s/sqrt(s)
    accel_noise: float = 0.02  # m/s^2
    accel_bias: float = 0.03  # m/s^2
    accel_walk: float = 3e-4  # m/s^2/sqrt(s)
    mag_noise: float = 0.5  # uT
    iron: float = 0.3  # uT, hard iron
    iron_walk: float = 0.005  # uT/sqrt(s)
    imu_hz: float = 100.0
    static_noise: float = 0.1  # m
    baro_walk: float = 0.01  # m/sqrt(s)
    pitot_noise: float = 1.0  # Pa
    pitot_bias: float = 1.0  # Pa
    drift: float = 0.0  # m, satellites, horizontal
    height_drift: float = 0.0  # m
    drift_time: float = 1000.0  # s


def read(sensors: Sensors) -> Datasheet:
    """Data sheet of a vehicle's sensors; none is believed to be better than the defaults."""
    least = Datasheet()
    found: dict[str, float] = {}
    if (imu := sensors.imu) is not None:
        wander = math.sqrt(2 / imu.instability_time)
        found |= {
            "gyro_noise": imu.gyro_noise,
            "gyro_bias": math.hypot(imu.gyro_bias, imu.gyro_instability),
            "gyro_walk": math.hypot(imu.gyro_random_walk, imu.gyro_instability * wander),
            "accel_noise": imu.accel_noise,
            "accel_bias": math.hypot(imu.accel_bias, imu.accel_instability),
            "accel_walk": math.hypot(imu.accel_random_walk, imu.accel_instability * wander),
            "mag_noise": imu.mag_noise / MAGNETIC,
            "iron": imu.mag_bias / MAGNETIC,
        }
    if (air := sensors.air_data) is not None:
        found |= {"static_noise": air.static_noise / PA_PER_M, "pitot_noise": air.differential_noise, "pitot_bias": air.differential_bias}
    if (gnss := sensors.gnss) is not None:
        found |= {"drift": gnss.horizontal_drift, "height_drift": gnss.vertical_drift}
    believed = {name: max(value, getattr(least, name)) for name, value in found.items()}
    hz, time = (imu.hz if imu else least.imu_hz), (gnss.drift_time if gnss else least.drift_time)
    return Datasheet(**believed, imu_hz=hz, drift_time=time)
