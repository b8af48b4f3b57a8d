"""Whether a mission was done: figures measured on the messages of a run, against the mission's criteria.

Scores may read ``truth/**``; nothing that drives or flies may.
"""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.typing import NDArray

from launch.scoring.finding import Finding
from launch.scoring.flight_measures import separation, spacing_error, speed_at_end, station_error, touchdown_error, touchdown_sink
from launch.scoring.ground_measures import contacts, crashed, distance_driven, goal_time, pose_error, pose_error_rms
from launch.scoring.map_measures import height_error, map_f1, mapped_floor
from launch.scoring.marker_measures import marker_error, markers_found, markers_reached
from launch.scoring.path_measures import altitude_error, circuits, course_error, legs, path_error, waypoint_error
from launch.scoring.recorded_track import RECORDED, RecordedTrack
from launch.scoring.route_measures import cross_track_error, waypoints_missed_by
from launch.scoring.task_measures import TASK_MEASURES, RecordedTask, RecordedTasks
from schemas import topics
from schemas.messages import Tasks
from uvf.models.mission.file import Criterion
from uvf.models.mission.tasks import walk
from uvf.models.scenario import Scenario
from uvf.models.yaml_data import BadInput, FileLocation, nearest
from uvf.runtime.bus.interface import Bus, Sample

Floats = NDArray[np.float64]

_OF_ALL = (distance_driven, contacts, crashed, pose_error, pose_error_rms, mapped_floor, map_f1, height_error, goal_time)
_OF_MISSIONS = (circuits, legs, path_error, altitude_error, waypoint_error, course_error, waypoints_missed_by, cross_track_error)
_OF_SEARCHES = (markers_found, marker_error, markers_reached)
_OF_FLIGHTS = (separation, spacing_error, station_error, touchdown_sink, touchdown_error, speed_at_end)
MEASURES: dict[str, Callable[[RecordedTrack], Finding]] = {f.__name__: f for f in (*_OF_ALL, *_OF_MISSIONS, *_OF_SEARCHES, *_OF_FLIGHTS)}
_FLYING = {f.__name__ for f in (altitude_error, height_error, *_OF_FLIGHTS) if f is not speed_at_end}
_DRIVING = {f.__name__ for f in (mapped_floor, map_f1)}


def check_criteria(site: Scenario) -> None:
    """Raises BadInput for a criterion with an unknown measure, or one that its vehicle has nothing to be measured for."""
    for i, criterion in enumerate(site.mission.criteria):
        known: Collection[str] = TASK_MEASURES if criterion.task else MEASURES
        place = FileLocation(str(site.mission_path)).at("criteria", i, "measure")
        if criterion.measure not in known:
            of = "task has a measure" if criterion.task else "measure"
            raise BadInput(f"{place}: no {of} '{criterion.measure}'; {nearest(criterion.measure, known, len(known))}")
        if criterion.vehicle:
            _check_kind(criterion, site, place)


def _check_kind(criterion: Criterion, site: Scenario, place: FileLocation) -> None:
    drives = site.members[criterion.vehicle].file.kind == "ground"
    if criterion.measure in (_FLYING if drives else _DRIVING):
        does, other = ("drives", "aircraft") if drives else ("flies", "ground vehicles")
        raise BadInput(f"{place}: {criterion.vehicle} {does}; {criterion.measure} is a measure of {other}")


class Scorer:
    """Listens to a run on any bus (or is fed from a log) and judges it at the end."""

    def __init__(self, site: Scenario) -> None:
        self._site = site
        check_criteria(site)
        self._tracks: dict[str, RecordedTrack] = {}
        self._tracks.update({name: RecordedTrack(name, site, team=self._tracks) for name in site.members})
        self.tasks = RecordedTasks({task.name: RecordedTask() for task in walk(site.mission.tasks) if task.name})

    def follow(self, bus: Bus) -> None:
        """Subscribes to what the measures need."""
        for topic in RECORDED:
            bus.subscribe(topic.at("*"), topic.qos, self.heard, depth=256)
        bus.subscribe(topics.TASKS.at(topics.SYSTEM), topics.TASKS.qos, self.heard, depth=256)

    def heard(self, sample: Sample) -> None:
        """Stores a sample with the vehicle that it belongs to, or the tasks."""
        if sample.key == topics.TASKS.at(topics.SYSTEM):
            self.tasks.heard(sample.stamp_ns / 1e9, Tasks.FromString(sample.payload))
        track = self._tracks.get(sample.key.split("/")[1])
        if track is not None:
            track.heard(sample)

    def measure(self, vehicle: str, name: str) -> Finding:
        """One measure of a vehicle of the mission."""
        return MEASURES[name](self._tracks[vehicle])

    def motions(self) -> dict[str, Floats]:
        """``RecordedTrack.motion`` (n, 5) [s, m, m/s] of each aircraft, by name."""
        return {name: track.motion() for name, track in self._tracks.items() if track.flies}

    def judge(self) -> list["Verdict"]:
        """One verdict for each criterion of the mission."""
        return [Verdict(c, self._found(c)) for c in self._site.mission.criteria]

    def _found(self, criterion: Criterion) -> Finding:
        if criterion.task:
            return TASK_MEASURES[criterion.measure](self.tasks.tasks[criterion.task])
        return self.measure(criterion.vehicle, criterion.measure)


PASSED, FAILED = "passed", "FAILED"


@dataclass(frozen=True)
class Verdict:
    """What was measured for one criterion."""

    criterion: Criterion
    found: Finding

    @property
    def passed(self) -> bool:
        """Whether the value is within the criterion's limits."""
        low, high = self.criterion.at_least, self.criterion.at_most
        return (low is None or self.found.value >= low) and (high is None or self.found.value <= high)

    @property
    def word(self) -> str:
        """``PASSED`` or ``FAILED``."""
        return PASSED if self.passed else FAILED

    @property
    def margin(self) -> float:
        """How far the value is within the nearest limit, in the measure's unit; negative when it is beyond."""
        low, high = self.criterion.at_least, self.criterion.at_most
        return min(self.found.value - low if low is not None else inf, high - self.found.value if high is not None else inf)

    @property
    def subject(self) -> str:
        """Whom or what the criterion is about."""
        return self.criterion.vehicle or f"task {self.criterion.task}"

    @property
    def limits(self) -> str:
        """The criterion's limits as text."""
        low, high = self.criterion.at_least, self.criterion.at_most
        return " and ".join(text for text in (f">= {low:g}" if low is not None else "", f"<= {high:g}" if high is not None else "") if text)
