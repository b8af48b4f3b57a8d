"""viser's server with what it lacks: a guard at its port, and a replay that stops nobody."""

import contextlib
import io
import logging
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import viser
import websockets.asyncio.server as websocket_server
from viser import _messages

from services.gcs.page import viser_join
from services.gcs.page.guard import Guard
from services.gcs.page.viser_assets import assets
from services.gcs.page.viser_socket import LARGEST, Door
from services.gcs.page.viser_wakeup import wake_from_the_loop
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.address import Address

ERRORS_TOLD = 10


def guarded_server(address: Address, downloads: Mapping[str, Path]) -> viser.ViserServer:
    """viser's server behind the guard: websockets' ``serve``, which viser looks up when it starts, is wrapped meanwhile."""
    logging.getLogger("websockets.server").setLevel(logging.CRITICAL)  # a browser's idle connection is not worth a traceback
    guard = Guard(address.port, address.token, assets(), downloads)
    door = Door()
    plain = websocket_server.serve

    def serve(handler: Any, *args: Any, process_request: Any = None, **kwargs: Any) -> Any:
        bounds = {"create_connection": door.connection, "max_size": LARGEST}
        return plain(door.handler(handler), *args, process_request=guard.wrap(process_request), **kwargs | bounds)

    websocket_server.serve = serve  # type: ignore[assignment, misc]
    try:
        with viser_join.jumping(), contextlib.redirect_stdout(io.StringIO()):  # viser prints a box of its own even when told to be quiet
            server = viser.ViserServer(address.host, address.port, verbose=False)
    finally:
        websocket_server.serve = plain  # type: ignore[misc]
    wake_from_the_loop(server._websock_server)
    loop = server.get_event_loop()
    loop.call_soon_threadsafe(loop.set_exception_handler, telling_of_few())
    server._websock_server.unregister_handler(_messages.ShareUrlRequest)
    if server.get_port() != address.port:
        server.stop()
        raise BadInput(f"gcs: port {address.port} is taken; choose another, for example UVF_GCS_PORT=8081")
    return server


def telling_of_few() -> Callable[[Any, dict[str, Any]], None]:
    """Reports only the first errors of viser's loop: a client that sends a word for a number causes one with each message."""
    told = 0

    def report(loop: Any, context: dict[str, Any]) -> None:
        nonlocal told
        told += 1
        if told <= ERRORS_TOLD:
            loop.default_exception_handler(context)

    return report
