"""Faults of the vehicles that a mission takes: each model is inspected once, without pictures."""

from pathlib import Path

from launch.refusal import counted
from launch.vehicles.inspection import inspect
from uvf.models.scenario import Scenario
from uvf.runtime.process.subprocess_jobs import Died, run_in_subprocess


def mission_faults(site: Scenario) -> list[str]:
    """All faults of the models of a mission, a line each with file and line."""
    return [line for folder in _folders(site) for line in inspect(Path(folder)).faults]


def warnings(site: Scenario) -> list[str]:
    """One line for each model that has faults: it is simulated nevertheless, but not as its files mean it."""
    return model_warnings(_folders(site))


def warnings_from_outside(site: Scenario) -> list[str]:
    """The same for a process that stays small: another one does the work."""
    try:
        return run_in_subprocess(model_warnings, _folders(site))
    except Died as error:
        return [f"warning: the vehicles cannot be inspected ({error}); see 'uvf vehicle check'"]


def model_warnings(folders: list[str]) -> list[str]:
    """One line for each of these folders of vehicles that has faults."""
    counts = {Path(folder).name: len(inspect(Path(folder)).faults) for folder in folders}
    return [f"warning: {name}: {counted(n, 'fault')}; see 'uvf vehicle check {name}'" for name, n in counts.items() if n]


def _folders(site: Scenario) -> list[str]:
    """The folder of each model of a mission, once."""
    return sorted({str(member.folder.resolve()) for member in site.members.values()})
