"""The panels, checked by axe-core in light and dark, and walked through with the keyboard alone."""

from contextlib import closing

import pytest

from tests.browser.canvas import until
from tests.browser.conftest import LiveStation
from tests.services.gcs.scripted import UAV, UGV

pytestmark = pytest.mark.timeout(240)

TABS = {UGV: ("Drive", "Graph", "Log", "Run", "Help"), UAV: ("Fly", "Plan", "Plot")}
GRAVE = ("serious", "critical")
FOCUSED = "() => (document.activeElement.getAttribute('aria-label') || document.activeElement.textContent).trim()"


@pytest.fixture(scope="module")
def quiet():
    """A station in front of vehicles that stand still."""
    with closing(LiveStation()) as station:
        yield station


def shown(browser, station, theme, size):
    page = browser.new_page(viewport={"width": size[0], "height": size[1]}, color_scheme=theme)
    page.goto(f"http://127.0.0.1:{station.port}/")
    page.locator("#gcs .g-card").first.wait_for(timeout=60_000)
    return page


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_no_panel_has_a_serious_fault(browser, quiet, theme):
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    with closing(shown(browser, quiet, theme, (1440, 900))) as page:
        found = []
        for vehicle, tabs in TABS.items():
            page.get_by_role("button", name=f"Select {vehicle}").click()
            for tab in tabs:
                page.get_by_role("tab", name=tab).click()
                page.wait_for_timeout(700)  # the panel is drawn
                report = axe.run(page, "#gcs").response
                found += [(tab, v["id"], v["nodes"][0]["html"][:120]) for v in report["violations"] if v["impact"] in GRAVE]
        assert found == []


def test_a_newcomer_without_a_mouse_reaches_stop_vehicles_commands_and_tabs(browser, quiet):
    with closing(shown(browser, quiet, "light", (1200, 800))) as page:
        for name in ("Hold", "Disarm burger"):  # they are offered once the vehicle has spoken
            page.get_by_role("button", name=name, exact=True).wait_for()
        reached = []
        for _ in range(40):
            page.keyboard.press("Tab")
            reached.append(page.evaluate(FOCUSED))
        for name in ("■ STOP ALL", "Select burger", "Select milvus", "Hold", "Disarm burger", "Scene", "Drive"):
            assert name in reached, (name, reached)


def test_the_focus_stays_while_the_page_is_drawn_again(browser, quiet):
    with closing(shown(browser, quiet, "light", (1200, 800))) as page:
        card = page.get_by_role("button", name="Select milvus")
        card.focus()
        before = card.inner_text()
        assert until(page, lambda: card.inner_text() != before), "its figures do not change"
        assert page.evaluate("() => document.activeElement.dataset.name") == UAV


@pytest.mark.parametrize("width", [1024, 2560])
def test_nothing_is_cut_off_sideways(browser, quiet, width):
    with closing(shown(browser, quiet, "light", (width, 768))) as page:
        page.wait_for_timeout(1000)
        cut = """() => [...document.querySelectorAll('#gcs aside, #gcs .scroll, #gcs [role=tablist], #gcs .bar')]
          .filter(e => e.scrollWidth > e.clientWidth + 1).map(e => e.className || e.getAttribute('role'))"""
        for tab in ("Drive", "Plot", "Run", "Graph", "Help"):
            page.get_by_role("tab", name=tab).click()
            page.wait_for_timeout(500)
            assert page.evaluate(cut) == [], tab
