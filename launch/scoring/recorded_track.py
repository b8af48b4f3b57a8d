"""What a run recorded about one vehicle, as measures want it."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from launch.scoring.finding import Place
from schemas import topics
from schemas.messages import Contact, Detections, Event, Grid, Mission, MissionProgress, NavState, NavStatus, PoseInFrame
from uvf.models.scenario import Scenario
from uvf.runtime.bus.interface import Sample
from uvf.runtime.messages.convert import wxyz

Floats = NDArray[np.float64]

CRASHED = "crashed"
"""What the simulator says of an aircraft that has."""


@dataclass(frozen=True)
class BegunContact:
    """The beginning of a contact: when [s], and what was touched."""

    t: float
    other: str


@dataclass
class RecordedTrack:
    """What a run recorded about one vehicle; positions [m, world], times [s, simulation]."""

    name: str
    site: Scenario
    truth: list[tuple[float, float, float, float, float]] = field(default_factory=list)  # t, x, y, z, airspeed
    uprightness: list[float] = field(default_factory=list)  # cosine of the tilt, at the times of truth
    pose: list[tuple[float, float, float]] = field(default_factory=list)  # t, x, y
    progress: list[tuple[float, int, int]] = field(default_factory=list)  # t, reached, laps
    navigation: list[tuple[float, NavStatus]] = field(default_factory=list)  # at each change of job, goal or state
    touches: list[BegunContact] = field(default_factory=list)
    crash: tuple[float, str] | None = None  # t, against what
    touching: bool = False
    felt: bool = False
    grid: Grid | None = None
    heights: bytes | None = None  # the last map of heights, as it came: it is large
    detections: Detections | None = None
    mission: Mission | None = None
    team: "dict[str, RecordedTrack]" = field(default_factory=dict)  # all of the run, this one included

    def heard(self, sample: Sample) -> None:
        """Stores a sample of this vehicle."""
        name = sample.key.split("/", 2)[2]
        keep = _KEPT.get("state/events" if name.startswith("state/events/") else name)
        if keep is not None:
            keep(self, sample.stamp_ns / 1e9, sample.payload)

    def _keep_truth(self, t: float, payload: bytes) -> None:
        state = NavState.FromString(payload)
        p, (_, qx, qy, _) = state.position, wxyz(state.orientation)
        self.truth.append((t, p.x, p.y, p.z, state.airspeed))
        self.uprightness.append(1.0 - 2.0 * (qx * qx + qy * qy))

    def _keep_pose(self, t: float, payload: bytes) -> None:
        q = PoseInFrame.FromString(payload).pose.position
        self.pose.append((t, q.x, q.y))

    def _keep_contact(self, t: float, payload: bytes) -> None:
        contact = Contact.FromString(payload)
        if contact.touching and not self.touching:
            self.touches.append(BegunContact(t, contact.other))
        self.touching, self.felt = contact.touching, True

    def _keep_grid(self, t: float, payload: bytes) -> None:
        self.grid = Grid.FromString(payload)

    def _keep_heights(self, t: float, payload: bytes) -> None:
        self.heights = payload

    def _keep_detections(self, t: float, payload: bytes) -> None:
        self.detections = Detections.FromString(payload)

    def _keep_mission(self, t: float, payload: bytes) -> None:
        self.mission = Mission.FromString(payload)

    def _keep_progress(self, t: float, payload: bytes) -> None:
        progress = MissionProgress.FromString(payload)
        self.progress.append((t, progress.reached, progress.laps))

    def _keep_navigation(self, t: float, payload: bytes) -> None:
        status = NavStatus.FromString(payload)
        if not self.navigation or _changed(self.navigation[-1][1], status):
            self.navigation.append((t, status))

    def _keep_event(self, t: float, payload: bytes) -> None:
        event = Event.FromString(payload)
        if event.text == CRASHED and self.crash is None:
            self.crash = t, event.cause

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

    def place_at(self, t: float) -> Place | None:
        """True place (x, y) [m, world] at ``t`` [s]; None without a truth."""
        p = self.positions()
        return (float(np.interp(t, p[:, 0], p[:, 1])), float(np.interp(t, p[:, 0], p[:, 2]))) if len(p) else None


def _changed(before: NavStatus, now: NavStatus) -> bool:
    return (before.job, before.state, before.goal.x, before.goal.y) != (now.job, now.state, now.goal.x, now.goal.y)


_KEPT: dict[str, Callable[[RecordedTrack, float, bytes], None]] = {
    "truth/state": RecordedTrack._keep_truth,
    "nav/pose": RecordedTrack._keep_pose,
    "nav/status": RecordedTrack._keep_navigation,
    "sensor/contact": RecordedTrack._keep_contact,
    "map/grid": RecordedTrack._keep_grid,
    "map/heights": RecordedTrack._keep_heights,
    "nav/detections": RecordedTrack._keep_detections,
    "mission/plan": RecordedTrack._keep_mission,
    "mission/progress": RecordedTrack._keep_progress,
    "state/events": RecordedTrack._keep_event,
}
RECORDED = (
    topics.TRUTH,
    topics.POSE,
    topics.NAV_STATUS,
    topics.CONTACT,
    topics.MAP,
    topics.HEIGHTS,
    topics.DETECTIONS,
    topics.MISSION,
    topics.PROGRESS,
    topics.EVENTS.by("*"),
)
"""The topics that measures need."""
