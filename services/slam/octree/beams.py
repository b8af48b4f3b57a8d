"""Pictures and sweeps as beams in the sensor's frame: unit directions and how far each one saw."""

import numpy as np

from schemas.messages import CameraCalibration, CompressedImage, LaserScan
from services.slam.waiting_beams import RayBundle
from uvf.runtime.messages.convert import scan_rays
from uvf.runtime.messages.readings.depth_pictures import depth_rays

BEYOND = 2.0
"""A beam without a return is taken to end at so many times the reach: it is free as far as there, and has met nothing."""


def depth_beams(picture: CompressedImage, info: CameraCalibration, reach: float) -> RayBundle:
    """Beams (n, 3) [m] of a depth picture, in the optical frame; reach: [m], not more than the camera's own. Raises BadInput."""
    rays, depths = depth_rays(picture, info)
    return RayBundle(rays * np.where(depths == 0.0, BEYOND * reach, depths)[:, None], reach)


def sweep_beams(scan: LaserScan, reach: float) -> RayBundle:
    """Beams (n, 3) [m] of a 2-D lidar, in its own frame; reach: [m], not more than the lidar's own."""
    ranges, rays = scan_rays(scan)
    lengths = np.where((ranges > 0.0) & (ranges <= reach), ranges, BEYOND * reach)
    return RayBundle(np.column_stack((rays * lengths[:, None], np.zeros(len(rays)))), reach)
