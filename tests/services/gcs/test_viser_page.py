"""The page on a real viser server, heard by a websocket client without a browser."""

import asyncio
import http.client
import json
import time
from functools import partial

import numpy as np
import pytest
import websockets

from services.gcs.cameras import cameras
from services.gcs.commands import SetMode, StopAll
from services.gcs.drawing import Button, Picture, Points, Polyline
from services.gcs.state import Model, Placed
from services.gcs.viser_page import ViserPage
from services.gcs.viser_script import action_in, shape_in
from tests.services.gcs.fakes import Station
from tests.services.gcs.scripted import UAV, demo_site
from tests.services.gcs.wire import connect, free_port, join
from uvf.runtime.address import Address
from uvf.runtime.params import BadInput


@pytest.fixture
def page():
    port = free_port()
    site = demo_site()
    page = ViserPage(Address(port=port), partial(cameras, site), Model(site).layers)
    page.port = port
    yield page
    page.close()


def of_type(messages, *types):
    return [m for m in messages if m["type"] in types]


def names(messages):
    return {m["name"] for m in messages if "name" in m and "props" in m}


def test_a_late_joiner_gets_the_whole_picture(page):
    station = Station()
    station.run(3.0)
    page.show(station.page.now)
    messages = join(page.port)
    assert station.page.now.nodes.keys() <= names(messages)
    places = {m["name"]: m["position"] for m in of_type(messages, "SetPositionMessage")}
    assert places[f"/vehicles/{UAV}"] == pytest.approx(station.page.now.places[f"/vehicles/{UAV}"].position)
    labels = {m["props"]["label"] for m in of_type(messages, "GuiButtonMessage")}
    assert {"STOP ALL", "Release STOP", "Hold", "Mission", "Manual", "Disarm burger"} <= labels
    html = json.dumps(of_type(messages, "GuiHtmlMessage", "GuiUpdateMessage"), default=str)
    assert "gcs-drive" in html and "Select burger" in html and "gcs-bar-source" in html


def test_only_changes_are_sent(page):
    station = Station()
    station.run(3.0)
    page.show(station.page.now)
    buffer = page._server._websock_server._broadcast_buffer
    before = buffer.message_counter
    page.show(station.page.now)
    assert buffer.message_counter == before
    station.run(0.05)
    page.show(station.page.now)
    assert 0 < buffer.message_counter - before < 40


def test_what_is_no_longer_shown_goes_away(page):
    line = Polyline(np.zeros((3, 3)), (1, 2, 3))
    place = Placed(np.zeros(3), np.array((1.0, 0, 0, 0)))
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


def press(page, label):
    button = next(handle for handle, b in page._buttons.values() if b.label == label)
    join(page.port, {"type": "GuiUpdateMessage", "uuid": button._impl.uuid, "updates": {"value": True}})


def wait_for_actions(page):
    deadline = time.monotonic() + 5
    while time.monotonic() < deadline:
        if actions := page.actions():
            return actions
        time.sleep(0.01)
    return []


def test_a_button_asks_for_what_it_is_now(page):
    page.show(Picture(buttons=[Button("b", "Hold", SetMode("Hold"))]))
    page.show(Picture(buttons=[Button("b", "STOP", StopAll(True), lit=True, colour="red")]))
    press(page, "STOP")
    assert wait_for_actions(page) == [StopAll(True)]


def test_a_button_that_is_gone_is_gone(page):
    page.show(Picture(buttons=[Button("b", "Hold", SetMode("Hold"))]))
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
        ViserPage(Address(port=page.port), partial(cameras, demo_site()), set())


def test_a_closed_page_frees_its_port_for_the_next():
    port, site = free_port(), demo_site()
    for _ in range(2):
        page = ViserPage(Address(port=port), partial(cameras, site), set())
        assert names(join(port))
        page.close()


@pytest.mark.parametrize("said", ["nonsense", "[]", '{"a": 1}', "[1]", '["arm:burger"]', '["stop:burger"]'])
def test_a_page_can_say_no_more_than_it_needs_to(said):
    assert action_in(said) is None


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
