"""A browser's side of the page without the browser: reads what the ground station sends, and says what the page's script says."""

import asyncio
import json
import re
import secrets
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import msgspec
import viser
import websockets

from benchmarks.gcs.feeder import Circle
from tests.services.gcs.wire import CAMERA, decode

BEAT = re.compile(r"data-beat='([0-9.]+)'")
BRIDGE = re.compile(r"data-bridge='([^']+)'")


@dataclass
class PageClient:
    """One page. vehicle: the one on show; pause: s that it takes over each batch, as a slow one does.

    ages: how old [s] each position was on arrival; received: bytes; pictures: of the camera; moved: positions of whatever is in the scene.
    """

    port: int
    circles: Mapping[str, Circle]
    vehicle: str
    pause: float = 0.0
    ages: list[float] = field(default_factory=list)
    received: int = 0
    pictures: int = 0
    moved: int = 0
    joined: float = 0.0
    _count: int = 0
    _bridge: str = ""
    _beat: str = ""

    def forget(self) -> None:
        """Counts anew from here."""
        self.ages, self.received, self.pictures, self.moved = [], 0, 0, 0

    async def look(self, seconds: float) -> None:
        """Joins, and looks for so long."""
        began, looked = time.monotonic(), 0.0
        url, protocol = f"ws://127.0.0.1:{self.port}", f"viser-v{viser.__version__}"
        async with websockets.connect(url, subprotocols=[websockets.Subprotocol(protocol)], max_size=None, ping_interval=None) as socket:
            await socket.send(msgspec.msgpack.encode(CAMERA))
            while (now := time.monotonic()) - began < seconds:
                batch = await socket.recv()
                assert isinstance(batch, bytes)
                self.received += len(batch)
                for message in decode(batch):
                    await self._take(socket, message)
                    self.joined = self.joined or (time.monotonic() - began if message["type"] == "ReplayDoneMessage" else 0.0)
                if self._bridge and now - looked > 1.0:
                    looked = now
                    await self._say(socket, "looks")
                if self.pause:
                    await asyncio.sleep(self.pause)

    async def _take(self, socket: websockets.ClientConnection, message: Mapping[str, Any]) -> None:
        kind = message["type"]
        if kind == "SetPositionMessage":
            self.moved += 1
            circle = self.circles.get(message["name"].removeprefix("/vehicles/"))
            if circle is not None:
                self.ages.append(circle.age(*message["position"][:2], time.time()))
            return
        content = str(message.get("props", message.get("updates", {})).get("content", "")) if kind.startswith("Gui") else ""
        self.pictures += "data:image/jpeg" in content
        beat, bridge = BEAT.search(content), BRIDGE.search(content)
        if bridge and not self._bridge:
            self._bridge = bridge[1]
            await self._say(socket, "hello", secrets.token_hex(16), self.vehicle)
            await self._say(socket, "tab", "fly")
        if beat and beat[1] != self._beat:
            self._beat = beat[1]
            await self._say(socket, "beat", self._beat)

    async def _say(self, socket: websockets.ClientConnection, *word: str) -> None:
        self._count += 1
        said = {"type": "GuiUpdateMessage", "uuid": self._bridge, "updates": {"value": json.dumps([self._count, *word])}}
        await socket.send(msgspec.msgpack.encode(said))
