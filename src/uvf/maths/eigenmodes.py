"""The natural motions of an aircraft, named: Beard and McLain, "Small Unmanned Aircraft", section 5.6."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

REAL = 1e-6
"""1/s: an imaginary part below it is rounding."""


@dataclass(frozen=True)
class Mode:
    """One real eigenvalue, or the upper one of a pair [1/s]."""

    name: str
    eigenvalue: complex

    @property
    def oscillates(self) -> bool:
        """Whether the eigenvalue is one of a complex pair."""
        return self.eigenvalue.imag > REAL

    @property
    def frequency(self) -> float:
        """Natural, undamped frequency [rad/s]."""
        return abs(self.eigenvalue)

    @property
    def damping(self) -> float:
        """Damping ratio [-]; below zero the motion grows. A real eigenvalue has 1 or -1."""
        return -self.eigenvalue.real / self.frequency if self.frequency else 1.0

    @property
    def time_constant(self) -> float:
        """Time [s] in which the motion falls to 1/e; below zero, the time in which it grows e-fold; infinite where it does neither."""
        return -1 / self.eigenvalue.real if self.eigenvalue.real else float("inf")

    @property
    def period(self) -> float:
        """Period of the oscillation [s]; infinite when the motion does not oscillate."""
        return 2 * np.pi / self.eigenvalue.imag if self.oscillates else float("inf")


def longitudinal_modes(a: Floats) -> list[Mode]:
    """Modes of a longitudinal state matrix (5, 5) with the states u, w, q, theta, h.

    Two of the short period, two of the phugoid (one of each where it oscillates), and that of the altitude, which is the slowest.
    A pair between two real ones is neither: a pitch oscillation and two subsidences.
    """
    fast_first = _fast_first(a)
    altitude = min((v for v in fast_first if abs(v.imag) <= REAL), key=abs)
    rest = [v for v in fast_first if v is not altitude]
    if abs(rest[1].imag) > REAL and rest[1] == rest[2].conjugate():  # slow or buoyant aircraft: the book's names do not fit
        middle = _named("pitch oscillation", rest[1:3])
        return [Mode("subsidence", rest[0]), *middle, Mode("subsidence", rest[3]), Mode("altitude", altitude)]
    return [*_named("short period", rest[:2]), *_named("phugoid", rest[2:]), Mode("altitude", altitude)]


def lateral_modes(a: Floats) -> list[Mode]:
    """Modes of a lateral state matrix (5, 5) with the states v, p, r, phi, psi: Dutch roll, roll, spiral and heading.

    The heading's eigenvalue is zero, for every direction is the same.
    """
    fast_first = _fast_first(a)
    heading = min((v for v in fast_first if abs(v.imag) <= REAL), key=abs)
    rest = [v for v in fast_first if v is not heading]
    pairs = [v for v in rest if abs(v.imag) > REAL]
    if len(pairs) == 4:  # roll and spiral have joined into the slower pair
        return [*_named("Dutch roll", rest[:2]), *_named("roll and spiral", rest[2:]), Mode("heading", heading)]
    real = [v for v in rest if abs(v.imag) <= REAL]
    dutch = pairs or real[1:-1]  # overdamped: the two between the fast roll and the slow spiral
    return [*_named("Dutch roll", dutch), Mode("roll", real[0]), Mode("spiral", real[-1]), Mode("heading", heading)]


def _fast_first(a: Floats) -> list[complex]:
    return sorted((complex(v) for v in np.linalg.eigvals(a)), key=lambda v: (-abs(v), v.imag))


def _named(name: str, two: list[complex]) -> list[Mode]:
    """A pair is one mode; two real ones are two, the faster first."""
    upper = [v for v in two if v.imag > REAL]
    return [Mode(name, v) for v in upper or two]
