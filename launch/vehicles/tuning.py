"""``uvf vehicle tune``: the autopilot's figures of an aircraft from its own model, with the margins of the loops that they make."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from rich.table import Table

from launch.vehicles.aircraft_rules import HEIGHT
from launch.vehicles.autopilot_guess import autopilot_figures
from launch.vehicles.linearize import airframe_of
from launch.vehicles.loops import OMEGA, Loop, loops
from services.sim_air.analysis.linear import linearize
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.yaml_data import BadInput, FileLocation, convert

SERVICE = "autopilot_air"
USED = ("altitude_p", "climb_p", "climb_i", "airspeed_p", "power_pole")
"""Gains that are the same for all aircraft, unless the file says otherwise."""
SECONDS = {"roll": 6.0, "pitch": 6.0, "height": 20.0, "airspeed": 20.0}  # of the step responses


@dataclass(frozen=True)
class Tuning:
    """The autopilot parameters of an aircraft and the control loops that they make."""

    folder: Path
    before: dict[str, float]
    figures: dict[str, float]
    loops: list[Loop]


def tune(folder: Path) -> Tuning:
    """Tunes the autopilot for the aircraft in ``folder`` from its own model. Raises BadInput."""
    airframe, file = airframe_of(folder), load_vehicle(folder.parent, folder.name)
    assert file.air is not None
    before = convert(file.params.get(SERVICE, {}), AirParams, str(folder / "vehicle.yaml"), ("params", SERVICE))
    figures = autopilot_figures(airframe, file.air)
    models = linearize(airframe, file.air.trim_speed, HEIGHT, folder)
    gains = {**{name: getattr(before, name) for name in USED}, **figures}
    return Tuning(folder, {name: getattr(before, name) for name in figures}, figures, list(loops(models, gains, file.air)))


def tables(tuning: Tuning) -> Iterator[Table]:
    """Yields the table of parameters and that of the loops' margins."""
    figures = Table("parameter", "before", "now", title=f"{SERVICE} of {tuning.folder.name}")
    for name, value in tuning.figures.items():
        figures.add_row(name, f"{tuning.before[name]:.3g}", f"{value:.3g}")
    yield figures
    found = Table("loop", "opened", "phase margin deg", "at rad/s", "gain margin dB", "dead time besides s", title="margins")
    for loop in tuning.loops:
        m = loop.margins
        phase, gain = f"{np.degrees(m.phase):.0f}", f"{20 * np.log10(m.gain):.1f}"
        found.add_row(loop.axis, loop.opened, phase, f"{m.crossover:.1f}", gain, f"{m.delay:.3f}")
    yield found


def draw(tuning: Tuning, path: Path) -> None:
    """Draws the gain of the open loops and the step responses of the closed ones."""
    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    bode, step = figure.subplots(1, 2)
    for loop in tuning.loops:
        m = loop.margins
        label = f"{loop.axis}: {np.degrees(m.phase):.0f} deg at {m.crossover:.1f} rad/s"
        bode.semilogx(OMEGA, 20 * np.log10(np.abs(loop.response)), label=label)
        t = np.linspace(0.0, SECONDS[loop.axis], 301)
        step.plot(t, loop.step(t), label=loop.axis)
    bode.set(title="open loop, dB", xlabel="rad/s", ylim=(-40, 60))
    step.set(title="after a commanded step", xlabel="s")
    for axes in (bode, step):
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    figure.savefig(path, dpi=90)


def write(tuning: Tuning) -> Path:
    """Writes the parameters into the vehicle.yaml, which keeps its other lines; returns its path. Raises BadInput."""
    path = tuning.folder / "vehicle.yaml"
    text = with_params(path.read_text(encoding="utf-8"), tuning.figures, FileLocation(str(path)))
    path.write_text(text, encoding="utf-8")
    load_vehicle(tuning.folder.parent, tuning.folder.name)
    return path


def with_params(text: str, figures: Mapping[str, float], place: FileLocation) -> str:
    """The text of a vehicle.yaml with these autopilot parameters, each in its own unit (rad, m/s, s, [-]), replaced or added.

    Raises BadInput.
    """
    lines = text.rstrip("\n").splitlines()
    begin = next((i for i, line in enumerate(lines) if re.fullmatch(rf"  {SERVICE}:\s*(#.*)?", line)), None)
    if begin is None:
        if f"{SERVICE}:" in text:
            raise BadInput(f"{place}: write '{SERVICE}:' on a line of its own under 'params:', two blanks in, and a parameter a line below")
        begin = _new_block(lines, place)
    left = dict(figures)
    end = begin + 1
    while end < len(lines) and (not lines[end].strip() or lines[end].startswith("    ")):
        if (found := re.match(r"    (\w+):\s*[^#]*?(\s*#.*)?$", lines[end])) and found[1] in left:
            lines[end] = f"    {found[1]}: {left.pop(found[1]):.5g}{found[2] or ''}"
        end += 1
    lines[end:end] = [f"    {name}: {value:.5g}" for name, value in left.items()]
    return "\n".join(lines) + "\n"


def _new_block(lines: list[str], place: FileLocation) -> int:
    """Adds the autopilot's block; its line. Raises BadInput."""
    params = next((i for i, line in enumerate(lines) if re.match(r"params:", line)), None)
    if params is None:
        lines += ["", "params:"]
        params = len(lines) - 1
    if not (found := re.fullmatch(r"params:\s*(?:\{\s*\})?\s*(#.*)?", lines[params])):
        raise BadInput(f"{place}: write 'params:' on a line of its own, and each service below, two blanks in")
    lines[params] = " ".join(filter(None, ("params:", found[1])))
    lines.insert(params + 1, f"  {SERVICE}:")
    return params + 1
