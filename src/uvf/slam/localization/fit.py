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
    """Score by which matches are compared [-]: the share of points that find a surface, less PER_RMS for each metre of their distance."""
    return found.share - PER_RMS * found.rms


@dataclass
class UsualMatch:
    """Averages of matches: the share of a sweep's points that find a surface of the map [-], and their rms distance to it [m]."""

    share: float = 0.7
    rms: float = 0.02

    def add(self, found: Match) -> bool:
        """Learns from a match; returns whether it is as good as matches usually are."""
        good = self.is_good(found)
        self.share += LEARNT * (found.share - self.share)
        self.rms += LEARNT * (found.rms - self.rms)
        return good

    def is_good(self, found: Match) -> bool:
        """Whether a match is about as good as matches usually are."""
        return found.share >= WELL * self.share and found.rms <= LOOSE * self.rms


@dataclass(frozen=True)
class Fit:
    """How a sweep fits the map: shares of its beams, 0..1, on walls and contradicting it. The others tell nothing."""

    on_walls: float
    against: float

    @property
    def says_something(self) -> bool:
        """Whether enough beams agree with or contradict the map for the sweep to count."""
        return self.on_walls + self.against > ENOUGH

    @property
    def agreement(self) -> float:
        """Share of the beams that agree, of those that tell anything, 0 to 1; 0 where none does."""
        return self.on_walls / max(self.on_walls + self.against, 1e-9)


@dataclass
class UsualFit:
    """Averages of the fits where the vehicle is believed to be."""

    on_walls: float = USUAL
    against: float = 0.0
    agreement: float = USUAL
    usual: float = USUAL

    def add(self, fit: Fit, news: float, learns: bool) -> None:
        """Takes a fit into the averages. news: how much new the sweep tells, 0 to 1; learns: whether the fit is to count as usual."""
        rate = 1.0 - (1.0 - SHORT) ** news
        self.on_walls += rate * (fit.on_walls - self.on_walls)
        self.against += rate * (fit.against - self.against)
        if fit.says_something:
            self.agreement += rate * (fit.agreement - self.agreement)
            if learns:
                self.usual += LONG * news * (fit.agreement - self.usual)

    @property
    def share(self) -> float:
        """How well the sweeps agree now compared with what is usual, 0 to 1."""
        return min(self.agreement / max(self.usual, LEAST_USUAL), 1.0)

    def contradicts(self, most: float) -> bool:
        """Whether the share of beams that contradict the map is above ``most``, 0 to 1, and above that of those on its walls."""
        return self.against > max(most, self.on_walls)

    @property
    def shows_nothing(self) -> bool:
        """Whether hardly any beam ends on a wall of the map."""
        return self.on_walls < NOTHING

    def is_usual(self, fit: Fit, part: float) -> bool:
        """Whether a fit tells something and agrees by more than ``part``, 0 to 1, of what is usual."""
        return fit.says_something and fit.agreement > part * max(self.usual, LEAST_USUAL)

    def begin(self, fit: Fit) -> None:
        """Starts the short-term averages anew from this fit."""
        self.on_walls, self.against, self.agreement = fit.on_walls, fit.against, fit.agreement

    def forget_newest(self) -> None:
        """Resets the short-term averages to no worse than what is usual."""
        self.on_walls, self.against, self.agreement = max(self.on_walls, USUAL), 0.0, max(self.agreement, self.usual)
