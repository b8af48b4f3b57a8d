"""Nobody but the operator's own page may speak to the port."""

import asyncio
import http.client

import pytest
import websockets
from websockets.asyncio.server import serve

from services.gcs.page.guard import Guard
from uvf.runtime.bus.address import is_loopback

HOST = {"Host": "127.0.0.1:8080"}


def test_the_own_page_may_pass():
    assert Guard(8080).answer("/", HOST) is None
    assert Guard(8080).answer("/", HOST | {"Origin": "http://127.0.0.1:8080", "Upgrade": "websocket"}) is None


@pytest.mark.parametrize("origin", ["http://evil.example", "http://127.0.0.1:9999", "null", "https://127.0.0.1.evil.example"])
def test_a_foreign_origin_is_refused(origin):
    assert Guard(8080).refuses("/", HOST | {"Origin": origin}) == "foreign Origin"


@pytest.mark.parametrize("host", ["evil.example", "evil.example:8080", "127.0.0.1.evil.example", ""])
def test_a_foreign_host_is_refused(host):
    assert Guard(8080).refuses("/", {"Host": host}) == "unknown Host"


@pytest.mark.parametrize("host", ["localhost:8080", "127.0.0.1", "[::1]:8080"])
def test_every_name_of_this_machine_will_do(host):
    assert Guard(8080).refuses("/", {"Host": host}) == ""


def test_a_token_is_asked_for_and_turned_into_a_cookie():
    guard = Guard(8080, token="secret")
    lan = {"Host": "robot.lan:8080"}
    assert guard.answer("/", lan).status_code == 403
    assert guard.answer("/?token=wrong", lan).status_code == 403
    redirect = guard.answer("/?token=secret", lan)
    assert (redirect.status_code, redirect.headers["Location"]) == (302, "/")
    assert "HttpOnly; SameSite=Strict" in redirect.headers["Set-Cookie"]
    assert guard.answer("/", lan | {"Cookie": "gcs=secret"}) is None
    assert guard.answer("/", lan | {"Cookie": "gcs=wrong"}).status_code == 403


def test_a_token_does_not_excuse_a_foreign_origin():
    guard = Guard(8080, token="secret")
    headers = {"Host": "robot.lan:8080", "Origin": "http://evil.example", "Cookie": "gcs=secret"}
    assert guard.answer("/", headers).status_code == 403


def test_health_is_told_to_anybody_but_a_page():
    assert Guard(8080, token="secret", health=lambda: b'{"vehicles": 2}').answer("/healthz", {"Host": "x"}).body == b'{"vehicles": 2}'
    assert Guard(8080).answer("/healthz", HOST | {"Origin": "http://evil.example"}).status_code == 403


@pytest.mark.parametrize(
    ("host", "loopback"), [("127.0.0.1", True), ("::1", True), ("localhost", True), ("0.0.0.0", False), ("robot", False)]
)
def test_knows_what_only_this_machine_can_reach(host, loopback):
    assert is_loopback(host) is loopback


async def _echo(socket):
    async for text in socket:
        await socket.send(text)


async def _opens(port, origin):
    try:
        async with websockets.connect(f"ws://127.0.0.1:{port}", origin=origin) as socket:
            await socket.send("hello")
            return await socket.recv() == "hello"
    except websockets.InvalidStatus as refusal:
        return refusal.response.status_code


def _get(port, headers):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=5)
    connection.request("GET", "/healthz", headers=headers)
    return connection.getresponse().status


def test_on_a_real_socket():
    async def run():
        async with serve(_echo, "127.0.0.1", 0, process_request=Guard(0).wrap(None)) as server:
            port = server.sockets[0].getsockname()[1]
            own, foreign, none = f"http://127.0.0.1:{port}", "http://evil.example", None
            answers = [await _opens(port, origin) for origin in (own, foreign, none)]
            return answers, await asyncio.to_thread(_get, port, {})

    assert asyncio.run(run()) == ([True, 403, True], 200)
