"""Pages that come late or do not keep up: neither holds up those who look already."""

import asyncio
from contextlib import closing

import pytest

from schemas.messages import ArmRequest
from tests.browser.canvas import POSITION, TRACK, until
from tests.browser.conftest import opened
from tests.services.gcs.scripted import UAV, UGV
from tests.services.gcs.wire import Browser, decode

pytestmark = pytest.mark.timeout(240)

DAYS = 60_000_000  # messages: forty hours of this station

WATCH = """() => {
  window.wasDead = false;
  setInterval(() => { window.wasDead ||= !document.getElementById('gcs-dead').hidden; }, 50);
}"""
DEAD = "() => window.wasDead"


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


def test_a_page_that_joins_after_days_has_all_of_it_and_holds_up_nobody(page, browser, station):
    page.evaluate(WATCH)
    station.page._server._websock_server._broadcast_buffer.message_counter = DAYS
    assert moves(page)
    with opened(browser, station.port, f"/vehicles/{UGV}/0", (700, 400)) as late:
        assert late.evaluate(TRACK, UGV) > 0 and late.evaluate(TRACK, UAV) > 0
        assert moves(late) and moves(page)
    assert not page.evaluate(DEAD)


def test_a_slow_page_holds_up_nobody_and_is_refused_what_cannot_be_undone(page, station):
    page.evaluate(WATCH)
    with closing(SlowBrowser(station.port)) as slow:
        assert until(page, lambda: any(kind["kind"] == "GuiTextMessage" for kind in list(slow.elements.values())))
        page.wait_for_timeout(2500)  # until what it shows is older than that
        for _ in range(2):
            slow.say("command", UAV, "disarm")
        assert until(page, lambda: "s old: wait until it is live" in page.inner_text("#gcs"))
        assert moves(page) and not page.evaluate(DEAD)
    assert not [message for _, message in station.script.asked if isinstance(message, ArmRequest)]
