"""What a browser may say to viser: few kinds of small messages of a known form, and not too many of them.

viser itself takes every kind of its messages from any client, of up to 50 MB, and sets whatever attribute of a button or
slider the client names: one message could take the meaning from STOP ALL for everybody.
"""

import asyncio
import math
import time
from collections.abc import Callable
from typing import Annotated, Any, Literal

import msgspec
import viser
from websockets.asyncio.server import ServerConnection

VERSION = f"viser-v{viser.__version__}"
LARGEST = 64 * 1024  # bytes of a message
MOST_OPEN = 64  # connections to the port, also those that have not said yet what they want
MOST_BROWSERS = 16
SILENT_FOR = 10.0  # s; a page tells every 2 s how wide it is, one in a hidden tab at least once a minute
RATE, BURST = 100.0, 200.0  # messages/s of one browser: a page sends 30 at most
FAULTS = 20  # more messages of no known form than sound ones, after which a connection is closed

Word = Annotated[str, msgspec.Meta(max_length=2048)]
Text = Annotated[str, msgspec.Meta(max_length=56_000)]
"""What the page's script says, with a plan file in it at most; ``page.words`` looks at each part."""
Name = Annotated[str, msgspec.Meta(max_length=512)]
Modifier = Annotated[str, msgspec.Meta(max_length=32)] | None
Pixels = Annotated[int, msgspec.Meta(ge=0, le=100_000)]
Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
Screen = tuple[float, float]


class CameraMessage(msgspec.Struct, tag="ViewerCameraMessage", forbid_unknown_fields=True):
    """As ``viser._messages.ViewerCameraMessage``; the names below likewise."""

    wxyz: Quaternion
    position: Vector
    fov: float
    near: float
    far: float
    image_height: Pixels
    image_width: Pixels
    look_at: Vector
    up_direction: Vector


class Value(msgspec.Struct, forbid_unknown_fields=True):
    """New value of a button, slider, choice or text field, the only attribute that a client may set."""

    value: bool | int | float | Text


class Update(msgspec.Struct, tag="GuiUpdateMessage", forbid_unknown_fields=True):
    """As ``viser._messages.GuiUpdateMessage``."""

    uuid: Word
    updates: Value


class Click(msgspec.Struct, tag="ScenePointerMessage", forbid_unknown_fields=True):
    """As ``viser._messages.ScenePointerMessage``, of clicks only."""

    event_type: Literal["click"]
    ray_origin: Vector
    ray_direction: Vector
    screen_pos: tuple[Screen]
    modifier: Modifier


class NodeClick(msgspec.Struct, tag="SceneNodeClickMessage", forbid_unknown_fields=True):
    """As ``viser._messages.SceneNodeClickMessage``."""

    name: Name
    ray_origin: Vector
    ray_direction: Vector
    screen_pos: Screen
    instance_index: int | None
    modifier: Modifier
    owner: Word = ""


DECODER: msgspec.msgpack.Decoder[Any] = msgspec.msgpack.Decoder(CameraMessage | Update | Click | NodeClick)


def is_sound(raw: object) -> bool:
    """Whether it is a valid message of a page with finite numbers."""
    if not isinstance(raw, bytes):
        return False
    try:
        message = DECODER.decode(raw)
    except (msgspec.DecodeError, RecursionError, UnicodeDecodeError):
        return False
    return all(math.isfinite(number) and abs(number) < 1e12 for number in _numbers(msgspec.structs.astuple(message)))


def _numbers(parts: Any) -> list[float]:
    found = []
    for part in parts:
        if isinstance(part, tuple):
            found += _numbers(part)
        elif isinstance(part, Value):
            found += _numbers((part.value,))
        elif isinstance(part, int | float):
            found.append(part)
    return found


class Door:
    """Counts the connections to one port."""

    def __init__(self) -> None:
        self.open = 0
        self._browsers: set[PageConnection] = set()
        self.refused = 0
        """Messages of no known form."""

    def connection(self, *args: Any, **kwargs: Any) -> "PageConnection":
        """Factory of connections for the websockets server."""
        return PageConnection(self, *args, **kwargs)

    def handler(self, serve: Callable[[Any], Any]) -> Callable[[Any], Any]:
        """viser's own handler, limited to as many browsers as there may be at a time."""

        async def bounded(connection: Any) -> None:
            if connection.subprotocol != VERSION:
                await connection.close(1002, f"Version mismatch. Client: {str(connection.subprotocol)[:40]}, Server: {VERSION}")
                return
            if not self._has_room():
                await connection.close(1013, f"{MOST_BROWSERS} browsers are connected already")
                return
            self._browsers.add(connection)
            waiting = asyncio.get_running_loop().call_later(SILENT_FOR, connection.end_if_mute)
            try:
                await serve(connection)
            finally:
                waiting.cancel()
                self._browsers.discard(connection)

        return bounded

    def _has_room(self) -> bool:
        """For one more; the longest silent has to go for it, but nobody who has spoken of late."""
        if len(self._browsers) < MOST_BROWSERS:
            return True
        silent = min(self._browsers, key=lambda browser: browser.spoke_at)
        if time.monotonic() - silent.spoke_at < SILENT_FOR:
            return False
        self._browsers.discard(silent)
        silent.transport.abort()  # a goodbye would wait for an answer
        return True


class PageConnection(ServerConnection):
    """Passes on valid messages; a client over its rate is read more slowly, one that sends invalid ones is disconnected."""

    def __init__(self, door: Door, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._door = door
        self._allowance, self._counted_at = BURST, time.monotonic()
        self._faults = 0
        self._has_spoken = False
        self.spoke_at = self._counted_at
        """When it last said something sound, or connected [s]."""

    def end_if_mute(self) -> None:
        """Disconnects a client that has said nothing since it connected: a browser sends its camera pose at once."""
        if not self._has_spoken:
            self.transport.abort()

    def connection_made(self, transport: Any) -> None:
        """Counts the connection, and refuses it beyond ``MOST_OPEN``."""
        super().connection_made(transport)
        self._door.open += 1
        if self._door.open > MOST_OPEN:
            transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """Counts the connection off."""
        super().connection_lost(exc)
        self._door.open -= 1

    async def recv(self, decode: bool | None = None) -> Any:
        """The next valid message, within the client's rate."""
        while True:
            raw = await super().recv(decode)
            await self._in_turn()
            if is_sound(raw):
                self._faults = max(0, self._faults - 1)
                self._has_spoken, self.spoke_at = True, time.monotonic()
                return raw
            self._faults += 1
            self._door.refused += 1
            if self._faults > FAULTS:
                await self.close(1008, "these are no messages of this page")

    async def _in_turn(self) -> None:
        """Waits while this client is over its rate; meanwhile nothing more of it is read, and its own socket fills."""
        now = time.monotonic()
        self._allowance = min(BURST, self._allowance + RATE * (now - self._counted_at)) - 1.0
        self._counted_at = now
        if self._allowance < 0:
            await asyncio.sleep(-self._allowance / RATE)
