"""The three messages of the round-trip benchmark."""

import numpy as np

from schemas.convert import occupancy_grid, planar_pose, stamp
from schemas.messages import LaserScan, PoseInFrame
from schemas.topics import Qos

MESSAGES = {
    "pose": (PoseInFrame(timestamp=stamp(1.5), frame_id="world", pose=planar_pose(1.0, 2.0, 0.3)), Qos.STATE),
    "scan 360": (LaserScan(timestamp=stamp(1.5), frame_id="v/lidar", end_angle=6.28, ranges=np.linspace(0.1, 3.5, 360)), Qos.SENSOR),
    "grid 200x200": (occupancy_grid(np.zeros((200, 200), dtype=np.int8), 0.05, -5, -5, "v/map", 1.5), Qos.SENSOR),
}
MESSAGES = {name.replace(" ", "_"): pair for name, pair in MESSAGES.items()}
