"""Machine-compiled kernels that keep their Python signature for the type checker."""

from collections.abc import Callable
from typing import ParamSpec, TypeVar, cast

from numba import njit

P = ParamSpec("P")
R = TypeVar("R")


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compiles a function with numba in nopython mode: cached on disk, without the interpreter lock, float division as in numpy."""
    return cast(Callable[P, R], njit(cache=True, nogil=True, error_model="numpy")(function))
