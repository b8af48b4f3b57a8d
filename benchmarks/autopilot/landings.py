"""Take-offs, circuits and landings by the autopilot in gusty wind, scored from the truth: on a nose wheel, on a tail wheel, on the belly.

Each of the flights has a seed of its own for sensors and turbulence. The wind is 8 m/s at 6 m height with Dryden turbulence of
W20 = 8 m/s, in half of the flights along the strip and in the others 45 degrees from the left or from the right.
``python -m benchmarks.autopilot.landings docs/images/landings.png`` draws where they touch.
"""

import shutil
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import yaml

from launch import catalogue
from launch.commands.bench import Figures
from schemas import topics
from schemas.messages import ArmRequest, Event
from services.autopilot.air.service import AutopilotAir
from services.sim_air.service import SimAir
from uvf.guidance.runways import Runway
from uvf.guidance.vector_field import from_line
from uvf.maths import rotations
from uvf.maths.atmosphere import STRIP_ROUGHNESS
from uvf.models.scenario import ROOT, Scenario, load_scenario
from uvf.runtime.time.lockstep import Lockstep

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FLIGHTS = 50
WIND = 8.0  # m/s
ASIDE = np.radians(45.0)
LONGEST = 600.0  # s
HOP = 0.15  # m
KEELS = {"nose_keel": (0.0, 0.0, -0.08), "left_keel": (0.3, -0.05, -0.08), "right_keel": (0.3, 0.05, -0.08), "tail_keel": (0.8, 0.0, -0.04)}
"""m, in the frame of stick25.xml."""
ROUND = 3.0  # m: a touch before it was this high again belongs to an approach that was given up
PLANE = "plane"
CIRCUIT = [
    {"kind": "takeoff", "z": 35.0},
    {"kind": "land"},
]


@dataclass(frozen=True)
class Craft:
    """An aircraft that takes off and lands; ``belly``: made from it, without wheels, and thrown at that speed [m/s]."""

    model: str
    belly: float | None = None

    def start(self) -> dict[str, Any]:
        """What its start in a mission has besides the place."""
        return {} if self.belly is None else {"launch": {"speed": self.belly}}

    def root(self, folder: Path) -> Path:
        """Where its vehicles and worlds lie, made in ``folder`` if need be."""
        return ROOT if self.belly is None else without_wheels(self.model, folder)


CRAFTS = {
    "milvus, nose wheel": Craft("milvus"),
    "stick25, tail wheel": Craft("stick25"),
    "stick25 without wheels, thrown": Craft("stick25", 11.0),
}


@dataclass(frozen=True)
class Row:
    """One moment; m, s, rad, world frame, nose up and right wing down positive."""

    t: float
    position: tuple[float, float, float]
    height: float  # m, of the wheels over the ground
    sink: float
    airspeed: float
    roll: float
    pitch: float
    crab: float  # of the nose from the strip
    wheels: int
    mode: str


@dataclass(frozen=True)
class Landed:
    """How a flight ended. along, aside: m from the point to touch at, in the direction of landing and to the right."""

    seed: int
    complete: bool
    why: str
    wind: tuple[float, float]  # m/s, head and cross
    along: float = np.nan
    aside: float = np.nan
    sink: float = np.nan
    airspeed: float = np.nan
    roll: float = np.nan
    pitch: float = np.nan
    crab: float = np.nan
    rolled: float = np.nan  # m
    off_middle: float = np.nan  # m, most while it rolls out
    take_off: float = np.nan  # m
    take_off_aside: float = np.nan  # m
    arounds: int = 0
    bounces: int = 0


def wind_of(seed: int) -> tuple[float, float]:
    """(east, north) m/s, the way it blows to; the strip runs east."""
    angle = (0.0, ASIDE, 0.0, -ASIDE)[seed % 4] + (np.pi if seed // 4 % 2 else 0.0)
    return float(WIND * np.cos(angle)), float(WIND * np.sin(angle))


def without_wheels(model: str, folder: Path) -> Path:
    """A root folder with this vehicle, standing on its belly: on keels instead of wheels, and without the propeller's tip."""
    vehicles = folder / "vehicles"
    shutil.copytree(ROOT / "vehicles" / model, vehicles / model)
    (folder / "worlds").symlink_to(ROOT / "worlds")
    path = vehicles / model / model / f"{model}.xml"
    tree = ElementTree.parse(path)
    ground = tree.find("ground_reactions")
    assert ground is not None
    for contact in list(ground):
        if contact.get("type") == "BOGEY" or contact.get("name") == "propeller":
            ground.remove(contact)
    for name, place in KEELS.items():
        ground.append(_keel(name, place))
    tree.write(path)
    file = vehicles / model / "vehicle.yaml"
    data = yaml.safe_load(file.read_text())
    data["air"]["skids"] = list(KEELS)
    data["params"]["autopilot_air"] |= {"gear": "belly", "rest_pitch": 0.0, "gear_height": 0.07, "launch_push": 6.0}
    file.write_text(yaml.safe_dump(data))
    return folder


def _keel(name: str, place: tuple[float, float, float]) -> ElementTree.Element:
    keel = ElementTree.Element("contact", type="STRUCTURE", name=name)
    where = ElementTree.SubElement(keel, "location", unit="M")
    for axis, value in zip("xyz", place, strict=True):
        ElementTree.SubElement(where, axis).text = str(value)
    figures = {"static_friction": 0.5, "dynamic_friction": 0.4, "spring_coeff": 1300, "damping_coeff": 40}
    units = {"spring_coeff": "N/M", "damping_coeff": "N/M/SEC"}
    for figure, value in figures.items():
        ElementTree.SubElement(keel, figure, {"unit": units[figure]} if figure in units else {}).text = str(value)
    return keel


def flight_site(seed: int, wind: tuple[float, float], craft: Craft, folder: Path) -> Scenario:
    """It stands on the strip, with its nose into the wind."""
    side = -1.0 if wind[0] > 0 else 1.0
    start = {"x": -140.0 * side, "y": 0.0, "z": 0.0, "yaw": 0.0 if side > 0 else np.pi} | craft.start()
    job = {"mission": [{**i, "x": side * float(i.get("x", 0.0))} if "x" in i else i for i in CIRCUIT]}
    air: dict[str, Any] = {"steady": [*wind, 0.0], "shear": {"law": "logarithmic", "roughness": STRIP_ROUGHNESS}}
    if any(wind):
        air["turbulence"] = {"severity": "light", "w20": WIND}
    vehicles = {PLANE: {"model": craft.model, "system_id": 1, "start": start, "job": job}}
    path = folder / "landing.yaml"
    path.write_text(yaml.safe_dump({"about": "landing", "world": "airfield", "seed": seed, "wind": air, "vehicles": vehicles}))
    return load_scenario(path, craft.root(folder))


class Watch:
    """Arms the aircraft, and writes down the truth until it stands and is disarmed again."""

    def __init__(self, lockstep: Lockstep) -> None:
        services = [shell.service for shell in lockstep.shells]
        (sim,) = (s for s in services if isinstance(s, SimAir))
        (self.autopilot,) = (s for s in services if isinstance(s, AutopilotAir))
        self.craft = sim._stage.aircraft[PLANE]
        self.rows: list[Row] = []
        self.lane: Runway | None = None
        self.events: list[Event] = []
        self._bus = lockstep.bus
        self._stands = float(self.craft.motion.position[2])
        self._was_armed = False
        for writer in ("autopilot", "sim_air"):
            topic = topics.EVENTS.by(writer)
            self._bus.subscribe(topic.at(PLANE), topic.qos, lambda s: self.events.append(Event.FromString(s.payload)))

    def __call__(self, t: float) -> bool:
        """Whether to go on."""
        if t >= 5.0 and not self._was_armed and abs(t - round(t)) < 1e-6:  # a gust may refuse it
            self._bus.call(topics.ARM.at(PLANE), ArmRequest(arm=True, source="bench").SerializeToString(), round(t * 1e9), self._heard)
        pilot = self.autopilot._mode_manager
        self._was_armed = self._was_armed or self.autopilot._armed
        if pilot.landing is not None:
            self.lane = pilot.landing.lane
        self.rows.append(self._row(t))
        return self.craft.wreck is None and not (self._was_armed and not self.autopilot._armed)

    @staticmethod
    def _heard(reply: bytes | None, reason: str, _: object) -> None:
        assert reply is not None, reason

    def _row(self, t: float) -> Row:
        motion = self.craft.motion
        roll, pitch, yaw = rotations.to_euler(motion.world_from_body)
        x, y, z = motion.position.tolist()
        course = self.lane.course if self.lane is not None else np.pi / 2
        crab = float(np.remainder(np.pi / 2 - yaw - course + np.pi, 2 * np.pi) - np.pi)
        wheels = 0 if self.craft.wreck or self.craft.launcher else sum(touch.carries for touch in self.craft.body.touches())
        mode = self.autopilot._mode_manager.mode.value
        vertical = -float(motion.velocity[2])
        return Row(t, (x, y, z), z - self._stands, vertical, motion.airspeed, float(roll), -float(pitch), crab, wheels, mode)


def fly(craft: Craft, seed: int, wind: tuple[float, float] | None = None) -> tuple[Landed, Watch]:
    """One flight from the strip back onto it."""
    wind = wind_of(seed) if wind is None else wind
    with tempfile.TemporaryDirectory() as folder:
        site = flight_site(seed, wind, craft, Path(folder))
        with closing(Lockstep(catalogue.hosts(site, [catalogue.kind("sim_air"), catalogue.kind("autopilot")]))) as lockstep:
            watch = Watch(lockstep)
            lockstep.run(LONGEST, watch)
    return score(seed, wind, watch), watch


def score(seed: int, wind: tuple[float, float], watch: Watch) -> Landed:
    """Touchdown and ground roll of one flight from the truth, or why it is not complete; wind: (east, north) m/s."""
    rows, lane = watch.rows, watch.lane
    arounds = sum("go-around" in e.cause for e in watch.events)
    if watch.craft.wreck or lane is None:
        return Landed(seed, False, watch.events[-1].cause if watch.events else rows[-1].mode, (0.0, 0.0), arounds=arounds)
    cn, ce = lane.along
    breeze = (-(wind[0] * ce + wind[1] * cn), wind[0] * cn - wind[1] * ce)
    off = next((i for i, r in enumerate(rows) if r.height > 0.3), 0)
    high = max((i for i, r in enumerate(rows) if r.height > ROUND), default=off)
    touch = next((i for i, r in enumerate(rows) if i > high and r.wheels), None)
    if touch is None:
        return Landed(seed, False, "never touched", breeze, arounds=arounds)
    places = [_on(lane, r) for r in rows]
    stopped = np.hypot(*(np.subtract(rows[-1].position, rows[-100].position)[:2])) < 0.2
    whole = bool(stopped) and all(abs(aside) < lane.width / 2 for _, aside in places[touch:])
    at = rows[touch]
    before = rows[touch - 1]
    return Landed(
        seed,
        whole,
        "" if whole else "off the strip" if stopped else "did not stop",
        breeze,
        *places[touch],
        before.sink,
        before.airspeed,
        at.roll,
        at.pitch,
        at.crab,
        places[-1][0] - places[touch][0],
        max(abs(aside) for _, aside in places[touch:]),
        float(np.hypot(*np.subtract(rows[off].position, rows[0].position)[:2])),
        max(abs(r.position[1]) for r in rows[: off + 1]),
        arounds,
        _bounces(rows[touch:]),
    )


def _bounces(rows: Sequence[Row]) -> int:
    """How often it left the ground again by more than HOP, after it had touched."""
    high = [r.height > HOP for r in rows]
    return sum(now and not before for before, now in pairwise(high))


def _on(lane: Runway, row: Row) -> tuple[float, float]:
    """m beyond the point to touch at, and to the right of the middle."""
    return from_line(lane.along, (lane.aim.north, lane.aim.east), (row.position[1], row.position[0]))


def _flown(craft: Craft, seed: int) -> Landed:
    return fly(craft, seed)[0]


def flown(craft: Craft, seeds: Sequence[int]) -> list[Landed]:
    """One flight a seed, on all processors."""
    with ProcessPoolExecutor() as pool:
        return list(pool.map(partial(_flown, craft), seeds))


def summary(rows: Sequence[Landed]) -> dict[str, float]:
    """Over all complete flights: where [m] and how fast [m/s] the wheels touched, angles [deg], runs [m]; and how many were complete."""
    whole = [r for r in rows if r.complete]
    column = {
        name: np.array([getattr(r, name) for r in whole]) for name in ("along", "aside", "sink", "airspeed", "roll", "crab", "rolled")
    }
    return {
        "flights": len(rows),
        "complete": len(whole),
        "along sd m": float(column["along"].std()),
        "along max m": float(np.abs(column["along"]).max()),
        "within 10 m %": float(100 * np.mean(np.abs(column["along"]) <= 10.0)),
        "aside max m": float(np.abs(column["aside"]).max()),
        "sink mean": float(column["sink"].mean()),
        "sink max": float(column["sink"].max()),
        "m/s": float(column["airspeed"].mean()),
        "bank max deg": float(np.degrees(np.abs(column["roll"])).max()),
        "crab max deg": float(np.degrees(np.abs(column["crab"])).max()),
        "off middle max m": max(r.off_middle for r in whole),
        "take-off m": float(np.mean([r.take_off for r in whole])),
        "go-arounds": sum(r.arounds for r in rows),
        "bounces": sum(r.bounces for r in rows),
    }


def landings(data: Path | None) -> Figures:
    """FLIGHTS flights of each aircraft in gusty wind, a row each."""
    return {name: summary(flown(craft, range(1, FLIGHTS + 1))) for name, craft in CRAFTS.items()}


def draw(path: Path) -> None:
    """Draws where they touched, coloured by sink."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11, 10), layout="constrained")
    for axes, (name, craft) in zip(figure.subplots(len(CRAFTS), 1, sharex=True), CRAFTS.items(), strict=True):
        _dots(figure, axes, name, flown(craft, range(1, FLIGHTS + 1)))
    figure.savefig(path, dpi=90)


def _dots(figure: "Figure", axes: "Axes", name: str, rows: Sequence[Landed]) -> None:
    whole = [r for r in rows if r.complete]
    axes.axhspan(-6, 6, color="0.92")
    axes.axvspan(-10, 10, color="C2", alpha=0.15, label="10 m along")
    dots = axes.scatter([r.along for r in whole], [-r.aside for r in whole], c=[r.sink for r in whole], cmap="viridis", vmin=0, vmax=1.2)
    axes.plot(0, 0, "k+", markersize=14, label="aimed at")
    figure.colorbar(dots, label="sink [m/s]")
    axes.set(
        xlabel="along the strip, in the direction of landing [m]", ylabel="to the left of its middle [m]", xlim=(-30, 30), ylim=(-6, 6)
    )
    axes.set_title(
        f"{name}: {len(whole)} of {len(rows)} flights complete; wind {WIND:g} m/s with gusts, along the strip or 45 degrees aside"
    )
    axes.grid(alpha=0.3)
    axes.legend(loc="upper right", fontsize=8)


CASES = {"landings": landings}

if __name__ == "__main__":
    draw(Path(sys.argv[1]))
