"""``uvf vehicle tune``: the autopilot's figures of an aircraft from its own model, and the margins of the loops that they make."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import msgspec
import numpy as np
from matplotlib.figure import Figure
from rich.table import Table

from launch.vehicles.air_design import ModelledAircraft, modelled, timing
from launch.vehicles.autopilot_guess import autopilot_figures, three_digits
from launch.vehicles.linearize import airframe_of
from launch.vehicles.parameter_lines import SERVICE, with_params
from uvf.control.design import lateral_loops, longitudinal_loops
from uvf.control.design.aircraft_loops import OMEGA, Loop
from uvf.control.design.design_axes import GAINS
from uvf.control.design.gain_search import GAIN, PEAK, PHASE, designed
from uvf.control.design.gain_start import begun
from uvf.control.design.margins import step_response
from uvf.control.design.signal_flow import Floats, SignalFlow
from uvf.control.flight_control import on_final
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.yaml_data import BadInput, FileLocation, convert

SECONDS = 6.0  # of the step responses


@dataclass(frozen=True)
class Tuning:
    """The autopilot parameters of an aircraft and the control loops that they make.

    loops: at every airspeed; spread: of aircraft whose derivatives and lags are off by as much as a model may be.
    """

    folder: Path
    before: dict[str, float]
    figures: dict[str, float]
    aircraft: ModelledAircraft
    params: AirParams
    loops: list[Loop]
    spread: list[Loop]

    @cached_property
    def cruise(self) -> tuple[SignalFlow, SignalFlow]:
        """Lateral and longitudinal loops in cruise."""
        at = OMEGA, self.aircraft.cruise, self.aircraft.loops.delays, self.params
        return lateral_loops.lateral_flow(*at), longitudinal_loops.longitudinal_flow(*at)

    @cached_property
    def attitude(self) -> tuple[SignalFlow, SignalFlow]:
        """Lateral and longitudinal loops that hold an attitude alone, at the speed of cruise."""
        at = OMEGA, self.aircraft.cruise, self.aircraft.loops.delays, on_final(self.params)
        return lateral_loops.attitude_flow(*at), longitudinal_loops.attitude_flow(*at)

    @property
    def unmet(self) -> list[str]:
        """A line for each loop without the margins that it ought to have, and what would give it them."""
        quicker = self.aircraft.loops.with_lags(0.5).loops(self.params)
        lacking = [name for name in names(self.loops) if not _met(of(name, self.loops))]
        helped = {name: _met(of(name, quicker)) for name in lacking}
        says = {
            True: "servos and engine with half the lag would have it",
            False: "lower budgets, a higher airspeed or more damping would help",
        }
        return [f"{name}: not within {GAIN:g} dB, {PHASE:g} deg and a peak of {PEAK:g}; {says[helped[name]]}" for name in lacking]

    @property
    def unstable(self) -> list[Loop]:
        """Loops that are unstable as they are, or within the spread."""
        return [loop for loop in (*self.loops, *self.spread) if not loop.stable]


def of(name: str, loops: Sequence[Loop]) -> list[Loop]:
    """The loop of this name at all airspeeds."""
    return [loop for loop in loops if loop.name == name]


def names(loops: Sequence[Loop]) -> list[str]:
    """Of the loops, each once."""
    return list(dict.fromkeys(loop.name for loop in loops))


def _met(loops: Sequence[Loop]) -> bool:
    gain, phase, peak = least(loops)
    return all(loop.stable for loop in loops) and not gain < GAIN and not phase < PHASE and peak <= PEAK


def least(loops: Sequence[Loop]) -> tuple[float, float, float]:
    """Gain [dB] and phase margin [deg] nearest to none, nan where no loop has such a crossing, and the highest peak."""
    gains = [abs(loop.margins.gain_db) for loop in loops if not np.isnan(loop.margins.gain)]
    phases = [np.degrees(abs(loop.margins.phase)) for loop in loops if not np.isnan(loop.margins.phase)]
    return min(gains, default=np.nan), min(phases, default=np.nan), max(loop.margins.peak for loop in loops)


def tune(folder: Path, firmness: float = 1.0) -> Tuning:
    """Tunes the autopilot for the aircraft in ``folder`` from its own model; firmness as of ``designed``. Raises BadInput."""
    airframe, file = airframe_of(folder), load_vehicle(folder.parent, folder.name)
    assert file.air is not None
    before = convert(file.params.get(SERVICE, {}), AirParams, str(folder / "vehicle.yaml"), ("params", SERVICE))
    measured = autopilot_figures(airframe, file.air)
    measured["bank_limit"] = min(measured["bank_limit"], before.bank_limit)
    measured["turn_bank"] = min(measured["turn_bank"], measured["bank_limit"])
    params = msgspec.structs.replace(before, **measured)
    aircraft = modelled(airframe, file.air, params)
    params = rounded(designed(aircraft.loops, begun(aircraft.loops, aircraft.with_mix(params)), firmness))
    figures = measured | {name: getattr(params, name) for name in GAINS}
    figures |= {name: three_digits(value) for name, value in timing(aircraft, params, file.air.controls.aileron.limit).items()}
    params = msgspec.structs.replace(params, **figures)
    was = {name: getattr(before, name) for name in figures}
    return Tuning(folder, was, figures, aircraft, params, aircraft.loops.loops(params), aircraft.loops.worst(params))


def rounded(params: AirParams) -> AirParams:
    """With the gains as they are written."""
    return msgspec.structs.replace(params, **{name: three_digits(getattr(params, name)) for name in GAINS})


def tables(tuning: Tuning) -> Iterator[Table]:
    """Yields the table of parameters and those of the loops' margins."""
    figures = Table("parameter", "before", "now", title=f"{SERVICE} of {tuning.folder.name}")
    for name, value in tuning.figures.items():
        figures.add_row(name, f"{tuning.before[name]:.3g}", f"{value:.3g}")
    yield figures
    found = Table("loop", "m/s", "phase margin deg", "at rad/s", "gain margin dB", "peak", "delay besides s", title="margins")
    for loop in sorted(tuning.loops, key=lambda loop: (loop.name, loop.airspeed)):
        m = loop.margins
        row = f"{np.degrees(m.phase):.0f}", f"{m.crossover:.1f}", f"{m.gain_db:.1f}", f"{m.peak:.2f}", f"{m.delay:.2f}"
        found.add_row(loop.name, f"{loop.airspeed:.1f}", *(row if loop.stable else ("unstable", *row[1:])))
    yield found
    spread = Table("loop", "phase margin deg", "gain margin dB", "peak", "unstable", title="least, derivatives +-30 %, lags +-50 %")
    for name in names(tuning.spread):
        loops = of(name, tuning.spread)
        gain, phase, peak = least(loops)
        spread.add_row(name, f"{phase:.0f}", f"{gain:.1f}", f"{peak:.2f}", f"{sum(not loop.stable for loop in loops)} of {len(loops)}")
    yield spread


def draw(tuning: Tuning, path: Path) -> None:
    """Draws the gain of the open loops in cruise, and the response of bank and pitch to a commanded step."""
    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    bode, step = figure.subplots(1, 2)
    for flow, opened in zip(tuning.cruise, (lateral_loops.LOOPS, longitudinal_loops.LOOPS), strict=True):
        for name, at in opened.items():
            bode.semilogx(OMEGA, 20 * np.log10(np.abs(flow.loop(at))), label=name)
    t = np.linspace(0.0, SECONDS, 301)
    for name, response in steps(tuning, t).items():
        step.plot(t, response, label=name)
    bode.set(title="open loop, dB", xlabel="rad/s", ylim=(-40, 60), xlim=(0.05, 100.0))
    step.set(title="after a commanded step", xlabel="s")
    for axes in (bode, step):
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    figure.savefig(path, dpi=90)


def steps(tuning: Tuning, t: Floats) -> dict[str, Floats]:
    """Bank and pitch (k,) at times ``t`` (k,) [s] after their command has risen by one, as by a stick, at the speed of cruise."""
    lateral, longitudinal = tuning.attitude
    bank, pitch = lateral.closed("phi", "bank"), longitudinal.closed("theta", "pitch")
    return {"bank": step_response(OMEGA, bank, t), "pitch": step_response(OMEGA, pitch, t)}


def write(tuning: Tuning) -> Path:
    """Writes the parameters into the vehicle.yaml, which keeps its other lines; returns its path.

    Raises BadInput, also for what would be unstable.
    """
    path = tuning.folder / "vehicle.yaml"
    if tuning.unstable:
        loop = tuning.unstable[0]
        why = (
            f"with the best gains that were found {loop.name} is unstable at {loop.airspeed:.1f} m/s, or would be with derivatives 30 % off"
        )
        raise BadInput(f"{path}: not written: {why}; quicker servos, more damping or a higher min_airspeed would help")
    text = with_params(path.read_text(encoding="utf-8"), tuning.figures, FileLocation(str(path)))
    path.write_text(text, encoding="utf-8")
    load_vehicle(tuning.folder.parent, tuning.folder.name)
    return path
