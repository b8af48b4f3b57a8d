"""Three equations with three unknowns, for kernels: a general solver takes longer to compile than all else that they do."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]


@compiled
def solve(a: Floats, b: Floats) -> Floats:
    """Solution x (3,) of a x = b with b (3,) and a (3, 3), symmetric and positive definite.

    Cholesky without roots: Golub & Van Loan 2013, 4.1.
    """
    d0 = a[0, 0]
    l10, l20 = a[1, 0] / d0, a[2, 0] / d0
    d1 = a[1, 1] - l10 * a[1, 0]
    m21 = a[2, 1] - l20 * a[1, 0]
    l21 = m21 / d1
    d2 = a[2, 2] - l20 * a[2, 0] - l21 * m21
    y1 = b[1] - l10 * b[0]
    x = np.empty(3)
    x[2] = (b[2] - l20 * b[0] - l21 * y1) / d2
    x[1] = y1 / d1 - l21 * x[2]
    x[0] = b[0] / d0 - l10 * x[1] - l20 * x[2]
    return x
