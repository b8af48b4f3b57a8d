"""Readings of the instruments that ground and air vehicles share, as messages."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.messages import Battery, FrameTransforms, Gnss, Imu, LaserScan, Range
from uvf.models.vehicle.battery import Charge
from uvf.models.vehicle.sensors import GnssSensor, Lidar, RangeFinder, Sonar
from uvf.runtime.messages.convert import seconds, stamp, vector
from uvf.runtime.messages.outputs import Value
from uvf.sensors.instruments import ImuReading, ReceiverFix

SATELLITES = 14  # seen under an open sky


def imu_message(frame: str, reading: ImuReading) -> Imu:
    """Message of an IMU reading."""
    return Imu(
        timestamp=stamp(reading.t),
        frame_id=frame,
        angular_velocity=vector(reading.angular_velocity),
        specific_force=vector(reading.specific_force),
        magnetic_field=vector(reading.magnetic_field),
    )


def gnss_message(gnss: GnssSensor, fix: ReceiverFix) -> Gnss:
    """Message of a fix; its timestamp is the moment the fix is valid for."""
    horizontal, vertical = gnss.accuracy
    return Gnss(
        timestamp=stamp(fix.t),
        fix=Gnss.FIX_3D,
        latitude=fix.latitude,
        longitude=fix.longitude,
        altitude=fix.altitude,
        velocity_enu=vector(fix.velocity),
        horizontal_accuracy=horizontal,
        vertical_accuracy=vertical,
        speed_accuracy=gnss.speed_noise,
        satellites=SATELLITES,
    )


def scan_message(t: float, frame: str, lidar: Lidar, ranges: NDArray[np.float64]) -> LaserScan:
    """Message of ranges (beams,) [m] of a scan stamped ``t`` [s], counter-clockwise from ``start_angle``.

    The beams share [start, end] evenly, both ends included.
    """
    end = lidar.angle_min + (lidar.beams - 1) * lidar.angle_increment
    scan = LaserScan(timestamp=stamp(t), frame_id=frame, start_angle=lidar.angle_min, end_angle=end, ranges=ranges.tolist())
    scan.pose.orientation.w = 1.0
    return scan


def range_message(t: float, frame: str, sensor: Sonar | RangeFinder, distance: float) -> Range:
    """Message of a measured ``distance`` [m] at ``t`` [s]; a range finder's cone has no width."""
    return Range(
        timestamp=stamp(t),
        frame_id=frame,
        range=distance,
        field_of_view=sensor.fov if isinstance(sensor, Sonar) else 0.0,
        range_min=sensor.range_min,
        range_max=sensor.range_max,
    )


def battery_message(t: float, charge: Charge) -> Battery:
    """Message of a battery's voltage, current and charge at ``t`` [s]."""
    return Battery(timestamp=stamp(t), voltage=charge.voltage, current=charge.current, remaining=charge.remaining)


def later(read: Value, seconds_later: float) -> Value:
    """The same readings with stamps ``seconds_later`` [s]."""
    for message in read if isinstance(read, Sequence) else (read,):
        for stamped in message.transforms if isinstance(message, FrameTransforms) else (message,):
            stamped.timestamp.CopyFrom(stamp(seconds(stamped.timestamp) + seconds_later))  # type: ignore[attr-defined]
    return read
