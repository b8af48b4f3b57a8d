"""Readings of the instruments that ground and air vehicles share, as messages."""

from schemas.convert import stamp, vector
from schemas.messages import Gnss, Imu
from uvf.maths.instruments import Fix, ImuReading
from uvf.runtime.vehicle_file import GnssSensor

SATELLITES = 14  # seen under an open sky


def imu_message(frame: str, reading: ImuReading) -> Imu:
    return Imu(
        timestamp=stamp(reading.t),
        frame_id=frame,
        angular_velocity=vector(reading.angular_velocity),
        specific_force=vector(reading.specific_force),
        magnetic_field=vector(reading.magnetic_field),
    )


def gnss_message(gnss: GnssSensor, fix: Fix) -> Gnss:
    """Its timestamp is the moment the fix is valid for."""
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
