"""The tab Plot in a real browser: three actions from the blank tab to a curve that grows."""

import pytest

from tests.browser.canvas import until

pytestmark = pytest.mark.timeout(240)

POINTS = "() => [...document.querySelectorAll('.g-curve')].map(path => path.getAttribute('d').split('L').length)"


@pytest.fixture(autouse=True)
def plots(page):
    page.get_by_role("button", name="Select milvus").click()
    page.get_by_role("tab", name="Plot").click()


def test_a_preset_is_plotted_and_any_other_number_with_it(page, station):
    page.get_by_role("button", name="Attitude").click()
    assert until(page, lambda: min([*page.evaluate(POINTS), 0, 0][:2]) > 10), page.evaluate(POINTS)
    before = page.evaluate(POINTS)
    assert until(page, lambda: page.evaluate(POINTS)[0] > before[0])
    page.get_by_label("Topic to plot from").select_option("uvf/milvus/state/vehicle")
    page.get_by_role("button", name="+ throttle").click()
    page.locator(".g-legend li", has_text="state/vehicle throttle").get_by_text("0.54").wait_for(timeout=20_000)
    assert page.get_by_label("Topic to plot from").input_value() == "uvf/milvus/state/vehicle"


def test_a_number_is_searched_for_and_read_under_the_pointer(page, station):
    page.get_by_label("Search numbers").press_sequentially("airspeed nav")
    page.get_by_role("button", name="+ milvus/nav/state airspeed").click()
    curve = page.locator(".g-curve[data-name=airspeed]")
    assert until(page, lambda: curve.count() == 1 and "L" in curve.get_attribute("d"))
    chart = page.locator(".g-chart", has=curve)
    chart.scroll_into_view_if_needed()
    box = chart.bounding_box()
    page.mouse.move(box["x"] + box["width"] - 14, box["y"] + box["height"] / 2)
    assert until(page, lambda: "airspeed 24.30" in page.inner_text("#gcs-readout")), page.inner_text("#gcs-readout")
    page.mouse.move(box["x"] - 300, box["y"])
    assert until(page, page.locator("#gcs-readout").is_hidden)
    page.get_by_label("Search numbers").fill("")


def test_the_picture_is_held_and_goes_on(page, station):
    page.get_by_role("button", name="Attitude").click()
    page.get_by_role("button", name="❚❚ Hold").click()
    end = "() => document.querySelector('.g-chart').dataset.end"
    page.get_by_role("button", name="▶ Go on").wait_for(timeout=20_000)
    held = page.evaluate(end)
    page.wait_for_timeout(1500)
    assert page.evaluate(end) == held
    page.get_by_role("button", name="▶ Go on").click()
    assert until(page, lambda: page.evaluate(end) != held)
