"""The page on a real viser server, heard by a websocket client without a browser."""

import asyncio
import http.client
import time
import warnings
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import websockets

from services.gcs.actions import Join, Leave, Select, SetMode, StopAll, TakeWheel
from services.gcs.page.viser_page import ViserPage
from services.gcs.page.viser_script import action_in, shape_in
from services.gcs.state.state import DisplayPose
from services.gcs.view.cameras import cameras
from services.gcs.view.drawing import Button, PagePanel, Picture, Points, Polyline
from services.gcs.view.markup import html
from tests.services.gcs.fakes import ME, Station
from tests.services.gcs.scripted import UAV, demo_site
from tests.services.gcs.wire import Browser, connect, free_port, join, until
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.address import Address


@pytest.fixture
def page():
    port = free_port()
    site = demo_site()
    page = ViserPage(Address(port=port), partial(cameras, site))
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
    assert {m["props"]["label"] for m in of_type(messages, "GuiButtonMessage")} == {"STOP ALL", "Release STOP"}


def test_a_browser_gets_its_own_panel_and_its_own_script(page, browser):
    station = Station()
    station.run(3.0)
    shown = station.page.pictures[-1]
    page.show(replace(shown, panels={browser.page: shown.panels[ME]}))
    assert until(lambda: {"STOP ALL", "Release STOP", "Hold", "Mission", "Manual", "Disarm burger"} == browser.labels())
    assert until(lambda: "gcs-drive" in browser.html() and "Select burger" in browser.html() and "gcs-bar-source" in browser.html())
    assert len(browser.scripts) == 1


def test_another_browser_gets_none_of_it(page, browser):
    page.show(
        Picture(panels={browser.page: PagePanel("burger", {"facts": html("mine")}, [Button("b", "Hold", SetMode("burger", "Hold"))])})
    )
    assert until(lambda: "mine" in browser.html() and browser.labels() == {"Hold"})
    assert "mine" not in str(join(page.port)) and "Hold" not in str(join(page.port))


def test_who_goes_is_told_of_and_forgotten(page):
    browser = Browser(page.port)
    (joined,) = wait_for_actions(page)
    page.show(Picture(panels={joined.page: PagePanel("burger")}))
    assert isinstance(joined, Join) and joined.page in page._panels
    browser.close()
    assert wait_for_actions(page) == [Leave(joined.page)]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        page.show(Picture(panels={joined.page: PagePanel("burger")}))
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


def test_a_button_asks_for_what_it_is_now(page, browser):
    page.show(Picture(buttons=[Button("b", "Hold", SetMode("burger", "Hold"))]))
    page.show(Picture(buttons=[Button("b", "STOP", StopAll(True), lit=True, colour="red")]))
    assert until(lambda: browser.labels() == {"STOP"})
    browser.press("STOP")
    assert wait_for_actions(page) == [StopAll(True)]


def test_a_greyed_out_button_asks_for_nothing_whoever_presses_it(page, browser):
    page.show(Picture(buttons=[Button("b", "Release", StopAll(False), enabled=False), Button("c", "STOP", StopAll(True))]))
    assert until(lambda: len(browser.labels()) == 2)
    browser.press("Release")
    browser.press("STOP")
    assert wait_for_actions(page) == [StopAll(True)]


def test_what_a_browser_says_counts_for_itself_and_for_what_it_is_shown(page, browser):
    page.show(Picture(panels={browser.page: PagePanel("burger")}))
    assert until(lambda: browser.scripts)
    browser.say("wheel:on")
    assert wait_for_actions(page) == [TakeWheel(browser.page, "burger")]
    browser.say("select:milvus")
    assert wait_for_actions(page) == [Select(browser.page, "milvus")]


def test_a_button_that_is_gone_is_gone(page):
    page.show(Picture(buttons=[Button("b", "Hold", SetMode("burger", "Hold"))]))
    page.show(Picture())
    assert "Hold" not in {m["props"]["label"] for m in of_type(join(page.port), "GuiButtonMessage")}


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
    assert status == 200 and b"<html" in body.lower()


def test_a_second_page_on_the_same_port_says_so(page):
    with pytest.raises(BadInput, match=f"{page.port}.*UVF_GCS_PORT"):
        ViserPage(Address(port=page.port), partial(cameras, demo_site()))


def test_a_closed_page_frees_its_port_for_the_next():
    port, site = free_port(), demo_site()
    for _ in range(2):
        page = ViserPage(Address(port=port), partial(cameras, site))
        assert names(join(port))
        page.close()


@pytest.mark.parametrize("said", ["nonsense", "[]", '{"a": 1}', "[1]", '["arm:burger"]', '["stop:burger"]'])
def test_a_page_can_say_no_more_than_it_needs_to(said):
    assert action_in(said, 1, "burger") is None


@pytest.mark.parametrize(
    ("said", "shape"),
    [
        ('["shape:0.87", 1]', (0.87, True)),
        ('["hand:1.5", 1]', (1.5, False)),
        ('["shape:0", 1]', None),
        ('["shape:nan", 1]', None),
        ('["shape:x"]', None),
        ('["select:burger"]', None),
    ],
)
def test_a_page_tells_the_shape_of_its_window(said, shape):
    assert shape_in(said) == shape


def test_a_browser_that_goes_while_it_is_written_to_ends_nothing(page, browser):
    """viser's own thread takes away what it had, and refuses to write to it."""
    panel = page._panels[browser.page]
    panel._html["instrument"]._impl.removed = True
    page.show(Picture(panels={browser.page: PagePanel(html={"instrument": html("late")})}))
    panel._html["instrument"]._impl.removed = False
    page.show(Picture(panels={browser.page: PagePanel(html={"instrument": html("there")})}))
    assert until(lambda: "there" in browser.html(), 10.0)
