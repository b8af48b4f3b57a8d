"""A process waits on its bus no longer than it wants to, whatever signals come."""

import signal
import time

import pytest

from tests.runtime.modes import free_port
from uvf.runtime.bus.zenoh_bus import ZenohBus, open_router


@pytest.fixture
def bus():
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    router = open_router(endpoint)
    with ZenohBus(endpoint, timeout=5.0) as bus:
        yield bus
    router.close()


def test_a_signal_that_outlasts_the_time_to_wait_ends_it(bus):
    """As a process that is told to end just then, and gets no processor for a moment."""
    before = signal.signal(signal.SIGALRM, lambda *_: time.sleep(0.1))
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.02)
        begun = time.monotonic()
        bus.wait(0.05)
        assert time.monotonic() - begun < 5.0
    finally:
        signal.signal(signal.SIGALRM, before)
