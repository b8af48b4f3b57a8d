"""The tab Plot in a real browser: three actions from the blank tab to a curve that grows."""

import pytest

from tests.browser.canvas import until

pytestmark = pytest.mark.timeout(240)

POINTS = "() => [...document.querySelectorAll('.g-curve')].map(path => path.getAttribute('d').split('L').length)"


def test_a_preset_is_plotted_and_any_other_number_with_it(page, station):
    page.get_by_role("button", name="Select milvus").click()
    page.get_by_role("tab", name="Plot").click()
    page.get_by_role("button", name="Attitude").click()
    assert until(page, lambda: min([*page.evaluate(POINTS), 0, 0][:2]) > 10), page.evaluate(POINTS)
    before = page.evaluate(POINTS)
    assert until(page, lambda: page.evaluate(POINTS)[0] > before[0])
    page.get_by_label("Topic to plot from").select_option("uvf/milvus/state/vehicle")
    page.get_by_role("button", name="+ throttle").click()
    page.locator(".g-legend li", has_text="state/vehicle throttle").get_by_text("0.54").wait_for(timeout=20_000)
    assert page.get_by_label("Topic to plot from").input_value() == "uvf/milvus/state/vehicle"


def test_the_picture_is_held_and_goes_on(page, station):
    page.get_by_role("button", name="Hold", exact=False).last.click()
    end = "() => document.querySelector('.g-chart').dataset.end"
    page.get_by_role("button", name="▶ Go on").wait_for(timeout=20_000)
    held = page.evaluate(end)
    page.wait_for_timeout(1500)
    assert page.evaluate(end) == held
    page.get_by_role("button", name="▶ Go on").click()
    assert until(page, lambda: page.evaluate(end) != held)
