"""Flight of the running JSBSim models against their linear models, and what they can do.

``steps``: steps of one control in trimmed level flight, servos left out; ``rms %`` is the difference between the flight and the
state-space model, ``book %`` that to the transfer function of Beard and McLain, chapter 5, both as share of the flight's own RMS.
In steps of elevator and throttle the ailerons keep the wings level.
``energy``: gliding with the motor off, the slowest balanced flight, the climb with full throttle, the longest flight on the battery.
``python -m benchmarks.sim.air.flight_dynamics docs/images`` draws what is in docs/explanation/flight-dynamics.md.
"""

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.signal import lsim

from launch.vehicles.linearize import airframe_of, linear_models, write_pole_map
from services.sim_air.analysis.linear import LinearModels, held_still, state_of
from services.sim_air.analysis.performance import climb_rate, glide_ratio, performance
from services.sim_air.engine.states import InitialState
from services.sim_air.engine.wiring import Controls
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle

Floats = NDArray[np.float64]
Figures = dict[str, dict[str, float]]
AIRCRAFT = ("milvus",)
ALTITUDE = 100.0  # m AMSL
SPEED = 25.0  # m/s
DEG = np.pi / 180
SHORT = 5.0  # s, for which the book's transfer functions of roll and pitch are meant: what follows is not in them


@dataclass(frozen=True)
class Manoeuvre:
    """One control moved from its trim: by ``size`` from 0.5 s on, or as a doublet of two times ``half`` [s]."""

    control: str
    size: float  # rad, throttle 0..1
    seconds: float
    signal: str
    scale: float
    unit: str
    half: float | None = None

    def input(self, t: Floats) -> Floats:
        """(k,) deviation of the control."""
        begun = t >= 0.5
        if self.half is None:
            return self.size * begun
        return self.size * (begun * 1.0 - 2.0 * (t >= 0.5 + self.half) + (t >= 0.5 + 2 * self.half))


MANOEUVRES = {
    "roll to aileron": Manoeuvre("aileron", 1 * DEG, 3.0, "phi", 1 / DEG, "deg"),
    "pitch to elevator": Manoeuvre("elevator", -0.5 * DEG, 2.0, "theta", 1 / DEG, "deg"),
    "pitch to elevator, phugoid": Manoeuvre("elevator", -0.1 * DEG, 40.0, "theta", 1 / DEG, "deg"),
    "airspeed to throttle": Manoeuvre("throttle", 0.02, 40.0, "V", 1.0, "m/s"),
    "Dutch roll to rudder doublet": Manoeuvre("rudder", 2 * DEG, 6.0, "beta", 1 / DEG, "deg", half=0.7),
}
LEVEL = np.array((0.3, 0.03))  # aileron per roll and roll rate, which keeps the wings level: the spiral mode would end long runs
CONTROLS = ("aileron", "elevator", "rudder", "throttle")


@dataclass(frozen=True)
class Response:
    """(k,) each, of the deviation from trim; ``book`` is None where the book has no transfer function of this pair."""

    t: Floats
    flown: Floats
    linear: Floats
    book: Floats | None

    def share(self, model: Floats) -> float:
        """%, of the flight's own RMS."""
        return float(100 * np.sqrt(np.mean((model - self.flown) ** 2) / np.mean(self.flown**2)))


def fly(vehicle: str, models: LinearModels, manoeuvre: Manoeuvre) -> Response:
    """The same inputs for the aircraft and for its models."""
    airframe = airframe_of(ROOT / "vehicles" / vehicle)
    trim = airframe.start(InitialState(np.array((0.0, 0.0, models.trim.altitude)), np.pi / 2, models.trim.airspeed, np.zeros(3)))
    body = load_vehicle(ROOT / "vehicles", vehicle).air
    assert body is not None
    dt = 1 / body.physics_hz
    t = dt * np.arange(round(manoeuvre.seconds / dt) + 1)
    moved = manoeuvre.input(t)
    states = [state_of(airframe.motion(), 0.0)]
    for size in moved[:-1]:
        given = {c: getattr(trim, c) + size * (c == manoeuvre.control) for c in CONTROLS}
        if manoeuvre.control in ("elevator", "throttle"):
            given["aileron"] -= float(LEVEL @ (states[-1] - states[0])[[6, 3]])
        airframe.command(Controls(**given))
        airframe.step()
        states.append(state_of(airframe.motion(), 0.0))
    inputs = np.zeros((len(t) - 1, 4))
    inputs[:, CONTROLS.index(manoeuvre.control)] = moved[:-1]
    side = models.lateral if manoeuvre.control in ("aileron", "rudder") else models.longitudinal
    linear = side.response(inputs[:, [models.whole.inputs.index(name) for name in side.inputs]], dt)
    deviations = np.array(states) - states[0]
    book = _book(models, manoeuvre.signal, moved, t) if manoeuvre.seconds < SHORT else None
    return Response(
        t, _signal(models, manoeuvre.signal, deviations, models.whole.states), _signal(models, manoeuvre.signal, linear, side.states), book
    )


def _signal(models: LinearModels, name: str, states: Floats, names: tuple[str, ...]) -> Floats:
    """(k,) of (k, n) deviations: a state, or airspeed or side slip for small deviations."""
    column = {n: states[:, k] for k, n in enumerate(names)}
    if name == "V":
        alpha = models.trim.alpha
        return column["u"] * np.cos(alpha) + column["w"] * np.sin(alpha)
    return column["v"] / models.trim.airspeed if name == "beta" else column[name]


def _book(models: LinearModels, name: str, moved: Floats, t: Floats) -> Floats:
    d = models.design
    numerator, denominator = {
        "phi": (d.a_phi2, (1.0, d.a_phi1, 0.0)),
        "theta": (d.a_theta3, (1.0, d.a_theta1, d.a_theta2)),
    }[name]
    return np.asarray(lsim(((numerator,), denominator), moved, t)[1])


def steps(data: Path | None) -> Figures:
    """A row for each manoeuvre: the largest deviation, and how far the models are off [%]."""
    figures: Figures = {}
    for vehicle in AIRCRAFT:
        models = linear_models(ROOT / "vehicles" / vehicle, SPEED, ALTITUDE)
        for name, manoeuvre in MANOEUVRES.items():
            response = fly(vehicle, models, manoeuvre)
            row = {"largest": float(np.abs(response.flown).max()) * manoeuvre.scale, "rms %": response.share(response.linear)}
            figures[f"{vehicle}: {name}, {manoeuvre.unit}"] = row | (
                {"book %": response.share(response.book)} if response.book is not None else {}
            )
    return figures


def energy(data: Path | None) -> Figures:
    """A row for each performance figure, with its airspeed [m/s] and angle of attack [deg]."""
    return {f"{vehicle}: {name}": row for vehicle in AIRCRAFT for name, row in _energy(vehicle)}


def _energy(vehicle: str) -> Iterator[tuple[str, dict[str, float]]]:
    body = load_vehicle(ROOT / "vehicles", vehicle).air
    assert body is not None
    with held_still(airframe_of(ROOT / "vehicles" / vehicle)) as airframe:
        found = performance(airframe, body, ALTITUDE)
    yield "best glide, -", {"value": glide_ratio(found.glide), "at m/s": found.glide.airspeed, "alpha deg": found.glide.alpha / DEG}
    yield "least sink, m/s", {"value": -climb_rate(found.sink), "at m/s": found.sink.airspeed, "alpha deg": found.sink.alpha / DEG}
    yield (
        "slowest balanced, m/s",
        {"value": found.slowest.airspeed, "at m/s": found.slowest.airspeed, "alpha deg": found.slowest.alpha / DEG},
    )
    yield "stall of the wing, m/s", {"value": found.stall_speed, "at m/s": found.stall_speed, "alpha deg": found.stall_alpha / DEG}
    if found.climb is not None:
        yield "best climb, m/s", {"value": climb_rate(found.climb), "at m/s": found.climb.airspeed, "alpha deg": found.climb.alpha / DEG}
    at = {"at m/s": found.cruise.airspeed, "alpha deg": found.cruise.alpha / DEG}
    yield "least battery power, W", {"value": found.power, **at}
    if found.endurance is not None:
        yield "endurance, h", {"value": found.endurance / 3600, **at}


def draw(folder: Path) -> None:
    """flight-steps.png and flight-poles.png of the first aircraft."""
    models = linear_models(ROOT / "vehicles" / AIRCRAFT[0], SPEED, ALTITUDE)
    write_pole_map(models, f"{AIRCRAFT[0]}: {SPEED:g} m/s, {ALTITUDE:g} m", folder / "flight-poles.png")
    figure = Figure(figsize=(12.0, 7.0), layout="constrained")
    for axes, (name, manoeuvre) in zip(figure.subplots(2, 3).flat, MANOEUVRES.items(), strict=False):
        response = fly(AIRCRAFT[0], models, manoeuvre)
        axes.plot(response.t, response.flown * manoeuvre.scale, "C0", linewidth=3, alpha=0.5, label="JSBSim")
        axes.plot(response.t, response.linear * manoeuvre.scale, "k--", linewidth=1, label="linear, state space")
        if response.book is not None:
            axes.plot(response.t, response.book * manoeuvre.scale, "C3:", linewidth=1.2, label="transfer function")
        axes.set(title=name, xlabel="s", ylabel=f"{manoeuvre.signal} {manoeuvre.unit}")
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    figure.axes[-1].remove()
    figure.savefig(folder / "flight-steps.png", dpi=80)


CASES = {"steps": steps, "energy": energy}

if __name__ == "__main__":
    draw(Path(sys.argv[1]))
