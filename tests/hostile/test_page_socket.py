"""Whatever a client sends to the page's socket: the page lives, serves the others, stays small, and commands nothing of its own."""

import asyncio
import contextlib
import json
import random
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import msgspec
import pytest
import websockets

from services.gcs.page.viser_socket import LARGEST, MOST_BROWSERS, is_sound
from tests.hostile.page_station import SILENT_FOR
from tests.services.gcs.wire import CAMERA, Browser, connect, free_port, until
from uvf.models.scenario import ROOT

pytestmark = pytest.mark.timeout(120)

SEED = 18
GROWTH = 60.0  # MB
UPGRADE = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
pack = msgspec.msgpack.encode


class Station:
    """The process, and what it has sent so far: STOPs, requests, drives, aims of the gimbal."""

    def __init__(self):
        self.port = free_port()
        command = [sys.executable, "-m", "tests.hostile.page_station", str(self.port)]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT)
        self.sent = ()
        threading.Thread(target=self._read, daemon=True).start()
        assert until(lambda: self.sent, 60), "the station does not start"

    def _read(self):
        for line in self.process.stdout:
            self.sent = tuple(map(int, line.split()))

    @property
    def megabytes(self):
        status = Path(f"/proc/{self.process.pid}/status").read_text(encoding="utf-8")
        return int(status.split("VmRSS:")[1].split()[0]) / 1024

    def close(self):
        self.process.terminate()
        self.process.wait(10)


@pytest.fixture(scope="module")
def station():
    with contextlib.closing(Station()) as station:
        yield station


@pytest.fixture
def good(station):
    """Somebody who only looks; whatever the others do, the page lives, goes on being his, and sends nothing of its own."""
    browser = Browser(station.port)
    assert until(lambda: "Disarm burger" in browser.labels(), 30)
    sent, size = station.sent, station.megabytes
    yield browser
    assert station.process.poll() is None
    shown = browser.html()
    assert browser.alive and until(lambda: browser.html() != shown, 10), "the page stands still"
    assert station.sent == sent, "something was sent that nobody could click"
    assert station.megabytes - size < GROWTH
    browser.close()


async def _send(port, payloads, pause=0.0):
    """Sends until all is sent or the page hangs up, from a client that has joined like a browser."""
    async with connect(port) as client:
        reading = asyncio.create_task(_drain(client))
        with contextlib.suppress(websockets.ConnectionClosed):
            for payload in (pack(CAMERA), *payloads):
                await client.send(payload)
                await asyncio.sleep(pause)
            await asyncio.sleep(0.3)
        await client.close()  # while it is still read: a full queue would keep the other end's goodbye out
        await reading


async def _drain(client):
    with contextlib.suppress(websockets.ConnectionClosed):
        async for _ in client:
            pass


def send(port, payloads, pause=0.0):
    asyncio.run(_send(port, payloads, pause))


def update(uuid, **updates):
    return {"type": "GuiUpdateMessage", "uuid": uuid, "updates": updates}


def click(**more):
    ray = {"ray_origin": (3.0, 2.0, 9.0), "ray_direction": (0.0, 0.0, -1.0)}
    return {"type": "ScenePointerMessage", "event_type": "click", **ray, "screen_pos": ((0.5, 0.5),), "modifier": None, **more}


KINDS = (
    *("GuiUpdateMessage", "GuiButtonHoldMessage", "GuiFormDirtyMessage", "GuiFormSubmitMessage", "FileTransferStartUpload"),
    *("FileTransferPart", "ShareUrlRequest", "ShareUrlDisconnect", "RunJavascriptMessage", "SetPositionMessage"),
    *("RemoveSceneNodeMessage", "TransformControlsUpdateMessage", "Message", "object"),
)
FIELDS = ("uuid", "name", "updates", "value", "source")
ATTRIBUTES = ("removed", "update_cb", "label", "value", "min")
WORDS = ("[1]", '[1, "steer", 9, 9, 9]', '[1, "select"]', '[1, "command", "burger", "fly"]', "[" * 900, "stop", "burger")
VALUES = (None, True, -1, 2**63, 1e308, float("nan"), float("inf"), "x" * 200, b"\x00" * 50, [], [[1]], {"a": {}}, *WORDS)


def nonsense(chance, ids):
    """One message of seeded nonsense, nearly right or not at all."""
    good = chance.choice([CAMERA, click(), update(chance.choice(ids), value=chance.choice(VALUES))])
    field = chance.choice(list(good))
    match chance.randrange(9):
        case 0:
            return pack(good)[: chance.randrange(1, len(pack(good)))]
        case 1:
            return chance.randbytes(chance.randrange(1, 2000))
        case 2:
            return b"\x91" * chance.randrange(1, LARGEST - 1)
        case 3:
            return pack(
                {"type": chance.choice(KINDS), **{k: chance.choice(VALUES) for k in ("uuid", "name", "updates", "value", "source")}}
            )
        case 4:
            return pack(
                update(chance.choice(ids), **{chance.choice(["removed", "update_cb", "label", "value", "min"]): chance.choice(VALUES)})
            )
        case 5:
            return "text, not bytes"
        case 6:
            return pack({**good, "more": 1})
        case 7:
            return pack({k: v for k, v in good.items() if k != field})
    return pack({**good, field: chance.choice(VALUES)})


def test_seeded_nonsense_stops_and_moves_nothing(station, good):
    chance = random.Random(SEED)
    ids = [*(good.elements), "root", "", "../etc"]
    for _ in range(5):
        send(station.port, [nonsense(chance, ids) for _ in range(60)])


@pytest.mark.parametrize(
    "raw",
    [
        b"",
        "text",
        b"\x91" * 10_000,
        pack([1, 2]),
        pack({**CAMERA, "fov": float("nan")}),
        pack({**CAMERA, "position": (0.0, 0.0, 1e300)}),
        pack({**CAMERA, "image_width": 2**40}),
        pack(update("x", removed=True)),
        pack(update("x", value=True, update_cb=[])),
        pack(update("x", value=float("inf"))),
        pack(update("x", value="y" * 60_000)),
        pack(click(event_type="rect-select")),
        pack(click(ray_origin=None)),
        pack({"type": "FileTransferStartUpload", "uuid": "x"}),
    ],
)
def test_what_no_page_says_is_not_handed_on(raw):
    assert not is_sound(raw)


@pytest.mark.parametrize("message", [CAMERA, click(), update("x", value=True), update("x", value=0.5), update("x", value="p" * 50_000)])
def test_what_a_page_says_is_handed_on(message):
    assert is_sound(pack(message))


STOP = "■ STOP ALL"


def test_nobody_takes_stop_all_from_the_others(station):
    """The field through which a page speaks, its callbacks and whether it is there at all are no client's to set."""
    with contextlib.closing(Browser(station.port)) as good:
        assert until(lambda: STOP in good.labels(), 30)
        field = good.bridge
        attacks = ({"removed": True}, {"update_cb": []}, {"label": "Release STOP"}, {"visible": True}, {"sync_cb": None})
        send(station.port, [pack(update(field, **attack)) for attack in attacks])
        assert good.bridge == field
        before = station.sent[0]
        good.press(STOP)
        assert until(lambda: station.sent[0] > before), "STOP ALL is dead"
        assert until(lambda: "Release STOP" in good.labels())
        good.press("Release STOP")
        assert until(lambda: "Release STOP" not in good.labels())


def test_nobody_speaks_through_another_ones_page_or_for_what_is_greyed_out(station, good):
    words = (["take-wheel", "burger"], ["command", "burger", "hold"], ["steer", 1, 0, 0])
    send(station.port, [pack(update(good.bridge, value=json.dumps([i, *word]))) for i, word in enumerate(words)])
    for key in ("arm", "takeoff", "return", "nonsense"):
        good.say("command", "burger", key)


def test_a_message_too_large_ends_only_its_own_connection(station, good):
    for size in (LARGEST + 1, 2_000_000):
        send(station.port, [b"\x00" * size])


def test_a_flood_delays_nobody_for_long(station, good):
    def ages():
        shown = good.html()
        begin = time.monotonic()
        return until(lambda: good.html() != shown, 10) and time.monotonic() - begin

    flood = [pack(update("nobody", value=i)) for i in range(5000)]
    threads = [threading.Thread(target=send, args=(station.port, flood)) for _ in range(3)]
    for thread in threads:
        thread.start()
    worst = max(ages() for _ in range(5))
    for thread in threads:
        thread.join(60)
    assert worst < 5.0


def test_many_connections_leave_room_for_those_there_are(station, good):
    async def many():
        async with contextlib.AsyncExitStack() as stack:
            opened = 0
            for _ in range(MOST_BROWSERS + 8):
                with contextlib.suppress(websockets.WebSocketException, OSError):
                    client = await stack.enter_async_context(connect(station.port))
                    await client.send(pack(CAMERA))
                    await client.recv()
                    opened += 1
            return opened

    assert asyncio.run(many()) < MOST_BROWSERS
    with contextlib.ExitStack() as stack:
        for _ in range(200):
            stack.callback(socket.create_connection(("127.0.0.1", station.port)).close)
        shown = good.html()
        assert until(lambda: good.html() != shown, 10)


async def _holding(port, count, words, until_shut):
    """That many connections which say their words and then no more, while ``until_shut`` runs."""
    async with contextlib.AsyncExitStack() as stack:
        clients = [await stack.enter_async_context(connect(port)) for _ in range(count)]
        for client in clients:
            for word in words:
                await client.send(pack(word))
        reading = [asyncio.create_task(_drain(client)) for client in clients]
        outcome = await until_shut(reading)
        for client in clients:
            client.transport.abort()
        await asyncio.gather(*reading)
        return outcome


async def _joins(port):
    async with connect(port) as client:
        with contextlib.suppress(websockets.ConnectionClosed):
            await client.send(pack(CAMERA))
            return bool(await asyncio.wait_for(client.recv(), 5))
    return False


def test_who_says_nothing_takes_no_browsers_place_for_long(station, good):
    async def wait(reading):
        before = await _joins(station.port)
        await asyncio.wait(reading, timeout=SILENT_FOR + 5.0)
        return before, all(one.done() for one in reading), await _joins(station.port)

    assert asyncio.run(_holding(station.port, MOST_BROWSERS - 1, [], wait)) == (False, True, True)


def test_who_has_fallen_silent_makes_room_for_another_and_who_speaks_does_not(station, good):
    async def wait(reading):
        early = await _joins(station.port)
        for _ in range(round(SILENT_FOR) + 1):
            await asyncio.to_thread(good.send, CAMERA)
            await asyncio.sleep(1.0)
        return early, await _joins(station.port), sum(one.done() for one in reading)

    assert asyncio.run(_holding(station.port, MOST_BROWSERS - 1, [CAMERA], wait)) == (False, True, 1)
    assert good.alive


@pytest.mark.parametrize(
    "head",
    [
        "Host: [::1",
        "Host: evil.example",
        "Host: 127.0.0.1\r\nHost: 127.0.0.1",
        "Host: 127.0.0.1\r\nOrigin: http://[",
        "Host: 127.0.0.1\r\nOrigin: http://evil.example",
        "Host: 127.0.0.1\r\nCookie: gcs=\udcff",
        "",
    ],
)
def test_a_request_of_no_browser_of_ours_is_refused(station, good, head):
    for upgrade in (
        "",
        "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n",
    ):
        with socket.create_connection(("127.0.0.1", station.port), 5) as client:
            client.sendall(f"GET / HTTP/1.1\r\n{head}\r\n{upgrade}\r\n".encode("utf-8", "surrogateescape"))
            answer = client.recv(200)
        refused = "Cookie" not in head
        assert not refused or answer[9:12] in (b"", b"400", b"403"), answer
