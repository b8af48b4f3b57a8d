"""The page on a real viser server, heard by a websocket client without a browser."""

import asyncio
import http.client
import time
import warnings
from dataclasses import replace

import numpy as np
import pytest
import websockets

from services.gcs.actions.page import Join, Leave, Select, Shape, StopAll, TakeWheel
from services.gcs.page.viser_page import ViserPage
from services.gcs.page.words import action_in
from services.gcs.state.vehicle_model import DisplayPose
from services.gcs.view.controls import button
from services.gcs.view.drawing import CameraView, PagePanel, Picture, Points, Polyline
from services.gcs.view.markup import html
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import UAV
from tests.services.gcs.wire import Browser, connect, free_port, join, until
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.address import Address

CAMERA = CameraView((0.0, -20.0, 10.0), (0.0, 0.0, 0.0))


@pytest.fixture
def page():
    port = free_port()
    page = ViserPage(Address(port=port), CAMERA, {})
    page.port = port
    yield page
    page.close()


def of_type(messages, *types):
    return [m for m in messages if m["type"] in types]


def names(messages):
    return {m["name"] for m in messages if "name" in m and "props" in m}


@pytest.fixture
def browser(page):
    browser = Browser(page.port)
    browser.page = wait_for_actions(page)[0].page
    assert until(lambda: browser.elements)
    yield browser
    browser.close()


def test_a_late_joiner_gets_the_whole_picture(page):
    station = Station()
    station.run(3.0)
    page.show(station.page.pictures[-1])
    messages = join(page.port)
    assert station.page.now.nodes.keys() <= names(messages)
    places = {m["name"]: m["position"] for m in of_type(messages, "SetPositionMessage")}
    assert places[f"/vehicles/{UAV}"] == pytest.approx(station.page.now.places[f"/vehicles/{UAV}"].position)


def test_a_browser_gets_its_own_panel_and_the_field_to_speak_through(page, browser):
    station = Station()
    station.run(3.0)
    shown = station.page.pictures[-1]
    page.show(replace(shown, panels={browser.page: shown.panels[ME]}))
    assert until(lambda: {"■ STOP ALL", "Hold", "Mission", "Manual", "Disarm burger"} <= browser.labels())
    assert until(lambda: "gcs-drive" in browser.html() and "Select burger" in browser.html())
    assert f"data-bridge='{browser.bridge}'" in browser.html()


def test_another_browser_gets_none_of_it(page, browser):
    line = Polyline(np.zeros((3, 3)), (1, 2, 3))
    page.show(Picture(panels={browser.page: PagePanel({"facts": html("mine")}, {"/own/way": line})}))
    assert until(lambda: "mine" in browser.html())
    assert "mine" not in str(join(page.port)) and "/own/way" not in str(join(page.port))


def test_who_goes_is_told_of_and_forgotten(page):
    browser = Browser(page.port)
    (joined,) = wait_for_actions(page)
    page.show(Picture(panels={joined.page: PagePanel()}))
    assert isinstance(joined, Join) and joined.page in page._panels
    browser.close()
    assert wait_for_actions(page) == [Leave(joined.page)]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        page.show(Picture(panels={joined.page: PagePanel()}))
    assert not page._panels


def test_only_changes_are_sent(page):
    station = Station()
    station.run(3.0)
    page.show(station.page.pictures[-1])
    buffer = page._server._websock_server._broadcast_buffer
    before = buffer.message_counter
    page.show(station.page.pictures[-1])
    assert buffer.message_counter == before
    station.run(0.05)
    page.show(station.page.pictures[-1])
    assert 0 < buffer.message_counter - before < 40


def test_what_is_no_longer_shown_goes_away(page):
    line = Polyline(np.zeros((3, 3)), (1, 2, 3))
    place = DisplayPose(np.zeros(3), np.array((1.0, 0, 0, 0)))
    page.show(Picture({"/track/x": line, "/vehicles/x/0": line}, {"/vehicles/x": place}))
    assert {"/track/x", "/vehicles/x/0"} <= names(join(page.port))
    page.show(Picture())
    assert not {"/track/x", "/vehicles/x/0", "/vehicles/x"} & names(join(page.port))
    page.show(Picture({"/vehicles/x/0": line}, {"/vehicles/x": place}))
    assert "/vehicles/x/0" in names(join(page.port))


def test_a_longer_line_and_other_points_replace_the_old_ones(page):
    for n in (3, 5):
        nodes = {"/a": Polyline(np.arange(3.0 * n).reshape(n, 3), (1, 2, 3)), "/b": Points(np.ones((n, 3)), (4, 5, 6), 0.1)}
        page.show(Picture(nodes))
    messages = join(page.port)
    lines = [m for m in messages if m.get("name") == "/a" and m["type"] in ("LineSegmentsMessage", "SceneNodeUpdateMessage")]
    assert "updates" in lines[-1] and set(lines[-1]["updates"]) == {"points"}
    assert len(of_type([m for m in messages if m.get("name") == "/b"], "PointCloudMessage")) == 1


def wait_for_actions(page):
    deadline = time.monotonic() + 5
    while time.monotonic() < deadline:
        if actions := page.actions():
            return actions
        time.sleep(0.01)
    return []


def test_a_button_says_its_word_for_the_browser_that_it_is_in(page, browser):
    page.show(Picture(panels={browser.page: PagePanel({"stop": button("STOP", "stop")})}))
    assert until(lambda: browser.labels() == {"STOP"})
    browser.press("STOP")
    assert wait_for_actions(page) == [StopAll(browser.page)]


def test_what_a_browser_says_counts_for_itself_whatever_it_says(page, browser):
    browser.say("take-wheel", "burger")
    assert wait_for_actions(page) == [TakeWheel(browser.page, "burger")]
    browser.say("select", "milvus")
    assert wait_for_actions(page) == [Select(browser.page, "milvus")]
    browser.say("page", 7)
    browser.say("stop", 7)
    browser.say("stop")
    assert wait_for_actions(page) == [StopAll(browser.page)]


def test_only_the_slots_that_have_changed_are_sent_again(page, browser):
    slots = {"facts": html("one"), "fleet": html("two")}
    page.show(Picture(panels={browser.page: PagePanel(slots)}))
    page.show(Picture(panels={browser.page: PagePanel(slots | {"facts": html("three")})}))
    assert until(lambda: "three" in browser.html())
    assert "one" not in browser.html() and "two" in browser.html()


def test_a_foreign_page_is_kept_out(page):
    async def opens(origin):
        try:
            async with connect(page.port, origin=origin):
                return True
        except websockets.InvalidStatus as refusal:
            return refusal.response.status_code

    assert asyncio.run(opens("http://evil.example")) == 403
    assert asyncio.run(opens(f"http://127.0.0.1:{page.port}")) is True


def test_health_and_page_are_served(page):
    def get(path):
        connection = http.client.HTTPConnection("127.0.0.1", page.port, timeout=5)
        connection.request("GET", path)
        response = connection.getresponse()
        return response.status, response.read()

    assert get("/healthz") == (200, b'{"status": "ok"}')
    status, body = get("/")
    assert status == 200 and b'<div id="root"></div><div id="gcs">' in body and b"/gcs/main.js" in body
    for script in ("main.js", "link.js", "morph.js", "tabs.js", "driving.js", "scene.js", "theme.css", "layout.css", "parts.css"):
        status, body = get(f"/gcs/{script}")
        assert status == 200 and body
    assert get("/gcs/../guard.py")[0] != 200 and get("/gcs/shell.html")[0] != 200


def test_no_other_page_may_frame_it(page):
    connection = http.client.HTTPConnection("127.0.0.1", page.port, timeout=5)
    connection.request("GET", "/")
    assert "frame-ancestors 'none'" in connection.getresponse().headers["Content-Security-Policy"]


def test_a_second_page_on_the_same_port_says_so(page):
    with pytest.raises(BadInput, match=f"{page.port}.*UVF_GCS_PORT"):
        ViserPage(Address(port=page.port), CAMERA, {})


def test_a_closed_page_frees_its_port_for_the_next():
    port = free_port()
    for _ in range(2):
        page = ViserPage(Address(port=port), CAMERA, {})
        assert names(join(port))
        page.close()


@pytest.mark.parametrize("said", ["nonsense", "[]", '{"a": 1}', "[1]", '["stop"]', '[1, "arm", "burger"]', '[1, "stop", true]', "[" * 2000])
def test_a_page_can_say_no_more_than_it_needs_to(said):
    assert action_in(said, 1) is None


@pytest.mark.parametrize(
    ("said", "shape"),
    [
        ('[1, "shape", 0.87, false]', Shape(1, 0.87, False)),
        ('[1, "shape", 1.5, true]', Shape(1, 1.5, True)),
        ('[1, "shape", 0, false]', None),
        ('[1, "shape", NaN, false]', None),
        ('[1, "shape", "x", false]', None),
        ('[1, "shape", 1.5, 1]', None),
    ],
)
def test_a_page_tells_the_shape_of_its_window(said, shape):
    assert action_in(said, 1) == shape


def test_a_browser_that_goes_while_it_is_written_to_ends_nothing(page, browser):
    """viser's own thread takes away what it had, and refuses to write to it."""
    panel = page._panels[browser.page]
    page.show(Picture(panels={browser.page: PagePanel(html={"instrument": html("first")})}))
    panel._slots["instrument"]._impl.removed = True
    page.show(Picture(panels={browser.page: PagePanel(html={"instrument": html("late")})}))
    panel._slots["instrument"]._impl.removed = False
    page.show(Picture(panels={browser.page: PagePanel(html={"instrument": html("there")})}))
    assert until(lambda: "there" in browser.html(), 10.0)
