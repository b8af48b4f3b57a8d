"""``uvf vehicle tune``: the autopilot's figures of an aircraft from its own model, with the margins of the loops that they make."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from rich.table import Table
from scipy.special import sici

from services.autopilot.air.params import AirParams
from services.sim_air.linear import LinearModels, linearize
from uvf.launch.vehicles.aircraft_rules import HEIGHT
from uvf.launch.vehicles.autopilot_guess import autopilot_figures
from uvf.launch.vehicles.linearize import airframe_of
from uvf.maths.margins import Margins, margins
from uvf.runtime.air_file import AirBody
from uvf.runtime.params import BadInput, Place, convert
from uvf.runtime.vehicle_file import load_vehicle

SERVICE = "autopilot_air"
OMEGA: NDArray[np.float64] = np.geomspace(0.05, 150.0, 6000)  # rad/s
DEAD_TIME = 0.035  # s: a sample of the IMU, its filter in part, a cycle of the autopilot and half of one that the servos hold
SECONDS = 6.0  # s, of the step responses
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Loop:
    """One axis, opened at its servo."""

    axis: str
    response: Complex  # (k,) at OMEGA: the loop
    asked: Complex  # (k,) at OMEGA: servo command per commanded angle
    plant: Complex  # (k,) at OMEGA: angle per servo command

    @property
    def margins(self) -> Margins:
        return margins(OMEGA, self.response)

    def step(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k,) the angle after its command has gone from 0 to 1, from the closed loop's frequency response."""
        closed = self.asked * self.plant / (1 + self.response)
        kernel = closed.real * np.sin(np.outer(t, OMEGA)) / OMEGA
        slower = closed.real[0] * sici(OMEGA[0] * t)[0]  # what lies below the lowest frequency
        return np.asarray(2 / np.pi * (np.trapezoid(kernel, OMEGA, axis=1) + slower))


@dataclass(frozen=True)
class Tuning:
    """Figures and what they make of the aircraft."""

    folder: Path
    before: dict[str, float]
    figures: dict[str, float]
    loops: list[Loop]


def tune(folder: Path) -> Tuning:
    """Of the aircraft in ``folder``. Raises BadInput."""
    airframe, file = airframe_of(folder), load_vehicle(folder.parent, folder.name)
    assert file.air is not None
    before = convert(file.params.get(SERVICE, {}), AirParams, str(folder / "vehicle.yaml"), ("params", SERVICE))
    figures = autopilot_figures(airframe, file.air)
    models = linearize(airframe, file.air.trim_speed, HEIGHT, folder)
    return Tuning(folder, {name: getattr(before, name) for name in figures}, figures, list(_loops(models, figures, file.air)))


def _loops(models: LinearModels, figures: Mapping[str, float], body: AirBody) -> Iterator[Loop]:
    """The attitude loops of services/autopilot/air/attitude_loops.py at the trim speed."""
    s = 1j * OMEGA
    servo: Complex = np.exp(-DEAD_TIME * s) / (1 + body.servo_lag * s)
    sides = {"roll": (models.lateral, "phi", "delta_a", 1.0), "pitch": (models.longitudinal, "theta", "delta_e", -1.0)}
    for axis, (side, angle, surface, sign) in sides.items():
        ahead, p, i, time = (figures[f"{axis}_{name}"] for name in ("ff", "p", "i", "time"))
        plant = sign * servo * side.transfer(angle, surface, OMEGA)
        asked: Complex = np.asarray((ahead + p + i / s) / time, dtype=np.complex128)
        yield Loop(axis, np.asarray((asked + p * s + i) * plant, dtype=np.complex128), asked, np.asarray(plant, dtype=np.complex128))


def tables(tuning: Tuning) -> Iterator[Table]:
    figures = Table("parameter", "before", "now", title=f"{SERVICE} of {tuning.folder.name}")
    for name, value in tuning.figures.items():
        figures.add_row(name, f"{tuning.before[name]:.3g}", f"{value:.3g}")
    yield figures
    loops = Table(
        "loop", "phase margin deg", "at rad/s", "gain margin dB", "dead time besides s", title="margins, loops opened at the servo"
    )
    for loop in tuning.loops:
        m = loop.margins
        loops.add_row(loop.axis, f"{np.degrees(m.phase):.0f}", f"{m.crossover:.1f}", f"{20 * np.log10(m.gain):.1f}", f"{m.delay:.3f}")
    yield loops


def draw(tuning: Tuning, path: Path) -> None:
    """The gain of the open loops and the step responses of the closed ones."""
    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    bode, step = figure.subplots(1, 2)
    t = np.linspace(0.0, SECONDS, 301)
    for loop in tuning.loops:
        m = loop.margins
        label = f"{loop.axis}: {np.degrees(m.phase):.0f} deg at {m.crossover:.1f} rad/s"
        bode.semilogx(OMEGA, 20 * np.log10(np.abs(loop.response)), label=label)
        step.plot(t, loop.step(t), label=loop.axis)
    bode.set(title="open loop, dB", xlabel="rad/s", ylim=(-40, 60))
    step.set(title="angle after a commanded step", xlabel="s")
    for axes in (bode, step):
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    figure.savefig(path, dpi=90)


def write(tuning: Tuning) -> Path:
    """Puts the figures into the vehicle.yaml, which keeps its other lines. Raises BadInput."""
    path = tuning.folder / "vehicle.yaml"
    text = with_params(path.read_text(encoding="utf-8"), tuning.figures, Place(str(path)))
    path.write_text(text, encoding="utf-8")
    load_vehicle(tuning.folder.parent, tuning.folder.name)
    return path


def with_params(text: str, figures: Mapping[str, float], place: Place) -> str:
    """The text of a vehicle.yaml with these parameters of the autopilot in place of those of the same name. Raises BadInput."""
    lines = text.rstrip("\n").splitlines()
    begin = next((i for i, line in enumerate(lines) if re.fullmatch(rf"  {SERVICE}:\s*(#.*)?", line)), None)
    if begin is None:
        if f"{SERVICE}:" in text:
            raise BadInput(f"{place}: write '{SERVICE}:' on a line of its own under 'params:', two blanks in, and a parameter a line below")
        begin = _new_block(lines)
    left = dict(figures)
    end = begin + 1
    while end < len(lines) and (not lines[end].strip() or lines[end].startswith("    ")):
        if (found := re.match(r"    (\w+):\s*[^#]*?(\s*#.*)?$", lines[end])) and found[1] in left:
            lines[end] = f"    {found[1]}: {left.pop(found[1]):.5g}{found[2] or ''}"
        end += 1
    lines[end:end] = [f"    {name}: {value:.5g}" for name, value in left.items()]
    return "\n".join(lines) + "\n"


def _new_block(lines: list[str]) -> int:
    """Adds the autopilot's block; its line."""
    params = next((i for i, line in enumerate(lines) if re.fullmatch(r"params:\s*(#.*)?", line)), None)
    if params is None:
        lines += ["", "params:"]
        params = len(lines) - 1
    lines.insert(params + 1, f"  {SERVICE}:")
    return params + 1
