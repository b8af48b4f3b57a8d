"""Aircraft that nobody has tuned by hand: imported and tuned by the commands alone, then flown over the accuracy course.

``python -m benchmarks.autopilot.accuracy.strangers NAME [CASE ...]`` flies one of them.
"""

import shutil
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import jsbsim
import numpy as np
import yaml

from benchmarks.autopilot.accuracy.cases import ONE, SHOWN, mean
from benchmarks.autopilot.accuracy.flight import Case, scored
from benchmarks.autopilot.accuracy.kept import FOLDER, digest, figures_of, several
from launch.commands.bench import Figures
from launch.vehicles.importing_air import import_aircraft
from launch.vehicles.tuning import least, names, of, tune, write
from uvf.models.scenario import ROOT

SHIPPED = Path(jsbsim.get_default_root_dir()) / "aircraft"
OWN = ROOT / "vehicles"
SEEDS = (1, 2, 3)
METRICS = tuple(metric for metric in SHOWN if metric not in ("V mean", "wind"))
CORNERS = (11, 12, 13, 14)
OFF, LAG_OFF = 0.3, 0.5  # of a term of the aerodynamics, of the servos' lag
SIDES = ("SIDE", "Y", "ROLL", "PITCH", "YAW")
"""Axes whose terms are off: lift and drag stay, for the speed and the throttle of cruise go with them."""


@dataclass(frozen=True)
class Stranger:
    """A JSBSim model, and what is changed of it before it is tuned.

    servo_lag: [s], written into its vehicle.yaml; power: of its surfaces; off: seed of a model that is not what it was tuned for.
    """

    model: Path
    servo_lag: float | None = None
    power: float = 1.0
    off: int | None = None

    @property
    def name(self) -> str:
        """Of its folder in vehicles/."""
        return self.model.stem.lower()


STRANGERS = {
    "J3Cub": Stranger(SHIPPED / "J3Cub" / "J3Cub.xml"),
    "c172p": Stranger(SHIPPED / "c172p" / "c172p.xml"),
    "L17": Stranger(SHIPPED / "L17" / "L17.xml"),
    "pc7": Stranger(SHIPPED / "pc7" / "pc7.xml"),
    "c310": Stranger(SHIPPED / "c310" / "c310.xml"),
    "SGS, a glider": Stranger(SHIPPED / "SGS" / "SGS.xml"),
    "stick25, servos of 0.15 s": Stranger(OWN / "stick25" / "stick25" / "stick25.xml", servo_lag=0.15),
    "stick25, 40 % of control": Stranger(OWN / "stick25" / "stick25" / "stick25.xml", power=0.4),
}


def root_of(stranger: Stranger) -> Path:
    """A folder with its vehicle, imported and tuned, and the worlds; made once and kept as long as nothing has changed."""
    root = FOLDER / f"stranger-{digest(__file__, repr(stranger))}"
    if not root.is_dir():
        part = root.with_suffix(".part")
        shutil.rmtree(part, ignore_errors=True)
        (part / "vehicles").mkdir(parents=True)
        (part / "worlds").symlink_to(ROOT / "worlds")
        folder = part / "vehicles" / stranger.name
        if stranger.off is None:
            _make(stranger, folder)
        else:
            shutil.copytree(root_of(replace(stranger, off=None)) / "vehicles" / stranger.name, folder)
            _spoil(folder, stranger.model.stem, stranger.off)
        part.rename(root)
    return root


def _make(stranger: Stranger, folder: Path) -> None:
    import_aircraft(stranger.model, folder)
    if stranger.power != 1.0:
        _weaken(folder / stranger.model.stem / stranger.model.name, stranger.power)
        _with_air(folder, partial(_shorten, share=stranger.power))
    if stranger.servo_lag is not None:
        _with_air(folder, lambda air: air.update(servo_lag=stranger.servo_lag))
    tuning = tune(folder)
    write(tuning)
    groups = {"": tuning.loops, "off ": tuning.spread}
    margins = {f"{part}{name}": least(of(name, loops)) for part, loops in groups.items() for name in names(loops)}
    unstable = sum(not loop.stable for loop in (*tuning.loops, *tuning.spread))
    told = {"unmet": len(tuning.unmet), "unstable": unstable, "margins": {k: [float(x) for x in v] for k, v in margins.items()}}
    (folder / "tuned.yaml").write_text(yaml.safe_dump(told, sort_keys=False))


def _with_air(folder: Path, change: Callable[[dict[str, Any]], object]) -> None:
    file = folder / "vehicle.yaml"
    data = yaml.safe_load(file.read_text())
    change(data["air"])
    file.write_text(yaml.safe_dump(data, sort_keys=False))


def _shorten(air: dict[str, Any], share: float) -> None:
    for name in ("aileron", "elevator", "rudder"):
        air["controls"][name]["limit"] *= share


def _weaken(path: Path, power: float) -> None:
    tree = ElementTree.parse(path)
    for end in tree.iterfind("flight_control//aerosurface_scale/range/*"):
        end.text = str(power * float(end.text or 0.0))
    tree.write(path)


def _spoil(folder: Path, model: str, seed: int) -> None:
    """Each term of side force and moments off by OFF, up or down, the lag of the servos by LAG_OFF."""
    path, rng = folder / model / f"{model}.xml", np.random.default_rng(seed)
    tree = ElementTree.parse(path)
    for axis in tree.iterfind("aerodynamics/axis"):
        for function in axis.iterfind("function") if axis.get("name") in SIDES else ():
            factor = ElementTree.Element("value")
            factor.text = str(1 + OFF * float(rng.choice((-1.0, 1.0))))
            product = ElementTree.Element("product")
            product.extend([part for part in function if part.tag != "description"])
            for part in [part for part in function if part.tag != "description"]:
                function.remove(part)
            product.append(factor)
            function.append(product)
    tree.write(path)
    _with_air(folder, lambda air: air.update(servo_lag=air["servo_lag"] * (1 + LAG_OFF * (-1) ** seed)))


def cases_of(wind: str) -> list[Case]:
    """The cases of a wind, by its name."""
    return [replace(ONE[wind][0], seed=seed) for seed in SEEDS]


def flown(stranger: Stranger, case: Case) -> dict[str, float]:
    """Figures of one flight."""
    return scored(stranger.name, case, "good", {}, "energy", root_of(stranger))


def table(name: str, data: Path | None = None) -> Figures:
    """All winds, three seeds each."""
    stranger = STRANGERS[name]
    figures_of(made, (stranger,))
    cases = {wind: cases_of(wind) for wind in ONE}
    found = several(flown, [(stranger, case) for rows in cases.values() for case in rows])
    return {f"{name}, {wind}": _row([next(found) for _ in rows]) for wind, rows in cases.items()}


def corners(name: str, data: Path | None = None) -> Figures:
    """Aircraft at the corners of the spread, in calm air and in moderate turbulence, with the gains of the one that they are off from."""
    spoiled = [replace(STRANGERS[name], off=seed) for seed in CORNERS]
    for one in spoiled:
        root_of(one)  # one after the other: all of them are made from the same
    winds = ("calm", "moderate")
    found = several(flown, [(one, cases_of(wind)[0]) for wind in winds for one in spoiled])
    return {f"{name}, {wind}, off": _row([next(found) for _ in spoiled]) for wind in winds}


def made(stranger: Stranger) -> dict[str, Any]:
    """What was told when it was tuned."""
    told = yaml.safe_load((root_of(stranger) / "vehicles" / stranger.name / "tuned.yaml").read_text())
    return dict(told)


def _row(rows: list[dict[str, float]]) -> dict[str, float]:
    whole = [row for row in rows if row]
    return {**mean(whole, METRICS), "flown": len(whole) / len(rows)}


CASES = {f"{name}{what}": partial(function, name) for name in STRANGERS for what, function in (("", table), (" off", corners))}


def _said(name: str, wanted: list[str]) -> Iterator[str]:
    stranger = STRANGERS[name]
    yield str(made(stranger))
    for wind in wanted or list(ONE):
        rows = list(several(flown, [(stranger, case) for case in cases_of(wind)]))
        yield f"{wind:22} {'  '.join(f'{metric} {value:.2f}' for metric, value in _row(rows).items())}"


if __name__ == "__main__":
    for LINE in _said(sys.argv[1], sys.argv[2:]):
        sys.stdout.write(f"{LINE}\n")
        sys.stdout.flush()
