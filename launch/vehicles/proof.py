"""Whether a tuning holds in the air: the figures of its proof flights, against what is wanted of them."""

import math
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rich.table import Table

from launch.scoring import touchdown
from launch.vehicles.proof_flight import LEG, Floats, ProofAir, ProofFlight, proof_flight
from uvf.control.design.design_axes import longer
from uvf.models.world.wind import TurbulenceFile

Indices = NDArray[np.intp]

AIRS = {
    "calm": ProofAir(None, True),
    "light turbulence": ProofAir(TurbulenceFile("light"), True),
    "moderate turbulence": ProofAir(TurbulenceFile("moderate"), False),
}
ENTRY, EXIT = 9.0, 6.0  # s of cruise, of a leg that belong to its turns
NEAR = 0.5  # of the circle's radius, from where it belongs
ENTERED, TURNED = 0.5, 1.75  # laps, between which the circle counts
SETTLED = 1.5  # s at the end of a step
BANK, CLIMB = "bank beyond a step of the stick", "climb beyond a step of the stick"
LEGS, HEIGHTS, CORNER, CIRCLE = (
    "beside the legs, RMS",
    "height on the legs, RMS",
    "beside the curve of the corner, most",
    "beside the circle, RMS",
)
SURFACES, PLACE, SINK = "way of the surfaces", "from the place to land at", "sink on touching"


@dataclass(frozen=True)
class ProofGoal:
    """Of one figure, at most in each of the AIRS; None: nothing is wanted of it there."""

    name: str
    unit: str
    most: tuple[float | None, ...]

    def at(self, airspeed: float) -> list[float | None]:
        """What is wanted of an aircraft of this cruise speed [m/s]."""
        by = longer(airspeed) if self.unit == "m" else 1.0
        return [most and by * most for most in self.most]


GOALS = (
    ProofGoal(BANK, "%", (15.0, None, None)),
    ProofGoal(CLIMB, "%", (25.0, None, None)),
    ProofGoal(LEGS, "m", (0.3, 0.6, 1.0)),
    ProofGoal(HEIGHTS, "m", (1.0, 1.2, 1.5)),
    ProofGoal(CORNER, "m", (1.0, 2.0, 3.0)),
    ProofGoal(CIRCLE, "m", (0.3, 0.6, 1.0)),
    ProofGoal(SURFACES, "deg/s", (0.8, 4.5, 9.0)),
    ProofGoal(PLACE, "m", (10.0, 15.0, None)),
    ProofGoal(SINK, "m/s", (1.2, 1.5, None)),
)


@dataclass(frozen=True)
class Proof:
    """Flights in the AIRS, and their figures by the names of GOALS; what could not be flown is missing."""

    flights: Sequence[ProofFlight]
    figures: Sequence[Mapping[str, float]]

    def most(self, goal: ProofGoal) -> list[float | None]:
        """What is wanted of it, in each of the AIRS; nothing of climbs and heights without an engine."""
        course = self.flights[0].course
        return [None] * len(AIRS) if goal.name in (CLIMB, HEIGHTS) and course.glide else goal.at(course.airspeed)

    def met(self, goal: ProofGoal) -> bool:
        """Whether it is, in each of the AIRS."""
        pairs = zip(self.figures, self.most(goal), strict=True)
        return all(most is None or figures.get(goal.name, math.inf) <= most for figures, most in pairs)

    def lines(self) -> Iterator[str]:
        """Yields what is not as it ought to be, a line each."""
        for air, flight in zip(AIRS, self.flights, strict=True):
            if flight.crash:
                yield f"proof flight, {air}: crashed, {flight.crash}"
            elif not flight.complete:
                yield f"proof flight, {air}: not at its end after {flight.t[-1]:.0f} s; what it said last: {flight.last_words}"
        if missed := [goal.name for goal in GOALS if not self.met(goal)]:
            yield f"proof flight: not met: {'; '.join(missed)}"

    def table(self) -> Table:
        """All figures with what is wanted of them."""
        table = Table("", *AIRS, "met", title="proof flights: found, and at most wanted")
        for goal in GOALS:
            cells = [_cell(figures.get(goal.name), most) for figures, most in zip(self.figures, self.most(goal), strict=True)]
            table.add_row(f"{goal.name}, {goal.unit}", *cells, "yes" if self.met(goal) else "no")
        return table


def _cell(found: float | None, most: float | None) -> str:
    figure = "-" if found is None else f"{found:.2f}"
    return figure if most is None else f"{figure} of {most:.3g}"


def prove(folder: Path) -> Proof:
    """Flies the aircraft in all AIRS, on as many processors. Raises BadInput."""
    with ProcessPoolExecutor() as pool:
        flights = list(pool.map(proof_flight, [folder] * len(AIRS), AIRS.values()))
    return Proof(flights, [figures(flight) for flight in flights])


def figures(flight: ProofFlight) -> dict[str, float]:
    """Those of GOALS, as far as it came."""
    steps, found = flight.course.steps, {}
    if flight.t[-1] > steps.end and flight.course.air.turbulence is None:
        found[BANK] = _beyond(flight, np.abs(flight.bank), steps.right, steps.left)
        if steps.hold > steps.climb:
            found[CLIMB] = _beyond(flight, flight.climb, steps.climb, steps.hold)
    if (way := Way.of(flight)) is not None:
        found |= _way(flight, way)
    if flight.course.air.lands and flight.complete:
        found |= _touch(flight)
    return found


@dataclass(frozen=True)
class Way:
    """Samples of a flight that count: of the legs to the north and to the east, of the circle."""

    north: Indices
    east: Indices
    circle: Indices

    @classmethod
    def of(cls, flight: ProofFlight) -> "Way | None":
        """None for one that has not flown all of it."""
        course, after = flight.course, flight.t > flight.course.steps.end
        x, y, _ = flight.position.T
        (east, north), (end, _), v = course.corner, course.end, course.airspeed
        near = NEAR * course.radius
        first = after & (y > north - (LEG - ENTRY) * v) & (y < north - EXIT * v) & (np.abs(x) < near)
        second = after & (x > east + ENTRY * v) & (x < end - EXIT * v) & (np.abs(y - north) < near)
        around = np.flatnonzero(after & (np.abs(_outside(flight)) < near))
        if not len(around):
            return None
        begins = flight.t[around[0]]
        since, before = (flight.t[around] - begins) / course.lap, flight.t < begins
        circle = around[(since > ENTERED) & (since < TURNED)]
        found = cls(np.flatnonzero(first & before), np.flatnonzero(second & before), circle)
        return found if len(found.north) and len(found.east) and len(circle) else None


def _way(flight: ProofFlight, way: Way) -> dict[str, float]:
    course, (x, y, z), (_, north) = flight.course, flight.position.T, flight.course.corner
    beside = np.concatenate([x[way.north], y[way.east] - north])
    bend = flight.t[way.north[-1]], flight.t[way.east[0]]
    above = z[np.concatenate([way.north, way.east])] - course.start
    return {
        LEGS: _rms(beside),
        **({} if course.glide else {HEIGHTS: _rms(above)}),
        CORNER: float(np.abs(flight.off_path[(flight.status_t >= bend[0]) & (flight.status_t <= bend[1])]).max()),
        CIRCLE: _rms(_outside(flight)[way.circle]),
        SURFACES: _activity(flight, [flight.t[k] for k in (way.north, way.east)]),
    }


def _outside(flight: ProofFlight) -> Floats:
    """m, of the circle."""
    (x, y, _), (east, north) = flight.position.T, flight.course.centre
    return np.asarray(np.hypot(x - east, y - north) - flight.course.radius)


def _activity(flight: ProofFlight, times: Sequence[Floats]) -> float:
    """Mean way of aileron, elevator and rudder together [deg/s]."""
    moved = total = 0.0
    for t in times:
        during = (flight.surfaces_t >= t[0]) & (flight.surfaces_t <= t[-1])
        moved += float(np.abs(np.diff(flight.surfaces[during], axis=0)).sum())
        total += t[-1] - t[0]
    return math.degrees(moved) / total


def _beyond(flight: ProofFlight, signal: Floats, begin: float, end: float) -> float:
    """%, by which the largest value of a step exceeds the one in which it settles."""
    during = (flight.t >= begin) & (flight.t < end)
    settled = float(np.mean(signal[during & (flight.t > end - SETTLED)]))
    return 100.0 * (float(signal[during].max()) / settled - 1.0) if settled > 0.0 else math.inf


def _touch(flight: ProofFlight) -> dict[str, float]:
    track = np.column_stack([flight.t, flight.position])
    if (at := touchdown.touchdown(track)) is None:
        return {}
    return {PLACE: float(np.hypot(*(flight.position[at, :2] - flight.course.centre))), SINK: touchdown.sink(track)}


def _rms(x: Floats) -> float:
    return float(np.sqrt(np.mean(np.square(x))))
