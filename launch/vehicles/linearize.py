"""``uvf vehicle linearize``: an aircraft's level flight as linear models: tables, JSON, a map of the poles."""

import json
import math
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from rich.table import Table

from services.sim_air.analysis.linear import LinearModels, linearize
from services.sim_air.engine.airframe import Airframe
from uvf.maths.eigenmodes import Mode, lateral_modes, longitudinal_modes
from uvf.maths.geodesy import LocalTangent
from uvf.maths.state_space import StateSpace
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.layers import folders_of, holding
from uvf.models.yaml_data import BadInput

LATITUDE = 45.0  # deg, of standard gravity
CLEAR = 200.0  # m above the ground, for an aircraft that is held at its altitude
DEGREES = ("alpha", "climb", "roll", "aileron", "elevator", "rudder", "slip")
UNITS = {
    **{f"a_{name}": "1/s" for name in ("phi1", "beta1", "beta2", "theta1", "V1")},
    **{f"a_{name}": "1/s^2" for name in ("phi2", "theta2", "theta3")},
    **{f"a_{name}": "m/s^2" for name in ("V2", "V3")},
}


def airframe_of(folder: Path, ground: float = 0.0) -> Airframe:
    """The airframe of a vehicle's folder over a plain at ``ground`` [m AMSL]. Raises BadInput."""
    file = load_vehicle(folder.parent, folder.name)
    if file.air is None:
        raise BadInput(f"{folder}: kind is '{file.kind}'; only aircraft of JSBSim have these models")
    return Airframe(holding(folders_of(folder), file.air.model), file.air, LocalTangent.from_degrees(LATITUDE, 0.0, ground))


def linear_models(folder: Path, speed: float | None, altitude: float) -> LinearModels:
    """The linear models at ``speed`` [m/s], by default the trim speed of the vehicle's file, and ``altitude`` [m AMSL]. Raises BadInput."""
    airframe, file = airframe_of(folder, altitude - CLEAR), load_vehicle(folder.parent, folder.name)
    assert file.air is not None
    return linearize(airframe, speed or file.air.trim_speed, altitude, folder)


def tables(models: LinearModels) -> Iterator[Table]:
    """Yields the tables of trim, matrices, modes and transfer-function coefficients."""
    yield _trim_table(models)
    for title, side in (("longitudinal", models.longitudinal), ("lateral", models.lateral)):
        yield _matrix_table(title, side)
    yield _modes_table(models.modes)
    table = Table("book", "value", "unit", title="transfer functions, Beard and McLain chapter 5")
    for name, value in asdict(models.design).items():
        table.add_row(name, f"{value:.4g}", UNITS[name])
    yield table


def _trim_table(models: LinearModels) -> Table:
    table = Table("trim", "value", "unit", title="level flight; servos, engine and propeller quasi-steady")
    for name, value in asdict(models.trim).items():
        table.add_row(name, *(f"{math.degrees(value):.3f}", "deg") if name in DEGREES else (f"{value:.4g}", _unit(name)))
    table.add_row("residual", f"{models.residual:.1e}", "m/s^2, rad/s^2")
    return table


def _unit(name: str) -> str:
    return {"airspeed": "m/s", "altitude": "m AMSL", "throttle": "0..1"}[name]


def _matrix_table(title: str, side: StateSpace) -> Table:
    table = Table("", *side.states, *side.inputs, title=f"{title}: derivatives (rows) by states and inputs; m, s, rad, throttle 0..1")
    for name, states, inputs in zip(side.states, side.a, side.b, strict=True):
        table.add_row(f"{name}'", *(f"{0.0 if abs(value) < 5e-5 else value:.4f}" for value in (*states, *inputs)))
    return table


def _modes_table(modes: list[Mode]) -> Table:
    table = Table("mode", "eigenvalue 1/s", "frequency rad/s", "damping", "time constant s", "period s", title="modes")
    for mode in modes:
        value = mode.eigenvalue
        shown = f"{value.real:.4f}" + (f" +- {value.imag:.4f}i" if mode.oscillates else "")
        second_order = (f"{mode.frequency:.3f}", f"{mode.damping:.3f}") if mode.oscillates else ("", "")
        table.add_row(mode.name, shown, *second_order, f"{mode.time_constant:.4g}", f"{mode.period:.2f}" if mode.oscillates else "")
    return table


def as_json(models: LinearModels) -> str:
    """All figures of the tables as JSON; what is infinite is null."""
    sides = {"longitudinal": models.longitudinal, "lateral": models.lateral}
    figures: dict[str, Any] = {
        "trim": asdict(models.trim) | {"residual": models.residual},
        **{name: {"states": s.states, "inputs": s.inputs, "a": s.a.tolist(), "b": s.b.tolist()} for name, s in sides.items()},
        "modes": [_mode_figures(mode) for mode in models.modes],
        "design": asdict(models.design),
    }
    return json.dumps(figures, indent=1)


def write_json(models: LinearModels, target: Path) -> None:
    """Writes the figures as JSON. Raises BadInput where the file cannot be written."""
    try:
        target.write_text(as_json(models))
    except OSError as error:
        raise BadInput(f"{target}: cannot be written: {error.strerror}; choose another place") from error


def _mode_figures(mode: Mode) -> dict[str, Any]:
    figures = {name: getattr(mode, name) for name in ("frequency", "damping", "time_constant", "period")}
    finite = {name: value if math.isfinite(value) else None for name, value in figures.items()}
    return {"name": mode.name, "real": mode.eigenvalue.real, "imag": mode.eigenvalue.imag, **finite}


def write_pole_map(models: LinearModels, title: str, target: Path) -> None:
    """Draws the longitudinal and lateral eigenvalues into a PNG. Raises BadInput where it cannot be written."""
    figure = Figure(figsize=(11.0, 5.2), layout="constrained")
    longitudinal, lateral = figure.subplots(1, 2)
    _draw(longitudinal, "longitudinal", longitudinal_modes(models.longitudinal.a))
    _draw(lateral, "lateral", lateral_modes(models.lateral.a))
    figure.suptitle(title)
    try:
        figure.savefig(target, dpi=90)
    except (OSError, ValueError) as error:
        raise BadInput(f"{target}: cannot be written: {getattr(error, 'strerror', None) or error}; choose another place") from error


def _draw(axes: Axes, title: str, modes: list[Mode]) -> None:
    for number, mode in enumerate(modes):
        value, colour = mode.eigenvalue, f"C{number}"
        reach = (value.imag, -value.imag) if mode.oscillates else (0.0,)
        label = f"{mode.name}: {value.real:.3g}" + (f" ± {value.imag:.3g}i" if mode.oscillates else "")
        axes.plot([value.real] * len(reach), reach, "x", color=colour, markersize=9, markeredgewidth=2, label=label)
    axes.axvline(0.0, color="0.5", linewidth=0.8)
    axes.axhline(0.0, color="0.5", linewidth=0.8)
    axes.set_xscale("symlog", linthresh=0.1)
    axes.set_yscale("symlog", linthresh=0.1)
    axes.margins(0.15, 0.1)
    axes.set(title=title, xlabel="real 1/s", ylabel="imaginary 1/s")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2)
