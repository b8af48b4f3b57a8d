"""Where a vehicle is on a known map: tracking, starting from nothing, and noticing that it has been carried away."""

from enum import Enum
from math import hypot

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.slam.graph.motion import MotionNoise
from uvf.slam.localization.beams import beams_of
from uvf.slam.localization.fit import MANY_AGAINST, MOST_AGAINST, UsualFit, UsualMatch, worth
from uvf.slam.localization.groups import near
from uvf.slam.localization.known_map import KnownMap
from uvf.slam.localization.motion import OdometryNoise
from uvf.slam.localization.params import FilterParams
from uvf.slam.localization.particle_filter import FilterSweep, Hypothesis, ParticleFilter, Prediction
from uvf.slam.localization.proposals import PoseProposal
from uvf.slam.localization.recent import Moved, RecentSweeps
from uvf.slam.localization.whole_map import Lately, whole_map
from uvf.slam.logs.jumps import step_between
from uvf.slam.matching.cloud import cloud_of
from uvf.slam.matching.imls import match
from uvf.slam.method import SlamEstimate
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]

START = np.diag((0.1, 0.1, 0.05)) ** 2  # covariance of a start pose that is given without one
REMEMBERED = np.diag((0.2, 0.2, 0.06)) ** 2  # of the pose by odometry, while it is not known whether it still holds
FOUND = np.diag((0.1, 0.1, 0.04)) ** 2  # of a place found in the whole map
LEAPS = 0.1, 0.1  # m, rad by which the map may correct a step without being doubted
STEP, BETTER = MotionNoise(), 0.02  # of a step that leads to a match beside; worth by which a leap has to be better than that
STOOD = 1e-4  # m, rad
NEWS_WAY, NEWS_TURN = 0.25, 0.35
"""m, rad of motion after which a sweep counts in full: what is seen from the same place tells nothing new."""
MATCHED = 0.25  # part of the odometry's noise that is left when sweeps have been matched to those before
SEARCH_WAY = 1.0  # m between searches in the whole map
MOST_PLACES = 8
SURE, SURE_WAY = 0.95, 1.0
"""Weight that a hypothesis needs for so many metres, so that it is believed."""
FITS = 0.7  # part of what is usual that such a one has to fit
BROKEN, TORN, BROKEN_WAY = 0.6, 0.4, 2.0
"""Parts of the usual fit to the sweeps before below which the view has changed at once, and altogether; m for which that may have been
a kidnapping."""
AGAINST_WAY = 1.0
"""m for which sweeps may contradict the map where nothing has broken: something large stands in the way, or the odometry has slipped."""
HALF_SURE = 0.5
"""Quality that is never exceeded while the vehicle is looked for."""
OWN_PART = 0.3  # weight of the heaviest hypothesis beside the last pose that a nearer one has to have, to be the one that goes on
PUT_IN = 0.4  # weight of what a search has found while it is not known where the vehicle is


class LocalizerState(Enum):
    """Whether the localizer knows its pose, searches for it from nothing, or has lost it."""

    TRACKING = "tracking"
    SEARCHING = "searching"
    LOST = "lost"


class Localizer:
    """Monte Carlo localization, fed with readings as a ``SlamMethod`` is; poses are those of the known map's frame."""

    def __init__(self, known: KnownMap, params: FilterParams, seed: int, start: Pose2 | None = None, covariance: Floats = START) -> None:
        """start: map_from_base at the first reading; None where nothing is known."""
        self.known, self.params = known, params
        self.filter = ParticleFilter(known, (params.least_particles, params.most_particles), np.random.default_rng(seed))
        self.hypotheses: list[Hypothesis] = []
        self.fit, self._usual = UsualFit(), UsualMatch()
        self._recent, self._lately = RecentSweeps(), Lately()
        self._last: Reading | None = None
        self.pose = start or IDENTITY
        self.relocalize() if start is None else self.set_pose(start, covariance)

    def set_pose(self, pose: Pose2, covariance: Floats = START) -> None:
        """Begins at ``pose`` (map_from_base), with a covariance (3, 3) of (x, y, yaw) [m, rad]."""
        self.state = LocalizerState.TRACKING
        self.filter.begin_at(pose, covariance)
        self._begin(pose)

    def doubt(self, pose: Pose2) -> None:
        """Begins at ``pose`` (map_from_base), which may be wrong, and searches the whole map as well."""
        self.state = LocalizerState.LOST
        self.filter.begin_at(pose, REMEMBERED)
        self._begin(pose)

    def relocalize(self) -> None:
        """Begins with no knowledge of the pose: searches the whole map."""
        self.state = LocalizerState.SEARCHING
        self.filter.begin_anywhere()
        self._begin(self.pose)

    def _begin(self, pose: Pose2) -> None:
        self.pose = pose
        self._lately.forget()
        self._searched_at = -np.inf
        self._sure_since: float | None = None
        self.is_fresh = True
        self._broken_at = self._torn_at = -np.inf
        self._agreed_at = self._lately.way
        self.hypotheses = []
        self.fit.forget_newest()

    def add(self, reading: Reading) -> SlamEstimate:
        """Takes in one reading; the estimate is in the known map's frame."""
        told = self._step(reading)
        news = 1.0 if self.is_fresh else min(1.0, hypot(told.x, told.y) / NEWS_WAY + abs(told.yaw) / NEWS_TURN)
        sweep = FilterSweep(cloud_of(reading), beams_of(reading, self.params.beams), news)
        moved, prediction = self._moved(sweep, told)
        self._lately.add(self._recent.pose, sweep.cloud.points)
        if news > 0.0:
            self.is_fresh = False
            if self.state is not LocalizerState.TRACKING and self._lately.way - self._searched_at >= SEARCH_WAY:
                self._search()
                prediction = None
            self.hypotheses = self.filter.correct(prediction or self._predicted(moved.step, self._noise(moved), sweep), sweep)
            self._decide(moved, news)
        return SlamEstimate(self.pose, self._covariance(), self.quality)

    def _moved(self, sweep: FilterSweep, told: Pose2) -> tuple[Moved, Prediction | None]:
        """The step; and where it leads, if the map has told it: a tracked vehicle whose sweep fits well needs no other sweeps.

        told: by the odometry.
        """
        if not self.is_fresh and hypot(told.x, told.y) < STOOD and abs(told.yaw) < STOOD:
            return Moved(IDENTITY, True, 1.0), None
        if self.state is LocalizerState.TRACKING and not self.is_fresh:
            prediction = self._predicted(told, self._odometry_noise(), sweep)
            own = prediction.only
            if own is not None and own.match is not None and self._usual.add(own.match) and self._follows(own, told):
                return self._recent.follow(sweep.cloud, compose(inverse(self.pose), own.pose)), prediction
        return self._recent.add(sweep.cloud, told), None

    def _follows(self, own: PoseProposal, step: Pose2) -> bool:
        """Whether a match is where a step leads."""
        return near(own.pose, compose(self.pose, step), *LEAPS)

    def _predicted(self, step: Pose2, noise: OdometryNoise, sweep: FilterSweep) -> Prediction:
        """Where a step leads. A tracked vehicle's match that leaps counts only where it is better than one that does not (many a
        corridor looks the same a little further on), and no less than half as good as usual (few walls fit in many places)."""
        prediction = self.filter.predict(step, noise, sweep)
        own = prediction.proposals[0]
        if self.state is not LocalizerState.TRACKING or own.match is None or self._follows(own, step):
            return prediction
        other = match(compose(self.pose, step), sweep.cloud, self.known.surfaces, STEP.information(step))
        if worth(other) >= worth(own.match) - BETTER:
            return prediction.instead(other)
        return prediction if self._usual.is_good(own.match) else prediction.instead(None)

    def _odometry_noise(self) -> OdometryNoise:
        p = self.params
        return OdometryNoise(p.turn_by_turn, p.turn_by_way, p.way_by_way, p.way_by_turn)

    def _noise(self, moved: Moved) -> OdometryNoise:
        return self._odometry_noise().times(MATCHED) if moved.matched else self._odometry_noise()

    @property
    def quality(self) -> float:
        """Confidence, 0 to 1: how sure it is that the vehicle is there, and how well what it sees fits."""
        own = self._own
        if own is None:
            return 0.0
        sure = own.weight * (1.0 if self.state is LocalizerState.TRACKING else HALF_SURE)
        return float(np.clip(sure * self.fit.share, 0.0, 1.0))

    @property
    def _own(self) -> Hypothesis | None:
        """The hypothesis that is told: the one that goes on from the last pose; while it is looked for from nothing, the best one."""
        if not self.hypotheses or self.state is LocalizerState.SEARCHING:
            return next(iter(self.hypotheses), None)
        beside = [h for h in self.hypotheses if near(h.pose, self.pose)]
        heavy = [h for h in beside if h.weight > OWN_PART * beside[0].weight]
        return min(heavy, key=lambda h: hypot(h.pose.x - self.pose.x, h.pose.y - self.pose.y), default=None)

    def _covariance(self) -> Floats:
        own = self._own
        return own.covariance if own else self.filter.spread()

    def _step(self, reading: Reading) -> Pose2:
        """Since the last reading; a leap that no vehicle drives counts as none: where it has come to will be seen."""
        last, self._last = self._last, reading
        return IDENTITY if last is None else step_between(last, reading) or IDENTITY

    def _decide(self, moved: Moved, news: float) -> None:
        self.pose = compose(self.pose, moved.step)
        own = self._own
        if own is None and self.state is LocalizerState.TRACKING:
            own = self.hypotheses[0]
        if moved.fits < BROKEN:
            self._broken_at = self._lately.way
        if moved.fits < TORN:
            self._torn_at = self._lately.way
        if own is not None:
            if own.matched:
                self.pose = own.pose
            self.fit.add(own.fit, news, self.state is LocalizerState.TRACKING)
        if self.state is LocalizerState.TRACKING:
            self._notice()
        else:
            self._find(self.hypotheses[0])

    def _find(self, best: Hypothesis) -> None:
        """Who has been sure for long enough is there."""
        if best.weight < SURE or not self.fit.is_usual(best.fit, FITS):
            self._sure_since = None
        elif self._sure_since is None:
            self._sure_since = self._lately.way
        elif self._lately.way - self._sure_since >= SURE_WAY and not self._has_rival(best):
            self.state = LocalizerState.TRACKING
            self.pose = best.pose
            self.fit.begin(best.fit)
            self._agreed_at = self._lately.way

    def _notice(self) -> None:
        """Sweeps that contradict the map, at once with a view that has changed at once or for long, tell that the vehicle is elsewhere.

        So does a view that has changed altogether to one of which the map shows nothing: then nothing speaks for the place any more.
        """
        way = self._lately.way
        if not self.fit.contradicts(MOST_AGAINST):
            self._agreed_at = way
        at_once = way - self._broken_at < BROKEN_WAY and self.fit.contradicts(MANY_AGAINST)
        unsupported = way - self._torn_at < BROKEN_WAY and self.fit.shows_nothing
        if at_once or unsupported or way - self._agreed_at > AGAINST_WAY:
            self.state = LocalizerState.LOST
            self._lately.forget()
            self._searched_at, self._sure_since = -np.inf, None

    def _search(self) -> None:
        """Puts in the places of the whole map where what was seen lately fits and where no hypothesis is yet, and the one of before."""
        self._searched_at = self._lately.way
        found = [f.pose for f in whole_map(self.known, self._lately.points(), MOST_PLACES)]
        self.filter.put_in([p for p in found if not any(near(p, h.pose) for h in self.hypotheses)], FOUND, PUT_IN)
        if self.state is LocalizerState.LOST and self._own is None:
            self.filter.put_in([self.pose], REMEMBERED, PUT_IN)

    def _has_rival(self, own: Hypothesis) -> bool:
        """Whether what was seen lately fits somewhere else better; that place then becomes a hypothesis, too."""
        found = whole_map(self.known, self._lately.points(), 2)
        if not found or near(found[0].pose, own.pose, 1.0):
            return False
        self._sure_since = None
        self.filter.put_in([found[0].pose], FOUND, PUT_IN)
        return True
