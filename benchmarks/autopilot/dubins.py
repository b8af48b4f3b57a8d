"""The mission ``dubins`` flown in lockstep, judged where its paths change from one curvature to another.

A switch lasts from where the curvature begins to change to where it is that of the next segment; ``overshoot`` is the largest distance
of the true aircraft from the planned way from there until two seconds after it, ``control`` the same of where it believes to be: the
rest is the estimate's error.
``python -m benchmarks.autopilot.dubins docs/images`` draws docs/images/dubins.png.
"""

import sys
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from launch import catalogue
from launch.commands.bench import Figures
from services.autopilot.air.service import AutopilotAir
from services.sim_air.service import SimAir
from uvf.guidance.clothoid_dubins import SampledPath
from uvf.guidance.flight_plan import PlanItem
from uvf.guidance.route import Curve
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.time.lockstep import Lockstep

Floats = NDArray[np.float64]

MISSION = ROOT / "missions" / "dubins.yaml"
AFTER = 2.0  # s
ARROW = 50.0  # m
CURVED = 1e-5  # 1/m^2, change of curvature of a switch


@dataclass(frozen=True)
class Flown:
    """One curve: the way planned, and (k, 6) t [s], north, east [m], m along it and beside it of the true aircraft, and of its estimate."""

    item: int
    way: SampledPath
    rows: Floats


class Probe:
    """Looks into both services at every tick."""

    def __init__(self, lockstep: Lockstep) -> None:
        services = [shell.service for shell in lockstep.shells]
        (sim,) = (s for s in services if isinstance(s, SimAir))
        (self._autopilot,) = (s for s in services if isinstance(s, AutopilotAir))
        (self._craft,) = sim._stage.aircraft.values()
        self._curves: list[tuple[int, Curve, list[tuple[float, ...]]]] = []

    def __call__(self, t: float) -> bool:
        """Whether the mission goes on; keeps where the aircraft is on its curve [m] at t [s]."""
        navigator = self._autopilot._mode_manager.navigator
        piece, (east, north, _) = navigator._piece, self._craft.motion.position.tolist()
        if isinstance(piece, Curve) and navigator.index is not None:
            if not self._curves or self._curves[-1][1] is not piece:
                self._curves.append((navigator.index, piece, []))
            about, now = (piece.s - 20.0, piece.s + 40.0), self._autopilot._now
            assert now is not None
            s, aside, _ = piece.way.nearest((north, east), about)
            _, believed, _ = piece.way.nearest((now.north, now.east), about)
            self._curves[-1][2].append((t, north, east, s, aside, believed))
        return not navigator.finished

    @property
    def items(self) -> tuple[PlanItem, ...]:
        """The plan, item by item."""
        return self._autopilot._mode_manager.navigator.items

    def flown(self) -> list[Flown]:
        """Every curve flown so far."""
        return [Flown(item, curve.way, np.array(rows)) for item, curve, rows in self._curves]


def fly() -> tuple[list[Flown], tuple[PlanItem, ...]]:
    """The mission in lockstep: its curves as flown, and the items of its plan."""
    site = load_scenario(MISSION)
    lockstep = Lockstep(catalogue.hosts(site, [catalogue.kind("sim_air"), catalogue.kind("autopilot")]))
    with closing(lockstep):
        probe = Probe(lockstep)
        lockstep.run(site.mission.duration, probe)
    return probe.flown(), probe.items


def switches(flown: Flown) -> Iterator[tuple[str, float, float]]:
    """From which to which curvature (L, R, S; what is not reached before the next switch counts), the overshoot and that of control [m]."""
    way, rows = flown.way, flown.rows
    changes = np.abs(np.diff(way.curvature) / np.diff(way.s)) > CURVED
    edges = np.flatnonzero(np.diff(np.concatenate(((False,), changes, (False,))).astype(int)))
    for begin, end in edges.reshape(-1, 2):
        inside = (rows[:, 3] >= way.s[begin]) & (rows[:, 3] <= way.s[end])
        if not inside.any():
            continue
        last = rows[inside][-1, 0] + AFTER
        window = (rows[:, 0] >= rows[inside][0, 0]) & (rows[:, 0] <= last)
        yield f"{_letter(way.curvature[begin])}{_letter(way.curvature[end])}", *np.abs(rows[window, 4:]).max(axis=0).tolist()


def _letter(curvature: float) -> str:
    return "S" if abs(curvature) < 1e-4 else "R" if curvature > 0 else "L"


def figures(flown: list[Flown]) -> Figures:
    """By path: its length, its switches with the overshoots, and the RMS beside it."""
    table: Figures = {}
    for f in flown:
        found = list(switches(f))
        name = f"to item {f.item}: {' '.join(kind for kind, _, _ in found) or 'straight'}"
        worst: dict[str, float] = {}
        for k, (_, size, control) in enumerate(found, 1):
            worst |= {f"switch {k}, m": size, f"control {k}, m": control}
        true, believed = np.sqrt(np.mean(f.rows[:, 4:] ** 2, axis=0))
        table[name] = {"length, m": f.way.length, "rms, m": float(true), "control rms, m": float(believed), **worst}
    return table


def draw(flown: list[Flown], items: tuple[PlanItem, ...], path: Path) -> None:
    """The map of the curves, and how far beside its path [m] the aircraft was over time [s]."""
    figure = Figure(figsize=(13.0, 7.5), layout="constrained")
    above, beside = figure.subplots(1, 2, width_ratios=(2, 1))
    _map(above, flown, items)
    for f in flown:
        beside.plot(f.rows[:, 0], f.rows[:, 4], linewidth=1)
        beside.plot(f.rows[:, 0], f.rows[:, 5], "0.6", linewidth=0.7)
        beside.axvline(f.rows[0, 0], color="0.8", linewidth=0.8)
    beside.set(title="beside the path; grey: as estimated", xlabel="s", ylabel="m")
    beside.grid(alpha=0.3)
    figure.savefig(path, dpi=80)


def _map(axes: Axes, flown: list[Flown], items: tuple[PlanItem, ...]) -> None:
    for f in flown:
        axes.plot(f.way.points[:, 1], f.way.points[:, 0], "C1", linewidth=4, alpha=0.5, label="planned" if f is flown[0] else None)
        axes.plot(f.rows[:, 2], f.rows[:, 1], "k", linewidth=0.9, label="flown (truth)" if f is flown[0] else None)
    for k, item in enumerate(items):
        assert item.course is not None
        n, e, c = item.place.north, item.place.east, item.course
        axes.annotate("", (e + ARROW * np.sin(c), n + ARROW * np.cos(c)), (e, n), arrowprops={"color": "C3", "width": 1, "headwidth": 6})
        axes.annotate(str(k), (e, n), color="C3", xytext=(5, -12), textcoords="offset points")
    axes.set(title="Dubins paths of milvus, wind 7 m/s to the south-east", xlabel="east, m", ylabel="north, m", aspect="equal")
    axes.grid(alpha=0.3)
    axes.legend()


def switches_case(data: Path | None) -> Figures:
    """A row for each path of the mission: its length, overshoots and RMS [m]."""
    return figures(fly()[0])


CASES = {"switches": switches_case}

if __name__ == "__main__":
    FLOWN, ITEMS = fly()
    draw(FLOWN, ITEMS, Path(sys.argv[1]) / "dubins.png")
    for NAME, ROW in figures(FLOWN).items():
        sys.stdout.write(f"{NAME:28} {'  '.join(f'{metric} {value:.2f}' for metric, value in ROW.items())}\n")
