"""Missions with something broken: what is still achieved, and how it ends.

A row is a mission with one fault, which begins after ``AT`` s and stays; a case is ``MISSION:FAULT``. ``achieved``: every criterion of the
mission holds. ``safe``: nothing has crashed or touched anything; at the end rovers stand, and aircraft have landed or are flown by their
autopilots. ``ends`` is when the run ended [s], ``off`` the largest error of the pose [m]. What is neither achieved nor safe keeps its log.
"""

import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from launch.changed_mission import changed_mission
from launch.commands.bench import Figures
from launch.reports.drive_figures import pose_errors, touches
from launch.reports.history import History
from launch.reports.recorded_run import RecordedRun, recorded_run
from launch.run import run_lockstep
from launch.runs import new_run
from schemas.messages import Event, Mode
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.messages.enum_names import enum_name

WHO = "WHO"
AT = 30.0  # s
AFTERWARDS = 60.0  # s that are watched after the tasks have ended
STANDING = 0.02  # m/s
LOOKED_AT = 2.0  # s at the end
GROUND = {"ugv1_waypoints": "rover", "ugv2_slam": "rover", "convoy": "first"}
AIR = {"uav1_surfaces": "uav", "uav2_dubins": "uav", "leader_follower": "leader"}
"""The mission, and which of its vehicles has the fault."""


def fault(part: str, kind: str = "lost", size: float = 0.0) -> str:
    """The setting of a fault of a vehicle that is not yet named."""
    return f"faults=[{{vehicle: {WHO}, part: {part}, kind: {kind}, at: {AT}, size: {size}}}]"


ON_GROUND = {
    "lidar dead": fault("scan"),
    "lidar frozen": fault("scan", "frozen"),
    "encoders dead": fault("wheels"),
    "a wheel on ice": fault("left_grip"),
    "a wheel slipping": fault("left_grip", "bias", -0.9),
    "link cut": fault("link"),
    "battery low": fault("battery", "bias", -0.88),
    "battery empty": fault("battery", "bias", -0.99),
}
IN_THE_AIR = {
    "GNSS lost": fault("gnss"),
    "pressures lost": fault("air_data"),
    "battery low": fault("battery", "bias", -0.75),
    "link cut": fault("link"),
    "wind that rises": f"wind={{steady: [-3.0, 1.5, 0.0], changes: [{{at: {AT}, over: 20, steady: [-19.0, 6.0, 0.0]}}]}}",
    "wind beyond limits": "wind={steady: [-19.0, 6.0, 0.0]}",
}
FLOWN_BY_AUTOPILOT = (Mode.MODE_HOLD, Mode.MODE_RETURN, Mode.MODE_LAND, Mode.MODE_MISSION, Mode.MODE_FOLLOW)


def measured(mission: str, vehicle: str, setting: str) -> tuple[dict[str, float], list[str]]:
    """The row of a mission with a fault, and what happened, in words."""
    with tempfile.TemporaryDirectory() as folder:
        path = changed_mission(ROOT / "missions" / f"{mission}.yaml", [setting.replace(WHO, vehicle)], Path(folder))
        site, log = load_scenario(path), Path(folder) / "log-000.mcap"
        result = run_lockstep(site, site.mission.duration, log, afterwards=AFTERWARDS)
        with recorded_run(log) as run:
            wrong = [line for name, history in run.vehicles.items() for line in _wrong(name, history)]
            row = {"achieved": float(result.passed), "safe": float(not wrong), "ends": result.simulated, "off": _largest_error(run)}
            words = [*wrong, *_said(run, vehicle)]
        if wrong and not result.passed:
            words.append(f"log {shutil.copy(log, new_run() / log.name)}")
        return row, words


def _wrong(name: str, history: History) -> list[str]:
    """What is not safe about how a vehicle ended."""
    crash = next((f"{name} crashed at {t:.0f} s: {event.cause}" for t, event in history.events if event.text == "crashed"), None)
    if crash is not None:
        return [crash]
    truth, status = history.truth, history.rows("state/vehicle")
    if truth is None or not len(status):
        return [f"{name} tells nothing"]
    if history.is_aircraft:
        mode, landed = int(status[-1, 1]), bool(status[-1, 2])
        return [] if landed or mode in FLOWN_BY_AUTOPILOT else [f"{name} is still in mode {enum_name(Mode, mode)}"]
    last = truth.t >= truth.t[-1] - LOOKED_AT
    speed = float(np.hypot(*truth.velocity[last, :2].T).mean())
    wrong = [f"{name} touched something at {touched:.0f} s" for touched in touches(history)[:1]]
    return wrong + ([f"{name} still drives with {speed:.2f} m/s"] if speed > STANDING else [])


def _largest_error(run: RecordedRun) -> float:
    errors = [off.max() for history in run.vehicles.values() if not history.is_aircraft and len(off := pose_errors(history)[1])]
    flown = [(e, t) for h in run.vehicles.values() if h.is_aircraft and (e := h.estimate) is not None and (t := h.truth) is not None]
    errors += [np.hypot(*(e.position - t.at(e.t).position)[:, :2].T).max() for e, t in flown]
    return float(max(errors, default=0.0))


def _said(run: RecordedRun, vehicle: str) -> list[str]:
    """The first warnings after the fault."""
    told = [e for e in run.events if e.owner == vehicle and e.event.severity >= Event.WARNING and e.t >= AT]
    return [f"{e.t:.0f} s {e.event.text}" for e in told[:3]]


def case(mission: str, name: str, setting: str) -> Callable[[Path | None], Figures]:
    """What runs a mission with a fault."""

    def run(data: Path | None) -> Figures:
        row, words = measured(mission, {**GROUND, **AIR}[mission], setting)
        sys.stderr.write(f"{mission}, {name}: {'; '.join(words) or 'nothing was said'}\n")
        return {f"{mission}, {name}": row}

    return run


CASES = {
    f"{mission}:{name.replace(' ', '_')}": case(mission, name, setting)
    for missions, faults in ((GROUND, ON_GROUND), (AIR, IN_THE_AIR))
    for mission in missions
    for name, setting in faults.items()
}
