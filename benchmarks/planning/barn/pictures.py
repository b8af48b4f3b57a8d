"""A picture of a run: the world, the way driven, where odometry had it, the footprint at the end and what the scanner saw last."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon, Rectangle

from benchmarks.planning.barn.jackal import JACKAL
from benchmarks.planning.barn.scoring import NEAR_GOAL
from benchmarks.planning.barn.simulation import Run
from benchmarks.planning.barn.worlds import World
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2, transform

MARGIN = 1.0  # m


def draw(world: World, run: Run, path: Path) -> None:
    """Writes the picture as a PNG file."""
    figure = Figure(figsize=(7, 9), layout="constrained")
    axes = figure.subplots()
    _draw_world(axes, world, run)
    axes.plot(*run.true[:, :2].T, color="tab:blue", lw=1.2, label="driven")
    axes.plot(*run.believed[:, :2].T, color="tab:orange", lw=0.8, ls="--", label="by odometry")
    axes.plot(*run.seen.T, ".", color="tab:red", ms=2, label="last scan")
    x, y, yaw = run.end.tolist()
    axes.add_patch(Polygon(transform(Pose2(x, y, wrap(yaw)), JACKAL.footprint), fc="none", ec="tab:blue", lw=1.2))
    axes.plot((x, x + 0.4 * np.cos(yaw)), (y, y + 0.4 * np.sin(yaw)), color="tab:blue", lw=1.2)
    points = [run.true[:, :2], run.believed[:, :2], world.discs[:, :2], np.array((world.start[:2], world.goal, (x, y)))]
    points += [world.boxes[:, :2] - world.boxes[:, 2:] / 2, world.boxes[:, :2] + world.boxes[:, 2:] / 2]
    every = np.concatenate(points)
    low, high = every.min(axis=0) - MARGIN, every.max(axis=0) + MARGIN
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal", xlabel="x [m]", ylabel="y [m]")
    axes.set_title(f"{run.world}, trial {run.trial}: {run.ending} at {run.time:.2f} s, least clearance {run.clearance:.3f} m", fontsize=10)
    axes.legend(fontsize="small", loc="upper right")
    figure.savefig(path, dpi=90)


def _draw_world(axes: Axes, world: World, run: Run) -> None:
    for x, y, radius in world.discs.tolist():
        axes.add_patch(Circle((x, y), radius, fc="0.35", ec="none"))
    for x, y, radius in run.movers.tolist():
        axes.add_patch(Circle((x, y), radius, fc="tab:olive", ec="none", alpha=0.7))
    for x, y, a, b in world.boxes.tolist():
        axes.add_patch(Rectangle((x - a / 2, y - b / 2), a, b, fc="0.35", ec="none"))
    axes.add_patch(Circle(world.goal, NEAR_GOAL, fc="tab:green", ec="none", alpha=0.3))
    axes.plot(*world.start[:2], "k+", label="start")
