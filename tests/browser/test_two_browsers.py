"""Two people, two real browsers: each sees the vehicle that he has chosen, and what he asks for goes there."""

from contextlib import closing, contextmanager

import pytest

from schemas.messages import ArmRequest, ModeRequest
from tests.browser.canvas import until
from tests.browser.conftest import opened, staged
from tests.second_try import Shared
from tests.services.gcs.scripted import UAV, UGV

pytestmark = pytest.mark.timeout(240)


@contextmanager
def staged_for_two(browser):
    """(station, page, other page)"""
    with staged(browser) as (station, page), opened(browser, station.port, f"/vehicles/{UAV}/0", (900, 600)) as other:
        yield station, page, other


@pytest.fixture(scope="module")
def stage(browser):
    """One station and two pages for all tests."""
    with closing(Shared(lambda: staged_for_two(browser))) as stage:
        yield stage


@pytest.fixture
def other(staging):
    return staging[2]


def choose(page, vehicle):
    page.get_by_role("button", name=f"Select {vehicle}").click()
    page.locator("#gcs-drive" if vehicle == UGV else "#gcs-pfd").wait_for(timeout=40_000)


def asked(station, kind):
    return [name for name, message in station.script.asked if isinstance(message, kind)]


def test_each_sees_and_commands_his_own(page, other, station):
    choose(page, UGV)
    choose(other, UAV)
    assert page.locator("#gcs-drive").is_visible() and not page.locator("#gcs-pfd").count()
    page.get_by_role("button", name="Hold", exact=True).click()
    assert until(page, lambda: asked(station, ModeRequest) == [UGV])
    other.get_by_role("button", name="Hold", exact=True).click()
    assert until(other, lambda: asked(station, ModeRequest) == [UGV, UAV])
    page.get_by_role("button", name=f"Disarm {UGV}", exact=True).click()
    page.get_by_role("button", name=f"Confirm: disarm {UGV}").wait_for(timeout=20_000)
    assert not other.get_by_role("button", name="Confirm").count()
    assert asked(station, ArmRequest) == []


VISIBLE = "(name) => window.__viserSceneTree.getState()[name]?.effectiveVisibility"


def test_each_hides_layers_for_itself(page, other, station):
    label = f"/label/{UGV}"
    assert until(page, lambda: page.evaluate(VISIBLE, label) and other.evaluate(VISIBLE, label))
    other.get_by_text("Layers", exact=True).click()
    other.get_by_label("Labels").uncheck()
    assert until(other, lambda: other.evaluate(VISIBLE, label) is False)
    assert page.evaluate(VISIBLE, label) is True
    page.get_by_text("Layers", exact=True).click()
    assert page.get_by_label("Labels").is_checked()
    page.get_by_label("True pose").check()
    ghost = f"/true/{UAV}/0"
    assert until(page, lambda: page.evaluate(VISIBLE, ghost))
    assert until(other, lambda: other.evaluate(VISIBLE, ghost) is False)
    other.get_by_label("Labels").check()
    assert until(other, lambda: other.evaluate(VISIBLE, label))


@pytest.mark.parametrize("silent", [0, 5000], ids=["at once", "late"])
def test_who_loses_the_connection_sees_the_same_vehicle_again(page, other, station, silent):
    """silent [ms]: for so long the ground station shows nothing to who is connected again."""
    choose(page, UGV)
    choose(other, UAV)
    before = set(station.service._model.sessions)
    station.living = not silent
    station.page._server._websock_server.disconnect_all_clients()
    page.wait_for_timeout(silent)
    station.living = True
    assert until(page, lambda: len(station.service._model.sessions) == 2 and not before & set(station.service._model.sessions))
    assert until(other, lambda: sorted(s.vehicle for s in station.service._model.sessions.values()) == sorted((UGV, UAV)))
    other.locator("#gcs-pfd").wait_for(timeout=40_000)
    page.locator("#gcs-drive").wait_for(timeout=40_000)
