"""Pictures of a run: the map with the trajectory on it, and a page of how it came about."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.figure
import numpy as np
from matplotlib.collections import LineCollection
from numpy.typing import NDArray

from launch.slam.known import Known
from uvf.maths.alignment import aligned
from uvf.maths.se2_arrays import composed
from uvf.models.world.map_file import GridMap
from uvf.slam.evaluation.reference import Trajectory, deviations, is_alignable, paired
from uvf.slam.evaluation.relations import GROSS, relation_errors
from uvf.slam.evaluation.run import LogRun

Floats = NDArray[np.float64]

TRAJECTORY, ODOMETRY, REFERENCE = "#c1272d", "#7f7f7f", "#1f77b4"
GROUPS = (("near", "#2a9d4a"), ("far", "#e07b00"))
LARGEST = 14.0
"""Inches of the map's longer side."""
INK = 100.0
"""Pixels an inch."""
FRINGE, MARGIN = 0.002, 2.0
"""Share of the known cells at each side that may lie outside of the picture (single far beams), and m about the rest."""


def draw_map(grid: GridMap, run: LogRun, title: str, target: Path) -> None:
    """Draws the map with the final trajectory coloured by time into a PNG."""
    draw_on_map(grid, lambda axes: _show_way(axes, run), title, target)


def draw_on_map(grid: GridMap, draw: Callable[[Any], None], title: str, target: Path) -> None:
    """Draws the map with what ``draw`` adds to its axes [m] into a PNG."""
    sheet = matplotlib.figure.Figure(layout="constrained")
    axes = sheet.add_subplot()
    _show_map(axes, grid)
    draw(axes)
    width, height = (float(np.ptp(limits)) for limits in (axes.get_xlim(), axes.get_ylim()))
    scale = LARGEST / max(width, height)
    sheet.set_size_inches(max(width * scale, 4.0), max(height * scale, 3.0) + 0.5)
    axes.set_title(title, fontsize=10, loc="left")
    sheet.savefig(target, dpi=INK)


def draw_page(grid: GridMap, run: LogRun, known: Known, title: str, target: Path) -> None:
    """Draws map, trajectory against odometry and references, errors of the relations, and match quality over time into a PNG."""
    sheet = matplotlib.figure.Figure(figsize=(15.0, 15.0), layout="constrained")
    sheet.suptitle(title, fontsize=14, fontweight="bold")
    grids = sheet.add_gridspec(3, 2, height_ratios=(2.2, 1.0, 0.8))
    plan = sheet.add_subplot(grids[0, 0])
    _show_map(plan, grid)
    _show_way(plan, run)
    _titled(plan, "map and trajectory", "x [m]", "y [m]")
    _trajectories(sheet.add_subplot(grids[0, 1]), run, known)
    for column, turning in enumerate((False, True)):
        axes = sheet.add_subplot(grids[1, column])
        if known.references and not known.relations:
            _distances(axes, run, known, turning)
        else:
            _histogram(axes, run, known, turning)
    _quality(sheet.add_subplot(grids[2, :]), run)
    sheet.savefig(target, dpi=90)


def _show_map(axes: Any, grid: GridMap) -> None:
    """White free, black occupied, grey unknown."""
    grey = np.where(grid.cells < 0, 0.75, 1.0 - grid.cells / 100.0)
    rows, columns = grid.cells.shape
    x, y, _ = grid.origin
    extent = (x, x + columns * grid.resolution, y, y + rows * grid.resolution)
    axes.imshow(grey, cmap="gray", vmin=0.0, vmax=1.0, origin="lower", extent=extent, interpolation="antialiased")
    seen = np.nonzero(grid.cells >= 0)
    if len(seen[0]):
        for indices, corner, limit in ((seen[1], x, axes.set_xlim), (seen[0], y, axes.set_ylim)):
            low, high = np.quantile(indices, (FRINGE, 1.0 - FRINGE))
            limit(corner + low * grid.resolution - MARGIN, corner + high * grid.resolution + MARGIN)


def _show_way(axes: Any, run: LogRun) -> None:
    xy = run.final[:, :2]
    lines = LineCollection(list(np.stack((xy[:-1], xy[1:]), axis=1)), cmap="plasma", array=np.arange(len(xy) - 1), linewidths=0.7)
    axes.add_collection(lines)
    axes.plot(*xy[0], "o", color=TRAJECTORY, ms=5)


def _trajectories(axes: Any, run: LogRun, known: Known) -> None:
    axes.plot(*run.log.odom_from_base[:, :2].T, color=ODOMETRY, lw=0.8, label="odometry")
    axes.plot(*run.final[:, :2].T, color=TRAJECTORY, lw=1.0, label="final")
    for name, reference in known.references.items():
        ours, theirs = paired(Trajectory(run.log.stamps, run.final), reference)
        map_from_world = np.array(aligned(ours[:, :2], theirs[:, :2]))
        axes.plot(*composed(map_from_world, theirs)[:, :2].T, color=REFERENCE, lw=0.8, ls="--", label=name)
    axes.set_aspect("equal", adjustable="datalim")
    axes.legend(fontsize=8)
    _titled(axes, "trajectory", "x [m]", "y [m]")


def _histogram(axes: Any, run: LogRun, known: Known, turning: bool) -> None:
    """Of the final poses' errors, near and far relations apart, on a logarithmic scale."""
    what, unit = ("rotation", "deg") if turning else ("translation, Freiburg formula", "m")
    _titled(axes, f"errors of the relations: {what}", unit, "relations")
    if not known.relations:
        axes.text(0.5, 0.5, "no relations are known of this log", ha="center", va="center", transform=axes.transAxes)
        return
    found = [relation_errors(relations, run.log.stamps, run.final) for relations in known.relations.values()]
    near = np.concatenate([e.is_near for e in found])
    errors = np.concatenate([np.degrees(e.rotation) if turning else e.freiburg_translation for e in found])
    lowest = 1e-3 if not turning else 1e-2
    bins = np.geomspace(lowest, max(errors.max(initial=0.0), 1.0) * 1.1, 60)
    for (group, colour), mask in zip(GROUPS, (near, ~near), strict=True):
        shown = np.maximum(errors[mask], lowest)
        label = f"{group}: {mask.sum()}, mean {errors[mask].mean():.4f} {unit}" if mask.any() else f"{group}: none"
        axes.hist(shown, bins=bins, color=colour, alpha=0.6, label=label)
    if not turning:
        axes.axvline(GROSS, color="black", lw=0.8, ls=":")
    axes.set_xscale("log")
    axes.legend(fontsize=8)


def _distances(axes: Any, run: LogRun, known: Known, turning: bool) -> None:
    """Of the final poses from the references, by the number of the pose."""
    _titled(axes, f"distance to the reference: {'rotation' if turning else 'translation'}", "pose", "deg" if turning else "m")
    for name, reference in known.references.items():
        estimate = Trajectory(run.log.stamps, run.final)
        if turning and not is_alignable(estimate, reference):
            axes.plot([], label=f"{name}: path too short to align")
            continue
        error = deviations(estimate, reference)
        shown = np.degrees(error[:, 2]) if turning else np.hypot(error[:, 0], error[:, 1])
        axes.plot(shown, lw=0.8, label=name)
    axes.legend(fontsize=8)


def _quality(axes: Any, run: LogRun) -> None:
    t = np.array([r.t for r in run.log]) - run.log.readings[0].t
    axes.plot(t, run.quality, color=TRAJECTORY, lw=0.5)
    axes.set_ylim(-0.02, 1.02)
    _titled(axes, "quality of the online poses: how much of each scan fits", "s", "")


def _titled(axes: Any, title: str, x: str, y: str) -> None:
    axes.set_title(title, fontsize=10, loc="left")
    axes.set_xlabel(x, fontsize=8)
    axes.set_ylabel(y, fontsize=8)
    axes.tick_params(labelsize=8)
