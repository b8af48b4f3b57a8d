"""Step times: step n of a service that runs at ``hz`` is due at round(n * 1e9 / hz) nanoseconds."""

NS = 1_000_000_000


def step_time(n: int, hz: float) -> int:
    """Due time [ns] of step ``n`` at ``hz`` [Hz]."""
    return round(n * NS / hz)


def first_step_after(t_ns: int, hz: float) -> int:
    """Smallest n whose due time at ``hz`` [Hz] is later than ``t_ns`` [ns]."""
    n = max(int(t_ns * hz / NS) - 1, 0)
    while step_time(n, hz) <= t_ns:
        n += 1
    return n


def last_step_until(t_ns: int, hz: float) -> int:
    """Largest n whose due time at ``hz`` [Hz] is not later than ``t_ns`` [ns]."""
    return first_step_after(t_ns, hz) - 1
