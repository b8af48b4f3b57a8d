"""Pages that come late or do not keep up: neither holds up those who look already."""

import asyncio
import time
from contextlib import closing

import numpy as np
import pytest

from schemas.messages import ArmRequest
from tests.browser.canvas import POSITION, TRACK, until
from tests.browser.conftest import opened
from tests.services.gcs.scripted import UAV, UGV
from tests.services.gcs.wire import Browser, decode
from tests.services.gcs.wire import until as waits_for

pytestmark = pytest.mark.timeout(240)

DAYS = 60_000_000  # messages: forty hours of this station

STALL = 3.0  # s: without the jump over what is gone, who joins waits for three times that


class Listener(Browser):
    """Notes when it is sent something, and whether it has all that was said before it came."""

    replayed = False

    async def _read(self):
        self.times = [time.monotonic()]
        async for batch in self._socket:
            self.times.append(time.monotonic())
            for message in decode(batch):
                self._take(message)
                self.replayed |= message["type"] == "ReplayDoneMessage"

    @property
    def longest_silence(self):
        return max(np.diff([*self.times, time.monotonic()]))


class SlowBrowser(Browser):
    """Takes its time over each batch, and says of nothing that it has seen it."""

    async def _read(self):
        async for batch in self._socket:
            await asyncio.sleep(0.5)
            for message in decode(batch):
                self._take(message)

    def close(self):
        self._loop.call_soon_threadsafe(self._reading.cancel)
        super().close()


def moves(page):
    """Whether the aircraft is drawn where it was not before."""
    before = page.evaluate(POSITION, f"/vehicles/{UAV}")
    return until(page, lambda: page.evaluate(POSITION, f"/vehicles/{UAV}") != before)


def test_a_page_that_joins_after_days_has_all_of_it_and_holds_up_nobody(browser, station):
    with closing(Listener(station.port)) as other:
        station.page._server._websock_server._broadcast_buffer.message_counter = DAYS
        with opened(browser, station.port, f"/vehicles/{UGV}/0", (700, 400)) as late:
            assert until(late, lambda: late.evaluate(TRACK, UGV) > 0 and late.evaluate(TRACK, UAV) > 0)
            assert moves(late)
        with closing(Listener(station.port)) as another:
            assert waits_for(lambda: another.replayed, STALL)
        assert other.longest_silence < STALL


def test_a_slow_page_holds_up_nobody_and_is_refused_what_cannot_be_undone(page, station):
    with closing(Listener(station.port)) as other, closing(SlowBrowser(station.port)) as slow:
        assert until(page, lambda: any(kind["kind"] == "GuiTextMessage" for kind in list(slow.elements.values())))
        page.wait_for_timeout(2500)  # until what it shows is older than that
        for _ in range(2):
            slow.say("command", UAV, "disarm")
        assert until(page, lambda: "s old: wait until it is live" in page.inner_text("#gcs"))
        assert moves(page) and other.longest_silence < STALL
    assert not [message for _, message in station.script.asked if isinstance(message, ArmRequest)]
