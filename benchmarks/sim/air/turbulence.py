"""Gusts as an aircraft meets them against the analytic spectra of MIL-F-8785C.

``python -m benchmarks.sim.air.turbulence spectra.png`` draws them.
"""

import sys
import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.signal import welch

from uvf.maths.dryden import FT, Strength, Turbulence, spectra, strength

Floats = NDArray[np.float64]
Figures = dict[str, dict[str, float]]
COMPONENTS = "uvwpqr"
SPEED, SPAN, HZ = 25.0, 2.9, 200.0  # Milvus
HEIGHTS = (60.0, 450.0, 1500.0)  # m
HOURS = 2.0  # of the plot


def _series(air: Strength, hours: float, hz: float = HZ) -> Floats:
    """(n, 6) gusts at steps of ``hz``."""
    turbulence = Turbulence(SPAN, np.random.default_rng(1))
    return np.array([turbulence.step(SPEED / hz, 1 / hz, air) for _ in range(round(hours * 3600 * hz))])


def intensities(data: Path | None) -> Figures:
    """Standard deviations of six hours in moderate turbulence against the roots of the spectra's integrals: m/s, rad/s."""
    omega = np.geomspace(1e-6, 1e5, 200_001)
    figures: Figures = {}
    for height in HEIGHTS:
        air = strength(height, 15.43, "moderate")
        measured, densities = _series(air, 6.0, 50.0).std(axis=0), spectra(omega, air, SPEED, SPAN)
        for component, sigma in zip(COMPONENTS, measured, strict=True):
            stated = float(np.sqrt(np.trapezoid(densities[component], omega)))
            figures[f"{component} at {height:g} m"] = {"sigma stated": stated, "sigma": float(sigma), "ratio": float(sigma) / stated}
    return figures


def cost(data: Path | None) -> Figures:
    """Time of one step of all six filters."""
    begin = time.perf_counter()
    series = _series(strength(60.0, 15.43, "moderate"), 0.1)
    return {"step of six filters": {"us": (time.perf_counter() - begin) / len(series) * 1e6}}


def plot(path: Path) -> None:
    """Welch's estimate from the gusts at 200 Hz beside the analytic spectra, low above the ground and high."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12, 7), layout="constrained")
    axes = figure.subplots(2, 3)
    for height, colour in ((60.0, "tab:blue"), (1500.0, "tab:orange")):
        air = strength(height, 15.43, "moderate")
        f, densities = welch(_series(air, HOURS), HZ, nperseg=65536, axis=0)
        omega = 2 * np.pi * f[1:]
        stated = spectra(omega, air, SPEED, SPAN)
        for axis, component, density in zip(axes.flat, COMPONENTS, densities.T, strict=True):
            axis.loglog(omega, density[1:] / (2 * np.pi), color=colour, linewidth=0.5, alpha=0.6, label=f"generated, {height:g} m")
            axis.loglog(omega, stated[component], "--", color=colour, linewidth=2, label=f"MIL-F-8785C, {height:g} m")
    for axis, component in zip(axes.flat, COMPONENTS, strict=True):
        unit = "m²/s" if component in "uvw" else "1/s"
        axis.set(xlabel="omega [rad/s]", ylabel=f"spectrum [{unit}]", title=f"{component}_g")
        axis.grid(True, which="major", alpha=0.3)
    axes[0, 0].legend(fontsize=8)
    knots = 15.43 / FT / 1.68781
    figure.suptitle(f"Dryden turbulence, W20 = {knots:.0f} knots, {SPEED:g} m/s, span {SPAN:g} m, {HOURS:g} h at {HZ:g} Hz")
    figure.savefig(path, dpi=90)


CASES = {"intensities": intensities, "cost": cost}

if __name__ == "__main__":
    plot(Path(sys.argv[1]))
