"""A picture of a world: on the left the floor plan from above, on the right how it looks."""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import trimesh
from matplotlib import patches
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from services.sim_camera.renderer import BulletRenderer, Pose
from uvf.maths.footprint import SIDES, footprint
from uvf.maths.rotations import from_matrix
from uvf.models.shapes.mesh import triangles
from uvf.models.shapes.scene import primitives
from uvf.models.shapes.solid import Solid, pose_at
from uvf.models.shapes.textured import textured, write_textured
from uvf.models.vehicle.sensors import Camera, Mount
from uvf.models.world.cutaway import CUT, cut_height, cut_open, cut_open_textured
from uvf.models.world.file import WorldFile
from uvf.models.world.geometry import FloorPlan, hills, seen, things
from uvf.models.world.terrain import relief

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

WIDTH, HEIGHT = 1440, 1040  # pixels of the view, drawn twice as large as shown
LENS = 0.9  # rad
LOOK_DOWN = np.radians(42.0)
LOOK_FROM = np.radians(-62.0)  # from the south-east
ON_THE_FLOOR = 0.02  # m, what lies lower is not drawn into the plan
ALL = 1e3  # m, above everything
WIDE = 3.0  # m, from which on a mesh is taken for a building
LINES = 2.0  # m, between lines of equal height


def save_picture(world: WorldFile, plan: FloorPlan, reachable: Mask, path: Path) -> None:
    """Draws a PNG: occupied cells dark, reachable floor (rows, columns) light green, things in their colours."""
    figure = Figure(figsize=(15, 6.5), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.35))
    draw_plan(left, world, plan, reachable)
    left.set_title(f"green: reachable, dark: occupied, dashed: moved by script ({plan.resolution:g} m cells)", fontsize=9)
    right.imshow(view(world))
    right.set_axis_off()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=80)


def draw_plan(axes: Axes, world: WorldFile, plan: FloorPlan, reachable: Mask | None) -> None:
    """Draws the floor plan of a world with its things from above; reachable: floor (rows, columns) drawn green, if any."""
    rows, columns = plan.cells.shape
    shown = np.full((rows, columns, 3), 0.8)
    if reachable is not None:
        shown[reachable] = (0.86, 0.95, 0.86)
    shown[plan.cells] = (0.25, 0.25, 0.28)
    far = (plan.x, plan.x + columns * plan.resolution, plan.y, plan.y + rows * plan.resolution)
    axes.imshow(shown, origin="lower", extent=far, interpolation="nearest")
    if (land := relief(world)) is not None:
        lines = axes.contour(land.x, land.y, land.heights, np.arange(0.0, land.heights.max(), LINES), colors="saddlebrown", linewidths=0.6)
        axes.clabel(lines, fontsize=7)
    parts = things(world)
    top = cut_height(world, parts)
    for solid in parts:
        _draw_solid(axes, solid, top)
        if solid.path is not None:
            axes.plot(solid.path.keys[:, 1], solid.path.keys[:, 2], "--", color=(0.8, 0.1, 0.1), linewidth=0.8)
    axes.set_xlim(far[:2])
    axes.set_ylim(far[2:])
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")


def _draw_solid(axes: Axes, solid: Solid, top: float) -> None:
    """The shadow on the ground of what lies below ``top`` [m]."""
    shadow = footprint(primitives(solid), ON_THE_FLOOR, min(top, ALL))
    look: dict[str, Any] = {"facecolor": (*solid.colour, 0.75), "edgecolor": (0, 0, 0, 0.35), "linewidth": 0.3}
    if solid.shape == "mesh":
        look["edgecolor"] = "none"
    for outline in shadow.outlines:
        if len(outline) > 2:
            axes.add_patch(patches.Polygon(outline, **look))
    for x, y, radius in shadow.discs:
        axes.add_patch(patches.CirclePolygon((x, y), radius, resolution=SIDES, **look))


def view(world: WorldFile) -> NDArray[np.uint8]:
    """RGB image (height, width, 3) from the south-east and above, tall things cut, moving ones at the start of their scripts."""
    camera = Camera(Mount((0.0, 0.0, 0.0)), hz=1.0, width=WIDTH, height=HEIGHT, fov=LENS, far=2000.0)
    with TemporaryDirectory() as scratch:
        placed = [_at_start(solid) for solid in _cut([*seen(world), *hills(world)], world, Path(scratch))]
        renderer = BulletRenderer(world, placed, {})
        try:
            picture = renderer.take(camera, _standpoint(world)).picture
        finally:
            renderer.close()
    halves: NDArray[np.uint8] = picture.reshape(HEIGHT // 2, 2, WIDTH // 2, 2, 3).mean(axis=(1, 3)).astype(np.uint8)
    return halves


def _cut(parts: list[Solid], world: WorldFile, scratch: Path) -> list[Solid]:
    """Under a roof everything ends at ``CUT``, else what may be a wall: upright boxes and wide meshes."""
    if world.terrain:
        return parts
    everything = cut_height(world, parts) == CUT
    return [cut for solid in parts if (cut := _cut_one(solid, everything, scratch)) is not None]


def _cut_one(solid: Solid, under_a_roof: bool, scratch: Path) -> Solid | None:
    """None where nothing is left."""
    parts = primitives(solid)
    low, high = parts.low.min(axis=0), parts.high.max(axis=0)
    may_be_wall = solid.shape == "box" or (solid.shape == "mesh" and (high - low)[:2].max() > WIDE)
    if high[2] <= CUT or solid.path is not None or not (under_a_roof or (may_be_wall and low[2] < CUT)):
        return solid
    is_upright = abs(solid.orientation[1]) + abs(solid.orientation[2]) < 1e-6
    if solid.shape == "box" and is_upright and low[2] < CUT:
        middle = np.array((*solid.position[:2], (low[2] + CUT) / 2))
        return replace(solid, size=(*solid.size[:2], float(CUT - low[2])), position=middle)
    file = scratch / f"{len(list(scratch.iterdir()))}.stl"
    if (mesh := textured(solid)) is not None:
        below = cut_open_textured(mesh, CUT)
        file, faces = file.with_suffix(".obj"), below.faces
        if len(faces):
            write_textured(below, file)
    else:
        vertices, faces = cut_open(*triangles(solid), CUT)
        if len(faces):
            trimesh.Trimesh(vertices, faces).export(file)
    if not len(faces):
        return None
    return Solid(solid.name, "mesh", (1.0, 1.0, 1.0), np.zeros(3), colour=solid.colour, mesh=file)


def _at_start(solid: Solid) -> Solid:
    position, orientation = pose_at(solid, 0.0)
    return Solid(solid.name, solid.shape, solid.size, position, orientation, solid.colour, solid.mesh)


def _standpoint(world: WorldFile) -> Pose:
    """Where the whole floor fills the view, or the whole terrain."""
    land = relief(world)
    x_min, y_min, x_max, y_max = world.floor if land is None else (land.x[0], land.y[0], land.x[-1], land.y[-1])
    middle = np.array(((x_min + x_max) / 2, y_min + 0.46 * (y_max - y_min), 0.0))
    away = np.array((np.cos(LOOK_FROM) * np.cos(LOOK_DOWN), np.sin(LOOK_FROM) * np.cos(LOOK_DOWN), np.sin(LOOK_DOWN)))
    distance = 0.5 * float(np.hypot(x_max - x_min, y_max - y_min)) / np.tan(LENS / 2) * 1.12
    forward = -away
    left = np.cross((0.0, 0.0, 1.0), forward)
    left /= np.linalg.norm(left)
    return Pose(middle + distance * away, from_matrix(np.column_stack((forward, left, np.cross(forward, left)))))
