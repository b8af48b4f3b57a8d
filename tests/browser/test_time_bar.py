"""The time bar in a real browser: back and forth by pointer and keys, and a minute as a file that plays without a server."""

import pytest

from services.gcs.page.viser_replay import write_replay
from tests.services.gcs.recorded import demo_log

WHERE = "name => window.__viserMutable?.nodePoseData[name]?.position"
FAR = f"([name, from, least]) => Math.hypot(...(({WHERE})(name) ?? from).map((c, i) => c - from[i])) > least"
LIVE = "() => !document.querySelector('#gcs .g-then')"
HIDDEN = "() => (node => (node.overrideVisibility ?? node.visibility) === false)(window.__viserSceneTree.getState()['/vehicles'])"
BURGER, THEN, MILVUS = "/vehicles/burger", "/past/vehicles/burger", "/vehicles/milvus"
TWELVE = "() => Number(document.querySelector('#gcs .g-moment b')?.textContent.slice(-2)) >= 12"


@pytest.fixture
def past(page, station):
    """A page that looks at ten seconds ago."""
    page.wait_for_function(TWELVE, timeout=60_000)
    page.get_by_role("button", name="↶ 10 s").click()
    page.wait_for_function(WHERE, arg=THEN, timeout=30_000)
    yield page
    page.get_by_role("button", name="● LIVE").click()
    page.wait_for_function(LIVE, timeout=30_000)


def test_the_past_stands_still_while_the_present_goes_on(past):
    then, now = past.evaluate(WHERE, THEN), past.evaluate(WHERE, BURGER)
    past.wait_for_function(FAR, arg=[BURGER, now, 0.3])
    assert past.evaluate(WHERE, THEN) == then
    assert past.evaluate(HIDDEN)


def test_it_plays_and_is_moved_by_keys(past):
    then = past.evaluate(WHERE, THEN)
    past.get_by_role("button", name="Play").click()
    past.wait_for_function(FAR, arg=[THEN, then, 0.2])
    past.get_by_role("button", name="Hold").click()
    before = past.locator(".g-moment i").text_content()
    past.get_by_role("slider", name="Time shown, seconds before now").press("ArrowLeft")
    past.wait_for_function("before => document.querySelector('.g-moment i')?.textContent != before", arg=before)


def test_a_kept_minute_opens_from_a_file_and_moves(browser, tmp_path):
    write_replay(demo_log(tmp_path), tmp_path / "page.html")
    page = browser.new_page(viewport={"width": 1200, "height": 700})
    errors, asked = [], []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.goto((tmp_path / "page.html").as_uri())
    page.wait_for_function(FAR, arg=[MILVUS, [0, 0, 0], 1], timeout=90_000)
    page.wait_for_function(FAR, arg=[MILVUS, page.evaluate(WHERE, MILVUS), 20], timeout=60_000)
    page.wait_for_function("() => document.querySelectorAll('#gcs .g-card').length == 2")
    page.wait_for_function("() => document.querySelector('#gcs .g-card[data-name=milvus]').textContent.includes('MISSION')")
    assert errors == []
    assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
    page.close()
