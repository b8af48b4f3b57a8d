"""Linear models x' = A x + B u with named states and inputs, and how they come out of a nonlinear one."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import cont2discrete

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class StateSpace:
    """Linear model x' = A x + B u. a: (n, n), b: (n, m), in the order of ``states`` and ``inputs``.

    States and inputs are deviations from an equilibrium.
    """

    a: Floats
    b: Floats
    states: tuple[str, ...]
    inputs: tuple[str, ...]

    def part(self, states: Sequence[str], inputs: Sequence[str]) -> "StateSpace":
        """The model of these states and inputs alone, without what couples them with the rest. Raises ValueError for an unknown name."""
        rows = [self.states.index(name) for name in states]
        columns = [self.inputs.index(name) for name in inputs]
        return StateSpace(self.a[np.ix_(rows, rows)], self.b[np.ix_(rows, columns)], tuple(states), tuple(inputs))

    def slope(self, state: str, by: str) -> float:
        """Partial derivative d(state') / d(by), by a state or an input: an element of A or B [unit of state / s / by]."""
        row = self.states.index(state)
        return float(self.a[row, self.states.index(by)] if by in self.states else self.b[row, self.inputs.index(by)])

    def transfer(self, state: str, by: str, omega: Floats) -> NDArray[np.complex128]:
        """Frequency response (k,) of a state to an input at ``omega`` (k,) [rad/s]."""
        column = self.b[:, self.inputs.index(by)]
        resolvent = 1j * omega[:, None, None] * np.eye(len(self.a)) - self.a
        found = np.linalg.solve(resolvent, np.broadcast_to(column, (len(omega), len(column)))[..., None])
        return np.asarray(found[:, self.states.index(state), 0], dtype=np.complex128)

    def response(self, inputs: Floats, dt: float) -> Floats:
        """States (k + 1, n) from rest under inputs (k, m), each held for ``dt`` [s]; exact."""
        a, b, *_ = cont2discrete((self.a, self.b, np.eye(len(self.a)), np.zeros_like(self.b)), dt)
        states = np.zeros((len(inputs) + 1, len(self.a)))
        for k, held in enumerate(inputs):
            states[k + 1] = a @ states[k] + b @ held
        return states


def jacobian(function: Callable[[Floats], Floats], at: ArrayLike, steps: ArrayLike) -> Floats:
    """Jacobian (m, n) of a function (n,) -> (m,) at ``at`` (n,) by central differences with ``steps`` (n,)."""
    at = np.asarray(at, dtype=np.float64)
    moves = np.diag(np.asarray(steps, dtype=np.float64))
    return np.column_stack([(function(at + move) - function(at - move)) / (2 * move.sum()) for move in moves])
