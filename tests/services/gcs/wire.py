"""A client of the page's websocket that is no browser: joins, and reads what is sent."""

import asyncio
import json
import re
import socket
import threading
import time
from html import unescape

import msgspec
import viser
import websockets
import zstandard

CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": (1.0, 0.0, 0.0, 0.0),
    "position": (0.0, 0.0, 5.0),
    "image_height": 600,
    "image_width": 800,
    "fov": 1.0,
    "near": 0.01,
    "far": 1000.0,
    "look_at": (0.0, 0.0, 0.0),
    "up_direction": (0.0, 0.0, 1.0),
}


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def decode(batch):
    size, packed = int.from_bytes(batch[:8], "little"), int.from_bytes(batch[8:16], "little")
    return msgspec.msgpack.decode(zstandard.ZstdDecompressor().decompress(batch[16 : 16 + packed], max_output_size=size))["messages"]


def connect(port, origin=None, headers=None):
    return websockets.connect(
        f"ws://127.0.0.1:{port}",
        subprotocols=[f"viser-v{viser.__version__}"],
        max_size=None,
        close_timeout=1.0,
        origin=origin,
        additional_headers=headers,
    )


async def _join(port, send):
    messages = []
    async with connect(port) as ws:
        for message in (CAMERA, *send):
            await ws.send(msgspec.msgpack.encode(message))
        while not any(m["type"] == "ReplayDoneMessage" for m in messages):
            messages += decode(await asyncio.wait_for(ws.recv(), 20))
    return messages


def join(port, *send):
    """All messages that a page gets when it joins, to the end of the replay."""
    return asyncio.run(_join(port, send))


class Browser:
    """A client that stays connected and keeps what it is sent: of the GUI the newest of each property."""

    def __init__(self, port):
        self.port = port
        self.elements = {}
        self.count = 0
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        self._socket = self._do(self._open())
        self._reading = asyncio.run_coroutine_threadsafe(self._read(), self._loop)

    def _do(self, coroutine):
        return asyncio.run_coroutine_threadsafe(coroutine, self._loop).result(20)

    async def _open(self):
        socket = await connect(self.port)
        await socket.send(msgspec.msgpack.encode(CAMERA))
        return socket

    async def _read(self):
        async for batch in self._socket:
            for message in decode(batch):
                self._take(message)

    def _take(self, message):
        kind = message["type"]
        if kind == "GuiUpdateMessage" and message["uuid"] in self.elements:
            self.elements[message["uuid"]] |= message["updates"]
        elif kind == "GuiRemoveMessage":
            self.elements.pop(message["uuid"], None)
        elif kind.startswith("Gui") and "props" in message:
            self.elements[message["uuid"]] = {**message["props"], "value": message.get("value"), "kind": kind}

    @property
    def alive(self):
        return not self._reading.done()

    def html(self):
        """All words on show."""
        return "".join(e["content"] for e in list(self.elements.values()) if e["kind"] == "GuiHtmlMessage")

    def words(self):
        """What the buttons of its panels say, by their labels."""
        found = re.findall(r"<button[^>]*data-do='([^']*)'[^>]*>([^<]*)", self.html())
        return {unescape(label).strip(): json.loads(unescape(word)) for word, label in found}

    def labels(self):
        return set(self.words())

    def send(self, message):
        self._do(self._socket.send(msgspec.msgpack.encode(message)))

    def press(self, label):
        self.say(*self.words()[label])

    @property
    def bridge(self):
        """Id of the hidden field that the page's own script speaks through."""
        return next(uuid for uuid, e in list(self.elements.items()) if e["kind"] == "GuiTextMessage")

    def say(self, *word):
        """What the page's own script would say."""
        self.count += 1
        self.send({"type": "GuiUpdateMessage", "uuid": self.bridge, "updates": {"value": json.dumps([self.count, *word])}})

    def close(self):
        self._do(self._socket.close())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(5)


def until(holds, seconds=10.0):
    """Whether it comes true in time."""
    end = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True
