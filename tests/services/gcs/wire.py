"""A client of the page's websocket that is no browser: joins, and reads what is sent."""

import asyncio
import socket

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
        f"ws://127.0.0.1:{port}", subprotocols=[f"viser-v{viser.__version__}"], max_size=None, origin=origin, additional_headers=headers
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
