"""Instruments as a vehicle's file describes them: their errors, their rates, and how their readings come to their readers."""

from typing import Any

import numpy as np

from uvf.maths.geodesy import LocalTangent
from uvf.maths.rotations import from_euler
from uvf.maths.se3 import Transform
from uvf.models.vehicle.sensors import GnssSensor, ImuSensor, Lidar, Mount, Sampled
from uvf.sensors.errors import Errors
from uvf.sensors.instruments import InertialUnit, Receiver
from uvf.sensors.sampling import DelayLine, Dropout
from uvf.sensors.sweeping import Sweeping


def gyro_errors(imu: ImuSensor) -> Errors:
    """Error budget of the gyroscopes [rad/s]."""
    return Errors(
        noise=imu.gyro_noise,
        bias=imu.gyro_bias,
        scale=imu.gyro_scale,
        drift=imu.gyro_instability,
        drift_time=imu.instability_time,
        random_walk=imu.gyro_random_walk,
        limit=imu.gyro_range,
        resolution=imu.gyro_resolution,
    )


def accelerometer_errors(imu: ImuSensor) -> Errors:
    """Error budget of the accelerometers [m/s^2]."""
    return Errors(
        noise=imu.accel_noise,
        bias=imu.accel_bias,
        scale=imu.accel_scale,
        drift=imu.accel_instability,
        drift_time=imu.instability_time,
        random_walk=imu.accel_random_walk,
        limit=imu.accel_range,
        resolution=imu.accel_resolution,
    )


def inertial_unit(imu: ImuSensor, rng: np.random.Generator) -> InertialUnit:
    """Simulated IMU and magnetometer with the errors of the vehicle's file."""
    magnetometer = Errors(noise=imu.mag_noise, bias=imu.mag_bias)  # T
    return InertialUnit(gyro_errors(imu), accelerometer_errors(imu), magnetometer, imu.mag_hz or imu.hz, rng)


def receiver(gnss: GnssSensor, tangent: LocalTangent, rng: np.random.Generator) -> Receiver:
    """Simulated satellite receiver with the errors of the vehicle's file; ``tangent``: the plane of the world's origin."""
    noise = np.array((gnss.horizontal_noise, gnss.horizontal_noise, gnss.vertical_noise))
    drift = np.array((gnss.horizontal_drift, gnss.horizontal_drift, gnss.vertical_drift))
    return Receiver(Errors(noise=noise, drift=drift, drift_time=gnss.drift_time), Errors(noise=gnss.speed_noise), tangent, rng)


def base_from_sensor(mount: Mount) -> Transform:
    """Where a sensor sits, as a transform."""
    return Transform(from_euler(*mount.rpy), np.array(mount.xyz))


def sweeping_of(lidar: Lidar) -> Sweeping:
    """Timing of a lidar's sweep by the vehicle's file."""
    return Sweeping(lidar.sweep_time, lidar.clockwise)


def line_of(sensor: Sampled, rng: np.random.Generator) -> DelayLine[Any]:
    """Delay line that takes a sensor's readings to their readers."""
    return DelayLine(sensor.hz, sensor.latency, Dropout(sensor.dropout, sensor.burst, rng) if sensor.dropout else None)
