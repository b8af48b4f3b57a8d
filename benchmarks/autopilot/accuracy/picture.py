"""The course in calm air, and in 10 m/s with turbulence.

``python -m benchmarks.autopilot.accuracy.picture docs/images`` draws accuracy.png.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.autopilot.accuracy.course import Course
from benchmarks.autopilot.accuracy.flight import Case, fly
from benchmarks.autopilot.accuracy.score import SETTLED, Flight, leg_windows

FLOWN = {"calm": Case(), "10 m/s from the east, moderate turbulence": Case((0.0, -10.0), "moderate")}


def draw(flights: dict[str, tuple[Flight, Course]], path: Path) -> None:
    """A column for each flight: its map, how far it is beside the planned path [m], and how far above the legs [m]."""
    figure = Figure(figsize=(13.0, 12.0), layout="constrained")
    rows = figure.subplots(3, len(flights), height_ratios=(3, 1, 1), squeeze=False)
    for k, (title, (flight, course)) in enumerate(flights.items()):
        _map(rows[0, k], flight, course)
        rows[0, k].set_title(title)
        _beside(rows[1, k], flight)
        _above(rows[2, k], flight, course)
    figure.savefig(path, dpi=75)


def _map(axes: Axes, flight: Flight, course: Course) -> None:
    corners, angle = course.corners, np.linspace(0.0, 2 * np.pi, 181)
    axes.plot(corners[:, 1], corners[:, 0], "C1", linewidth=4, alpha=0.5, label="legs and circles")
    for north, east, radius in course.circles:
        axes.plot(east + radius * np.sin(angle), north + radius * np.cos(angle), "C1", linewidth=4, alpha=0.5)
    axes.plot(flight.truth[:, 1], flight.truth[:, 0], "k", linewidth=0.9, label="flown (truth)")
    for leg, (north, east, _) in enumerate(corners[1:], 1):
        axes.annotate(str(leg), (east, north), color="C3", xytext=(4, 4), textcoords="offset points")
    axes.set(xlabel="east, m", ylabel="north, m", aspect="equal")
    axes.grid(alpha=0.3)
    axes.legend(loc="upper left")


def _beside(axes: Axes, flight: Flight) -> None:
    settled = flight.t > SETTLED
    for k, name in enumerate(("truth", "estimate")):
        axes.plot(flight.t[settled], flight.off_path[settled, k], linewidth=0.8, label=name)
    axes.set(ylabel="beside the planned path, m", xlabel="s", ylim=(-4, 4))
    axes.grid(alpha=0.3)
    axes.legend()


def _above(axes: Axes, flight: Flight, course: Course) -> None:
    """Over the line between the heights of each leg, in the windows that are scored; climbs and descents apart."""
    for window in leg_windows(flight, course):
        axes.plot(flight.t[window.k], window.above(flight.truth), "C3" if window.climbs else "C0", linewidth=0.9)
    axes.set(ylabel="above the leg (red: climb, descent), m", xlabel="s", ylim=(-4, 4))
    axes.grid(alpha=0.3)


if __name__ == "__main__":
    draw({title: fly("milvus", case) for title, case in FLOWN.items()}, Path(sys.argv[1]) / "accuracy.png")
