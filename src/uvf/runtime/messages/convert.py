"""Messages from and to numpy: vectors, quaternions (wxyz), poses, stamps, scans, grids."""

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from schemas.messages import FrameTransform, Grid, LaserScan, Mode, PackedElementField, Pose, Quaternion, Timestamp, Vector3
from uvf.maths.rotations import from_euler
from uvf.maths.se2 import Pose2

Floats = NDArray[np.float64]


def stamp(t: float) -> Timestamp:
    """Message stamp of simulation time ``t`` [s], exact to the nanosecond."""
    return stamp_ns(round(t * 1e9))


def stamp_ns(t_ns: int) -> Timestamp:
    """Message stamp of simulation time ``t_ns`` [ns]."""
    return Timestamp(seconds=t_ns // 1_000_000_000, nanos=t_ns % 1_000_000_000)


def seconds(s: Timestamp) -> float:
    """Time [s] of a message stamp."""
    return s.seconds + s.nanos * 1e-9


def vector(v: Floats) -> Vector3:
    """Message of a vector (3,)."""
    x, y, z = v.tolist()
    return Vector3(x=x, y=y, z=z)


def array(v: Vector3) -> Floats:
    """Vector (3,) of a message."""
    return np.array((v.x, v.y, v.z))


def quaternion(q: Floats) -> Quaternion:
    """Message of a quaternion wxyz (4,)."""
    w, x, y, z = q.tolist()
    return Quaternion(w=w, x=x, y=y, z=z)


def wxyz(q: Quaternion) -> Floats:
    """Quaternion wxyz (4,) of a message; the all-zero default of an unset field is the identity."""
    out = np.array((q.w, q.x, q.y, q.z))
    return out if out.any() else np.array((1.0, 0.0, 0.0, 0.0))


def yaw_of(q: Quaternion) -> float:
    """Heading [rad] of a body about the z axis."""
    w, x, y, z = wxyz(q)
    return float(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))


def planar_pose(x: float, y: float, yaw: float, z: float = 0.0) -> Pose:
    """Pose on level ground: x, y [m], yaw [rad], at height z [m]."""
    return Pose(
        position=Vector3(x=x, y=y, z=z),
        orientation=Quaternion(w=cos(yaw / 2), z=sin(yaw / 2)),
    )


def pose2_of(pose: Pose) -> Pose2:
    """Pose in the plane of a pose seen from above."""
    return Pose2(pose.position.x, pose.position.y, yaw_of(pose.orientation))


def planar_frame(t: float, parent: str, child: str, parent_from_child: Pose2) -> FrameTransform:
    """Transform at ``t`` [s] from one frame to another in the plane, both by their full names."""
    x, y, yaw = parent_from_child
    return FrameTransform(
        timestamp=stamp(t),
        parent_frame_id=parent,
        child_frame_id=child,
        translation=Vector3(x=x, y=y),
        rotation=quaternion(from_euler(0.0, 0.0, yaw)),
    )


def pose2_of_frame(transform: FrameTransform) -> Pose2:
    """Pose ``parent_from_child`` of a transform seen from above."""
    return Pose2(transform.translation.x, transform.translation.y, yaw_of(transform.rotation))


def scan_rays(scan: LaserScan) -> tuple[Floats, Floats]:
    """Ranges (n,) [m], 0 where nothing came back, and unit directions (n, 2) of the beams, lidar frame."""
    ranges = np.nan_to_num(np.asarray(scan.ranges, dtype=np.float64), nan=0.0, posinf=0.0, neginf=0.0)
    angles = np.linspace(scan.start_angle, scan.end_angle, len(ranges))
    return ranges, np.column_stack((np.cos(angles), np.sin(angles)))


def scan_points(scan: LaserScan) -> Floats:
    """Points (n, 2) [m, lidar frame] that the beams hit; those without a return are left out."""
    ranges, rays = scan_rays(scan)
    points: Floats = rays[ranges > 0.0] * ranges[ranges > 0.0, None]
    return points


def occupancy_grid(cells: NDArray[np.int8], resolution: float, x: float, y: float, frame: str, t: float) -> Grid:
    """Message at ``t`` [s] of cells (rows, columns) of side ``resolution`` [m]; the lower left corner of cell [0, 0] is (x, y) [m]."""
    columns = cells.shape[1]
    grid = Grid(
        timestamp=stamp(t),
        frame_id=frame,
        pose=planar_pose(x, y, 0.0),
        column_count=columns,
        row_stride=columns,
        cell_stride=1,
        fields=[PackedElementField(name="occupancy", offset=0, type=PackedElementField.INT8)],
        data=np.ascontiguousarray(cells).tobytes(),
    )
    grid.cell_size.x = grid.cell_size.y = resolution
    return grid


def cost_grid(values: NDArray[np.uint8], resolution: float, x: float, y: float, frame: str, t: float) -> Grid:
    """Message of costs (rows, columns) with the values of ROS' costmap_2d; the rest as for ``occupancy_grid``."""
    grid = occupancy_grid(values.view(np.int8), resolution, x, y, frame, t)
    grid.fields[0].name, grid.fields[0].type = "cost", PackedElementField.UINT8
    return grid


def cost_cells(grid: Grid) -> NDArray[np.uint8]:
    """Costs (rows, columns) of a message, row 0 at the lowest y."""
    return np.frombuffer(grid.data, dtype=np.uint8).reshape(-1, grid.column_count)


def occupancy_cells(grid: Grid) -> NDArray[np.int8]:
    """Cells (rows, columns) of a message, row 0 at the lowest y; -1 unknown, 0 free .. 100 occupied."""
    return np.frombuffer(grid.data, dtype=np.int8).reshape(-1, grid.column_count)


def mode_name(mode: int) -> str:
    """Name of a mode without its prefix, ``MISSION`` for ``MODE_MISSION``; the number for an unknown one."""
    return Mode.Name(Mode.ValueType(mode)).removeprefix("MODE_") if mode in Mode.values() else str(mode)
