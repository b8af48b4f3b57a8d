"""Whether a mission was done: figures measured on the messages of a run, against the mission's criteria.

Scores may read ``truth/**``; nothing that drives or flies may.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from launch.scoring import formation_scores, touchdown
from schemas import topics
from schemas.messages import Contact, Grid, Mission, MissionItem, MissionProgress, NavState, PoseInFrame
from uvf.maths.rotations import wrap
from uvf.models.mission.file import Criterion
from uvf.models.scenario import Scenario
from uvf.models.yaml_data import BadInput, FileLocation, nearest
from uvf.runtime.bus.interface import Bus, Sample
from uvf.runtime.messages.convert import array
from uvf.runtime.messages.mapped_floor import MappedFloor

Floats = NDArray[np.float64]

PASSED = 3.0  # s, within which of being told so a waypoint is passed


@dataclass
class RecordedTrack:
    """What a run recorded about one vehicle; positions [m, world], times [s, simulation]."""

    name: str
    site: Scenario
    truth: list[tuple[float, float, float, float, float]] = field(default_factory=list)  # t, x, y, z, airspeed
    pose: list[tuple[float, float, float]] = field(default_factory=list)  # t, x, y
    progress: list[tuple[float, int, int]] = field(default_factory=list)  # t, reached, laps
    contacts: int = 0
    touching: bool = False
    felt: bool = False
    grid: Grid | None = None
    mission: Mission | None = None
    team: "dict[str, RecordedTrack]" = field(default_factory=dict)  # all of the run, this one included

    def heard(self, sample: Sample) -> None:
        """Stores a sample of this vehicle."""
        t = sample.stamp_ns / 1e9
        name = sample.key.split("/", 2)[2]
        if name == "truth/state":
            state = NavState.FromString(sample.payload)
            p = state.position
            self.truth.append((t, p.x, p.y, p.z, state.airspeed))
        elif name == "nav/pose":
            q = PoseInFrame.FromString(sample.payload).pose.position
            self.pose.append((t, q.x, q.y))
        elif name == "sensor/contact":
            touching = Contact.FromString(sample.payload).touching
            self.contacts += touching and not self.touching
            self.touching, self.felt = touching, True
        elif name == "map/grid":
            self.grid = Grid.FromString(sample.payload)
        elif name == "mission/plan":
            self.mission = Mission.FromString(sample.payload)
        elif name == "mission/progress":
            progress = MissionProgress.FromString(sample.payload)
            self.progress.append((t, progress.reached, progress.laps))

    @property
    def flies(self) -> bool:
        """Whether the vehicle is an aircraft."""
        return self.site.members[self.name].file.kind == "fixed_wing"

    def positions(self) -> Floats:
        """True positions (n, 4): t [s], x, y, z [m, world]."""
        return self.motion()[:, :4]

    def motion(self) -> Floats:
        """True motion (n, 5): t [s], x, y, z [m, world], airspeed [m/s]."""
        return np.array(self.truth).reshape(-1, 5)


def check_criteria(site: Scenario) -> None:
    """Raises BadInput for a criterion with an unknown measure."""
    for i, criterion in enumerate(site.mission.criteria):
        if criterion.measure not in MEASURES:
            place = FileLocation(str(site.mission_path)).at("criteria", i, "measure")
            raise BadInput(f"{place}: no measure '{criterion.measure}'; {nearest(criterion.measure, MEASURES, len(MEASURES))}")


class Scorer:
    """Listens to a run on any bus (or is fed from a log) and judges it at the end."""

    def __init__(self, site: Scenario) -> None:
        self._site = site
        check_criteria(site)
        self._tracks: dict[str, RecordedTrack] = {}
        self._tracks.update({name: RecordedTrack(name, site, team=self._tracks) for name in site.members})

    def follow(self, bus: Bus) -> None:
        """Subscribes to what the measures need."""
        wanted = (topics.TRUTH, topics.POSE, topics.CONTACT, topics.MAP, topics.MISSION, topics.PROGRESS)
        for topic in wanted:
            bus.subscribe(topic.at("*"), topic.qos, self.heard, depth=256)

    def heard(self, sample: Sample) -> None:
        """Stores a sample with the vehicle that it belongs to."""
        track = self._tracks.get(sample.key.split("/")[1])
        if track is not None:
            track.heard(sample)

    def motions(self) -> dict[str, Floats]:
        """``RecordedTrack.motion`` (n, 5) [s, m, m/s] of each aircraft, by name."""
        return {name: track.motion() for name, track in self._tracks.items() if track.flies}

    def judge(self) -> list["Verdict"]:
        """One verdict for each criterion of the mission."""
        return [Verdict(c, MEASURES[c.measure](self._tracks[c.vehicle])) for c in self._site.mission.criteria]


@dataclass(frozen=True)
class Verdict:
    """The measured value of one criterion."""

    criterion: Criterion
    value: float

    @property
    def passed(self) -> bool:
        """Whether the value is within the criterion's limits."""
        low, high = self.criterion.at_least, self.criterion.at_most
        return (low is None or self.value >= low) and (high is None or self.value <= high)

    @property
    def limits(self) -> str:
        """The criterion's limits as text."""
        low, high = self.criterion.at_least, self.criterion.at_most
        return " and ".join(text for text in (f">= {low:g}" if low is not None else "", f"<= {high:g}" if high is not None else "") if text)


def distance_driven(track: RecordedTrack) -> float:
    """Distance travelled over the ground [m].

    Counts over the whole run, from the true positions.
    """
    p = track.positions()
    return float(np.linalg.norm(np.diff(p[:, 1:3], axis=0), axis=1).sum()) if len(p) > 1 else 0.0


def contacts(track: RecordedTrack) -> float:
    """Number of times that the vehicle began to touch something [count].

    Counts over the whole run. Infinite when no contact message was received.
    """
    return float(track.contacts) if track.felt else float("inf")


def pose_error(track: RecordedTrack) -> float:
    """Horizontal distance between the estimated and the true position [m].

    Counts at one moment: the last estimated pose of the run. Infinite without a pose.
    """
    p = track.positions()
    if not track.pose or not len(p):
        return float("inf")
    t, x, y = track.pose[-1]
    return float(np.hypot(np.interp(t, p[:, 0], p[:, 1]) - x, np.interp(t, p[:, 0], p[:, 2]) - y))


def mapped_floor(track: RecordedTrack) -> float:
    """Share of the reachable floor that the vehicle's own map knows as free [0 to 1].

    Counts at the end of the run, in the last map. The floor is what the vehicle can reach from its start. 0 without a map.
    """
    if track.grid is None:
        return 0.0
    return MappedFloor(track.site.world, track.site.members[track.name]).share(track.grid)


def circuits(track: RecordedTrack) -> float:
    """Rounds of the mission completed [count].

    Counts over the whole run. A round is complete when a jump leads back to the first item.
    """
    return float(max((laps for _, _, laps in track.progress), default=0))


def legs(track: RecordedTrack) -> float:
    """Mission items reached [count].

    Counts over the whole run, each round anew.
    """
    reached = [r for _, r, _ in track.progress]
    return float(sum(1 for a, b in pairwise(reached) if b != a and b >= 0))


def path_error(track: RecordedTrack) -> float:
    """Largest horizontal distance from the nearest leg of the mission [m].

    Counts from the first mission item reached until the end of the run. Legs are straight lines between waypoints, the last to the
    first included. Infinite with fewer than two waypoints, or when no item was reached.
    """
    p, corners = _scored(track), _corners(track)
    if not len(p) or len(corners) < 2:
        return float("inf")
    closed = np.vstack((corners, corners[:1]))
    return float(np.min([_distance(p[:, 1:3], a[:2], b[:2]) for a, b in pairwise(closed)], axis=0).max())


def altitude_error(track: RecordedTrack) -> float:
    """Largest difference from the altitude of the nearest leg of the mission [m].

    Counts from the first mission item reached until the end of the run. Infinite with fewer than two waypoints, or when no item was
    reached.
    """
    p, corners = _scored(track), _corners(track)
    if not len(p) or len(corners) < 2:
        return float("inf")
    closed = np.vstack((corners, corners[:1]))
    distances = np.array([_distance(p[:, 1:3], a[:2], b[:2]) for a, b in pairwise(closed)])
    altitudes = np.array([_altitude(p[:, 1:3], a, b) for a, b in pairwise(closed)])
    nearest_leg = distances.argmin(axis=0)
    return float(np.abs(p[:, 3] - altitudes[nearest_leg, np.arange(len(p))]).max())


def waypoint_error(track: RecordedTrack) -> float:
    """Largest distance in space by which a waypoint was missed [m].

    Counts within 3 s of the moment at which each waypoint was reached for the first time: there the nearest sample is taken. Infinite when
    a waypoint was not reached, or the mission has none.
    """
    return max((float(np.linalg.norm(p[0, 1:4] - array(item.position))) for item, p in _passes(track)), default=float("inf"))


def course_error(track: RecordedTrack) -> float:
    """Largest difference between the course over ground and the course that a waypoint asks for [rad].

    Counts at the sample nearest to each waypoint that has a course, within 3 s of the moment at which it was reached. Infinite when one was
    not reached, or no waypoint has a course.
    """
    asked = [(item, p) for item, p in _passes(track) if item.HasField("course")]
    flown = [np.arctan2(*(p[1] - p[0])[[2, 1]]) if len(p) > 1 else np.inf for _, p in asked]
    return max((abs(float(wrap(c - item.course))) for (item, _), c in zip(asked, flown, strict=True)), default=float("inf"))


def _passes(track: RecordedTrack) -> list[tuple[MissionItem, Floats]]:
    """Each waypoint with the samples (t, x, y, z) from where it was passed nearest, in the order of the mission."""
    p, found = track.positions(), []
    reached = {r: t for t, r, _ in reversed(track.progress)}
    for index, item in enumerate(track.mission.items if track.mission else ()):
        if item.kind != MissionItem.WAYPOINT:
            continue
        near = p[np.abs(p[:, 0] - reached.get(index, np.inf)) < PASSED]
        k = int(np.linalg.norm(near[:, 1:4] - array(item.position), axis=1).argmin()) if len(near) else 0
        found.append((item, near[k:] if len(near) else np.full((1, 4), np.inf)))
    return found


def separation(track: RecordedTrack) -> float:
    """Smallest distance from any other aircraft [m].

    Counts over the time in which both are heard. 0 when nothing was heard of this one; infinite when it is alone.
    """
    others = [other.motion() for name, other in track.team.items() if name != track.name and other.flies and other.truth]
    return formation_scores.separation(track.motion(), others) if track.truth else 0.0


def spacing_error(track: RecordedTrack) -> float:
    """RMS of the distance from the formation slot along the leader's track [m].

    Counts every 0.1 s from 20 s after the start, in which slots are taken up, until the end of the run. Infinite for an aircraft that
    follows nobody.
    """
    errors = _station_errors(track)
    return float(np.sqrt(np.mean(errors[:, 1] ** 2))) if len(errors) else float("inf")


def station_error(track: RecordedTrack) -> float:
    """RMS of the distance from the formation slot in space [m].

    Counts every 0.1 s from 20 s after the start, in which slots are taken up, until the end of the run. Infinite for an aircraft that
    follows nobody.
    """
    errors = _station_errors(track)
    return float(np.sqrt(np.mean((errors[:, 1:] ** 2).sum(axis=1)))) if len(errors) else float("inf")


def _station_errors(track: RecordedTrack) -> Floats:
    follow = track.site.members[track.name].entry.job.follow
    if follow is None or not track.truth or not track.team[follow.leader].truth:
        return np.zeros((0, 4))
    return formation_scores.station_errors(track.motion(), track.team[follow.leader].motion(), follow)


def _corners(track: RecordedTrack) -> Floats:
    items = track.mission.items if track.mission else ()
    return np.array([array(i.position) for i in items if i.kind == MissionItem.WAYPOINT]).reshape(-1, 3)


def _scored(track: RecordedTrack) -> Floats:
    begun = next((t for t, reached, _ in track.progress if reached >= 0), np.inf)
    p = track.positions()
    return p[p[:, 0] >= begun]


def _along(p: Floats, a: Floats, b: Floats) -> Floats:
    d = b - a
    share: Floats = np.clip((p - a) @ d / max(float(d @ d), 1e-12), 0.0, 1.0)
    return share


def _distance(p: Floats, a: Floats, b: Floats) -> Floats:
    nearest_point = a + _along(p, a, b)[:, None] * (b - a)
    distance: Floats = np.linalg.norm(p - nearest_point, axis=1)
    return distance


def _altitude(p: Floats, a: Floats, b: Floats) -> Floats:
    altitude: Floats = a[2] + _along(p, a[:2], b[:2]) * (b[2] - a[2])
    return altitude


def touchdown_sink(track: RecordedTrack) -> float:
    """Sink rate at touchdown [m/s].

    Counts over the last 0.2 s before the wheels touch the ground for good. Infinite unless the aircraft has flown and stands at the end.
    """
    return touchdown.sink(track.positions())


def touchdown_error(track: RecordedTrack) -> float:
    """Distance between the touchdown point and the aiming point, along the runway [m].

    Counts at the moment of touchdown. The aiming point is a quarter of the runway, at most 60 m, behind its threshold. Infinite without
    a runway or a landing.
    """
    return touchdown.error(track.positions(), track.site.world.strips)


def speed_at_end(track: RecordedTrack) -> float:
    """Mean speed in space [m/s].

    Counts over the last second of the run.
    """
    return touchdown.speed_at_end(track.positions())


_MEASURES = (distance_driven, contacts, pose_error, mapped_floor, circuits, legs, path_error, altitude_error, waypoint_error, course_error)
_OF_LANDINGS = (touchdown_sink, touchdown_error, speed_at_end)
_OF_FORMATIONS = (separation, spacing_error, station_error)
MEASURES: dict[str, Callable[[RecordedTrack], float]] = {f.__name__: f for f in (*_MEASURES, *_OF_FORMATIONS, *_OF_LANDINGS)}
