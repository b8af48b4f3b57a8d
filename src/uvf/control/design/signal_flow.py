"""Linear loops as equations between named signals, solved at each frequency: dead times are exact, and no order is reduced.

Every signal has one equation. What the loop does when it is opened at a signal follows from a disturbance that is added there.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from uvf.maths.state_space import StateSpace

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]
Terms = Mapping[str, complex | float | Complex]

SLOWEST, BELOW = 1e-6, 10  # rad/s, from which poles are counted; frequencies between that and the first that was asked for


class SignalFlow:
    """Equations between signals at s = j omega; omega: (k,) [rad/s], rising to beyond all that moves."""

    def __init__(self, omega: Floats, signals: Sequence[str], inputs: Sequence[str] = ()) -> None:
        """signals: each needs one equation; inputs: what comes from outside, as gusts and noise."""
        self.omega = omega
        below = np.geomspace(SLOWEST, omega[0], BELOW, endpoint=False)
        self._s: Complex = np.asarray(1j * np.concatenate((below, omega)), dtype=np.complex128)
        self.s: Complex = self._s[BELOW:]
        self.inputs = tuple(inputs)
        self._row = {name: i for i, name in enumerate(signals)}
        self._input = {name: i for i, name in enumerate(inputs)}
        n = len(signals)
        self._opened: dict[str, int] = {}
        self._matrix: Complex = np.zeros((len(self._s), n, n), dtype=np.complex128)
        self._driven: Complex = np.zeros((len(self._s), n, len(self.inputs)), dtype=np.complex128)
        self._order = 0
        self._solved: Complex | None = None

    def equal(self, name: str, terms: Terms) -> None:
        """The signal is the sum of the terms: coefficients by signal or input."""
        self._set(name, 1.0, terms)

    def integral(self, name: str, terms: Terms) -> None:
        """The signal's rate of change is the sum of the terms."""
        self._order += 1
        self._set(name, self._s, terms)

    def lag(self, name: str, time: float, terms: Terms) -> None:
        """The signal follows the sum of the terms with a time constant [s]; at once with 0."""
        self._order += int(time > 0.0)
        self._set(name, 1.0 + time * self._s, terms)

    def dead_time(self, time: float) -> Complex:
        """The coefficient of a signal that comes late by a dead time [s]."""
        return np.asarray(np.exp(-time * self._s))

    def actuator(self, letter: str, asked: str | None, lags: tuple[float, float], late: float) -> None:
        """``delta_LETTER`` behind ``servo_LETTER`` behind the signal ``asked``: lags and dead time in [s]; None: it holds."""
        servo, model = lags
        self.lag(f"servo_{letter}", servo, {asked: self.dead_time(late)} if asked is not None else {})
        self.lag(f"delta_{letter}", model, {f"servo_{letter}": 1.0})

    def airframe(self, model: StateSpace, states: Sequence[str], in_air: Mapping[str, Sequence[str]]) -> None:
        """The rates of change of a model's states. Gusts count as the aircraft's own motion the other way, but for what is kinematic.

        in_air: by state, the motions ``x`` of which it depends through the air; the input ``gust_x`` goes with each.
        """
        for state in states:
            own = {by: model.slope(state, by) for by in (*model.states, *model.inputs)}
            self.integral(state, own | {f"gust_{by}": -own[by] for by in in_air.get(state, ())})

    def _set(self, name: str, own: complex | Complex, terms: Terms) -> None:
        row = self._row[name]
        self._matrix[:, row, row] += own
        for other, value in terms.items():
            if other in self._row:
                self._matrix[:, row, self._row[other]] -= value
            else:
                self._driven[:, row, self._input[other]] += value

    def response(self, output: str, by: str) -> Complex:
        """(k,) of a signal to an input, all loops closed."""
        return self._all[:, self._row[output], self._input[by]]

    def opens(self, *signals: str) -> None:
        """Signals at which loops will be opened."""
        self._opened = {name: len(self.inputs) + i for i, name in enumerate(signals)}

    def closed(self, output: str, at: str) -> Complex:
        """(k,) of a signal to what is added to the signal ``at`` (of ``opens``, with an equation of ``equal``), all loops closed."""
        return self._all[:, self._row[output], self._opened[at]]

    def loop(self, at: str) -> Complex:
        """(k,) the loop opened at a signal of ``equal``, the others closed; the feedback's minus left out: it closes as 1 + L."""
        return 1.0 / self.closed(at, at) - 1.0

    @property
    def _all(self) -> Complex:
        """(k, n, m): every signal to every input, and to what is added to the signals that are opened."""
        if self._solved is None:
            added = np.eye(len(self._row))[:, [self._row[name] for name in self._opened]]
            added = np.broadcast_to(added, (len(self.omega), *added.shape))
            solved = np.linalg.solve(self._matrix[BELOW:], np.concatenate((self._driven[BELOW:], added), axis=2))
            self._solved = np.asarray(solved, dtype=np.complex128)
        return self._solved

    @property
    def unstable(self) -> int:
        """Number of closed-loop poles in the right half-plane.

        By the argument principle: the determinant of the equations turns by pi / 2 for each pole on the left, and back for each on the
        right, as omega goes from 0 beyond the fastest pole (Mikhailov's criterion, which holds with dead times too). It begins far below
        the frequencies that were asked for: two integrals slower than these would have turned it before the first of them.
        """
        sign, _ = np.linalg.slogdet(self._matrix)
        angle = np.unwrap(np.angle(sign))
        start = np.pi * round(float(angle[0]) / np.pi)  # at omega 0 it is real
        turned = float(angle[-1]) - start
        return round((self._order - turned * 2 / np.pi) / 2)
