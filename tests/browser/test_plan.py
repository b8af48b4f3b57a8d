"""The tab Plan in a real browser: a waypoint is added with two clicks, dragged over the scene, and flown ahead."""

import pytest

from schemas.messages import MissionRequest
from tests.browser.canvas import on_screen, until
from tests.services.gcs.scripted import UAV

pytestmark = pytest.mark.timeout(240)


@pytest.fixture
def planning(page):
    page.get_by_role("button", name="Select milvus").click()
    page.get_by_role("tab", name="Plan").click()
    page.get_by_role("button", name="All", exact=True).click()
    page.locator(".g-handle").nth(3).wait_for(timeout=20_000)
    page.wait_for_timeout(1500)  # the view glides to its place
    return page


def draft(station):
    return station.service._model.vehicles[UAV].draft


def test_a_waypoint_is_added_where_it_is_clicked_and_dragged_elsewhere(planning, station):
    page = planning
    page.mouse.click(*on_screen(page, (60.0, 40.0, 0.0)))
    page.get_by_role("button", name="Add waypoint").click()
    assert until(page, lambda: len(draft(station).items) == 6)
    added = draft(station).items[4].position
    assert (added.x, added.y) == pytest.approx((60.0, 40.0), abs=3.0)
    handle = page.get_by_role("button", name="Item 5 of milvus")
    handle.wait_for(timeout=20_000)
    page.mouse.move(*on_screen(page, (added.x, added.y, added.z)))
    page.mouse.down()
    page.mouse.move(*on_screen(page, (-80.0, 20.0, added.z)), steps=5)
    page.mouse.up()
    assert until(page, lambda: (added.x, added.y) == pytest.approx((-80.0, 20.0), abs=4.0)), (added.x, added.y)
    handle.focus()
    handle.press("Shift+ArrowUp")
    assert until(page, lambda: added.y == pytest.approx(30.0, abs=4.0)), added.y
    assert not [m for _, m in station.script.asked if isinstance(m, MissionRequest)]


def test_figures_are_written_while_the_page_goes_on(planning, station):
    height = planning.get_by_role("spinbutton", name="z of item 1", exact=True)
    height.click()
    height.fill("7")
    planning.wait_for_timeout(1500)  # the page draws on: what is half written stays
    height.press("End")
    height.type("5")
    assert height.input_value() == "75"
    height.press("Enter")
    assert until(planning, lambda: draft(station).items[0].position.z == 75.0)


def test_the_flown_path_is_drawn(planning):
    flown = "() => window.__viserSceneTree.getState()['/own/flown']?.message.props.points.length || 0"
    assert until(planning, lambda: planning.evaluate(flown) > 100)
    planning.get_by_role("tab", name="Fly").click()
    assert until(planning, lambda: planning.evaluate(flown) == 0)


def test_keys_choose_look_and_stop(page, station):
    page.locator("body").press("2")
    page.locator("#gcs-bar .g-shown[data-name=milvus]").wait_for(state="attached", timeout=20_000)
    page.locator("body").press("t")
    page.get_by_role("button", name="Top", exact=True, pressed=True).wait_for(timeout=20_000)
    page.locator("body").press("Shift+Escape")
    assert until(page, lambda: station.script.stops and station.script.stops[-1].engaged)
    page.get_by_role("button", name="Release STOP").click()
    assert until(page, lambda: not station.script.stops[-1].engaged)
