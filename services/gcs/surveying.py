"""Missions made of drawn fields, in another process: that takes seconds, and the page goes on meanwhile."""

from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Protocol

import msgspec
import numpy as np

from uvf.models.mission.file import Waypoint
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.world.file import load_world
from uvf.models.yaml_data import BadInput, convert
from uvf.planning.coverage.aerial import AerialTask, highest_ground, own_camera, plan_aerial
from uvf.planning.coverage.field import make_field
from uvf.runtime.process.subprocess_jobs import Died, run_in_subprocess


class FieldSurvey(msgspec.Struct, frozen=True):
    """A field (corners [m, world]) and how it is to be flown: height [m] above its highest ground, overlaps [0..1], wind [m/s] E, N."""

    vehicle: str
    """Folder of the aircraft."""
    world: str
    """Folder of the world."""
    corners: list[tuple[float, float]]
    height: float
    sidelap: float
    frontlap: float
    wind: tuple[float, float]


class SurveyPlanner(Protocol):
    """Makes missions of fields."""

    def begin(self, name: str, survey: FieldSurvey) -> None:
        """Begins with the field of the vehicle ``name``; another one of it takes the place of the one before."""
        ...

    def made(self) -> Sequence[tuple[str, list[Waypoint], str]]:
        """What is done since the last call: vehicle, items, and why there are none."""
        ...

    def close(self) -> None:
        """Begins with no other one."""
        ...


class SurveyProcess:
    """A survey planner in a process of its own."""

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(1, "survey")
        self._jobs: dict[str, Future[list[Waypoint]]] = {}

    def begin(self, name: str, survey: FieldSurvey) -> None:
        """As ``SurveyPlanner`` says."""
        self._jobs[name] = self._pool.submit(run_in_subprocess, survey_items, survey)

    def made(self) -> Sequence[tuple[str, list[Waypoint], str]]:
        """As ``SurveyPlanner`` says."""
        done = [name for name, job in self._jobs.items() if job.done()]
        return [(name, *_result(self._jobs.pop(name))) for name in done]

    def close(self) -> None:
        """As ``SurveyPlanner`` says."""
        self._pool.shutdown(wait=False, cancel_futures=True)


def _result(job: Future[list[Waypoint]]) -> tuple[list[Waypoint], str]:
    try:
        return job.result(), ""
    except (BadInput, Died, OSError) as error:
        return [], str(error)
    except msgspec.ValidationError as error:
        return [], f"survey: its flight leaves what a mission can say: {error}; draw the field nearer to the world's origin"


def survey_items(survey: FieldSurvey) -> list[Waypoint]:
    """Mission items of a survey. Raises BadInput."""
    vehicle, world = Path(survey.vehicle), Path(survey.world)
    file = load_vehicle(vehicle.parent, vehicle.name)
    params = convert(file.params.get("autopilot_air", {}), AirParams, str(vehicle / "vehicle.yaml"), ("params", "autopilot_air"))
    camera = own_camera(file)
    if camera is None:
        raise BadInput(f"{vehicle.name} has no camera: give it one, or plan with 'uvf plan survey --spacing'")
    try:
        field = make_field(np.array(survey.corners).reshape(-1, 2))
        x0, y0, x1, y1 = field.shape.bounds
        ground = highest_ground(load_world(world.parent, world.name), (x0, y0), (x1, y1))
        width = camera.spacing(survey.height, survey.sidelap)
        trigger = camera.trigger_distance(survey.height, survey.frontlap)
        return plan_aerial(field, AerialTask(survey.height + ground, width, trigger, wind=survey.wind), params).items
    except ValueError as error:
        raise BadInput(f"survey: {error}") from error
