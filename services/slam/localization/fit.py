"""Whether sweeps fit the map as well as they usually do: short-term and long-term averages (Thrun et al. 2005, table 8.3)."""

from dataclasses import dataclass

SHORT, LONG = 0.6, 0.02
"""Rates of the averages by sweep that tells something new."""
USUAL = 0.6  # what is usual at first
FALLEN = 0.6
"""Part of the usual fit below which something is wrong: the vehicle is elsewhere, or much of the place has changed."""
LEAST_USUAL = 0.3


@dataclass
class UsualFit:
    """Fits are shares of a sweep, 0..1; one below 0 says nothing."""

    short: float = USUAL
    long: float = USUAL

    def add(self, fit: float, news: float, learns: bool) -> None:
        """news: 0..1, how much the sweep tells; learns: whether it is to count as usual."""
        if fit < 0.0:
            return
        self.short += (1.0 - (1.0 - SHORT) ** news) * (fit - self.short)
        if learns:
            self.long += LONG * news * (fit - self.long)

    @property
    def share(self) -> float:
        """0..1, how well it fits now for what is usual."""
        return min(self.short / max(self.long, LEAST_USUAL), 1.0)

    @property
    def has_fallen(self) -> bool:
        return self.short < FALLEN * max(self.long, LEAST_USUAL)

    def is_usual(self, fit: float, part: float) -> bool:
        return fit > part * max(self.long, LEAST_USUAL)

    def recover(self, fit: float) -> None:
        self.short = max(fit, self.short)

    def forget_newest(self) -> None:
        self.short = max(self.short, self.long)
