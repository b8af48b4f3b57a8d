"""Camera pictures in a real browser: sent while they are seen, and the gimbal goes where a slider says."""

import io

import numpy as np
import pytest
from PIL import Image

from schemas import topics
from services.gcs.view.panels.vehicle.camera_panel import is_watched
from tests.browser.canvas import until
from tests.services.gcs.scripted import UAV

pytestmark = pytest.mark.timeout(240)

PICTURES = "() => [...document.querySelectorAll('img')].filter(i => i.getClientRects().length && i.naturalWidth === 240).length"


def jpeg(colour):
    stream = io.BytesIO()
    Image.fromarray(np.full((180, 240, 3), colour, dtype=np.uint8)).save(stream, format="JPEG")
    return stream.getvalue()


@pytest.fixture
def looking(page, station):
    """The page with the aircraft chosen, whose gimbal has sent a picture."""
    view = topics.VIEW.by("gimbal")
    station.script.put(UAV, view, view.message(data=jpeg((200, 40, 40)), format="jpeg"), station.t)
    page.get_by_role("button", name=f"Select {UAV}").click()
    page.locator("#gcs-cameras").wait_for(state="visible", timeout=40_000)
    return page


def sessions(station):
    return list(station.service._model.sessions.values())


def test_the_picture_comes_while_it_is_seen_and_costs_nothing_behind_another_tab(looking, station):
    assert until(looking, lambda: looking.evaluate(PICTURES) == 1)
    looking.get_by_role("tab", name="Log").click()
    assert until(looking, lambda: not any(is_watched(session, station.t) for session in sessions(station)))
    assert until(looking, lambda: looking.evaluate(PICTURES) == 0)
    looking.get_by_role("tab", name="Fly").click()
    assert until(looking, lambda: looking.evaluate(PICTURES) == 1)


def test_a_slider_steers_the_gimbal_of_the_chosen_aircraft(looking, station):
    pan, tilt = (looking.get_by_role("slider", name=f"{axis} of milvus") for axis in ("pan", "tilt"))
    for slider, key in ((pan, "ArrowRight"), (tilt, "ArrowRight"), (tilt, "ArrowRight")):
        slider.focus()
        slider.press(key)
    told = station.script.gimbals
    assert until(looking, lambda: told and (told[-1].pan, told[-1].tilt) == pytest.approx((np.radians(1), np.radians(2))))
