"""Whether sweeps agree with the map as well as they usually do: short-term and long-term averages (Thrun et al. 2005, table 8.3).

What the map does not know neither agrees nor contradicts: who drives into a room that has not been mapped has not been carried away.
"""

from dataclasses import dataclass

from uvf.slam.matching.imls import Match

SHORT, LONG = 0.6, 0.02
"""Rates of the averages by sweep that tells something new."""
USUAL = 0.6  # agreement that is usual at first
LEAST_USUAL = 0.3
ENOUGH = 0.25  # of a sweep's beams that have to fit or contradict, so that it says something
MOST_AGAINST, MANY_AGAINST = 0.4, 0.25
"""Of a sweep's beams that may contradict for long, and after the view has changed at once."""
NOTHING = 0.15
"""Of a sweep's beams on walls up to which the map shows nothing of what is seen."""
WELL, LOOSE, LEARNT = 0.5, 1.5, 0.02
"""Part of the usual share and times the usual rms at which a match is no longer a good one; rate of what is usual."""
PER_RMS = 4.0


def worth(found: Match) -> float:
    """Matches are compared by it: the share of points that find a surface, less PER_RMS for each metre of their distance."""
    return found.share - PER_RMS * found.rms


@dataclass
class UsualMatch:
    """How many points of a sweep find a surface of the map, and how near [m] they are to it."""

    share: float = 0.7
    rms: float = 0.02

    def add(self, found: Match) -> bool:
        """Whether it is as good as matches usually are."""
        good = self.is_good(found)
        self.share += LEARNT * (found.share - self.share)
        self.rms += LEARNT * (found.rms - self.rms)
        return good

    def is_good(self, found: Match) -> bool:
        return found.share >= WELL * self.share and found.rms <= LOOSE * self.rms


@dataclass(frozen=True)
class Fit:
    """Of a sweep's beams, 0..1: how many are on walls of the map, and how many contradict it. The others tell nothing."""

    on_walls: float
    against: float

    @property
    def says_something(self) -> bool:
        return self.on_walls + self.against > ENOUGH

    @property
    def agreement(self) -> float:
        """0..1; 0 where no beam tells anything."""
        return self.on_walls / max(self.on_walls + self.against, 1e-9)


@dataclass
class UsualFit:
    """Averages of the fits where the vehicle is believed to be."""

    on_walls: float = USUAL
    against: float = 0.0
    agreement: float = USUAL
    usual: float = USUAL

    def add(self, fit: Fit, news: float, learns: bool) -> None:
        """news: 0..1, how much the sweep tells; learns: whether it is to count as usual."""
        rate = 1.0 - (1.0 - SHORT) ** news
        self.on_walls += rate * (fit.on_walls - self.on_walls)
        self.against += rate * (fit.against - self.against)
        if fit.says_something:
            self.agreement += rate * (fit.agreement - self.agreement)
            if learns:
                self.usual += LONG * news * (fit.agreement - self.usual)

    @property
    def share(self) -> float:
        """0..1, how well it agrees now for what is usual."""
        return min(self.agreement / max(self.usual, LEAST_USUAL), 1.0)

    def contradicts(self, most: float) -> bool:
        """Whether more beams than ``most`` tell against the place, and more than tell for it."""
        return self.against > max(most, self.on_walls)

    @property
    def shows_nothing(self) -> bool:
        return self.on_walls < NOTHING

    def is_usual(self, fit: Fit, part: float) -> bool:
        return fit.says_something and fit.agreement > part * max(self.usual, LEAST_USUAL)

    def begin(self, fit: Fit) -> None:
        """What counts from now on is how it fits here."""
        self.on_walls, self.against, self.agreement = fit.on_walls, fit.against, fit.agreement

    def forget_newest(self) -> None:
        self.on_walls, self.against, self.agreement = max(self.on_walls, USUAL), 0.0, max(self.agreement, self.usual)
