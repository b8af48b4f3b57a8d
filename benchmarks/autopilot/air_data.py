"""The check of the pitot pressure: false alarms in hours of moderate turbulence, and how soon a true fault is told."""

import tempfile
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from launch import catalogue
from launch.commands.bench import Figures
from schemas import topics
from schemas.messages import Event
from uvf.models.scenario import load_scenario
from uvf.runtime.messages.convert import seconds
from uvf.runtime.time.lockstep import Lockstep

PLANE = "plane"
CRAFTS = {"milvus": 25.0, "stick25": 17.0}  # m/s
FLIGHT, HOURS = 600.0, 10.0  # s, of one flight; of all
CIRCUIT = ((0.0, 600.0), (500.0, 600.0), (500.0, -200.0), (0.0, -200.0))  # m north and east
HEIGHT = 100.0  # m
FAULT_AT, TOLD_WITHIN = 90.0, 30.0  # s
FAULTS: dict[str, dict[str, Any]] = {
    "no pressure": {"kind": "lost"},
    "frozen": {"kind": "frozen"},
    "half the pressure": {"kind": "bias", "size": -0.5},  # of the dynamic pressure in cruise
    "twice the pressure": {"kind": "bias", "size": 1.0},
}
SEEDS = (1, 2, 3)
SAID = "airspeed sensor"


def alarms(model: str, seed: int, severity: str, wind: float, fault: str = "") -> list[float]:
    """Times [s] of the warnings of one flight over a circuit, in turbulence and a wind [m/s] from the east."""
    start = {"x": 0.0, "y": 0.0, "z": HEIGHT, "yaw": 0.0, "speed": CRAFTS[model]}
    items: list[dict[str, Any]] = [{"x": east, "y": north, "z": HEIGHT} for north, east in CIRCUIT]
    vehicle = {"model": model, "system_id": 1, "start": start, "job": {"mission": [*items, {"kind": "jump", "jump_to": 0, "repeat": -1}]}}
    air: dict[str, Any] = {"steady": [-wind, 0.0, 0.0]} | ({"turbulence": {"severity": severity}} if severity else {})
    data: dict[str, Any] = {"about": "air data", "world": "empty", "seed": seed, "wind": air, "vehicles": {PLANE: vehicle}}
    if fault:
        size = FAULTS[fault].get("size", 0.0) * 0.5 * 1.2 * CRAFTS[model] ** 2
        data["faults"] = [{"vehicle": PLANE, "part": "pitot", "at": FAULT_AT, **FAULTS[fault], "size": size}]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "air_data.yaml"
        path.write_text(yaml.safe_dump(data))
        site = load_scenario(path)
    events: list[Event] = []
    lockstep = Lockstep(catalogue.hosts(site, [catalogue.kind("sim_air"), catalogue.kind("autopilot")]))
    topic = topics.EVENTS.by("autopilot")
    with closing(lockstep):
        lockstep.bus.subscribe(topic.at(PLANE), topic.qos, lambda s: events.append(Event.FromString(s.payload)))
        lockstep.run(FAULT_AT + TOLD_WITHIN if fault else FLIGHT)
    return [seconds(e.timestamp) for e in events if SAID in e.text and e.severity >= Event.WARNING]


def hours(data: Path | None = None) -> Figures:
    """False alarms."""
    each = round(HOURS * 3600.0 / FLIGHT / len(CRAFTS))
    figures = {}
    for model in CRAFTS:
        found = _all([(model, seed, "moderate", 5.0 * (seed % 3)) for seed in range(1, each + 1)])
        figures[f"{model}, moderate"] = {"hours": each * FLIGHT / 3600.0, "false alarms": float(sum(map(len, found)))}
    return figures


def faults(data: Path | None = None) -> Figures:
    """Seconds until a fault is told, of three flights each; ``missed`` within half a minute, ``false`` before it."""
    cases = list(product(CRAFTS, ("", "moderate"), FAULTS))
    found = _all([(model, seed, severity, 5.0, fault) for model, severity, fault in cases for seed in SEEDS])
    flights = [found[k : k + len(SEEDS)] for k in range(0, len(found), len(SEEDS))]
    return {f"{model}, {severity or 'calm'}, {fault}": _told(of) for (model, severity, fault), of in zip(cases, flights, strict=True)}


def _told(flights: Sequence[list[float]]) -> dict[str, float]:
    after = np.array([next((t - FAULT_AT for t in times if t >= FAULT_AT), np.nan) for times in flights])
    told = after[np.isfinite(after)]
    false = sum(t < FAULT_AT for times in flights for t in times)
    some = {"s, mean": float(told.mean()), "s, most": float(told.max())} if len(told) else {}
    return {**some, "missed": float(len(after) - len(told)), "false": float(false)}


def _all(jobs: Sequence[tuple[Any, ...]]) -> list[list[float]]:
    with ProcessPoolExecutor() as pool:
        return list(pool.map(alarms, *zip(*jobs, strict=True)))


CASES = {"hours": hours, "faults": faults}
