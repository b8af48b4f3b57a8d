"""Who may talk to the page's port: Origin, Host and token are checked before viser sees a request.

viser itself asks nobody for anything, so any web page open in the operator's browser could arm a vehicle through
``ws://127.0.0.1:8080``. A foreign Origin is refused, and a foreign Host, which is how DNS rebinding looks.
"""

import http
import secrets
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from http.cookies import CookieError, SimpleCookie
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from services.gcs.page.viser_assets import SAFE, Asset
from uvf.runtime.bus.address import is_loopback

COOKIE = "gcs"


@dataclass(frozen=True)
class Guard:
    """Access rules of one listening address. token: empty = loopback only, no token asked."""

    port: int
    token: str = ""
    files: Mapping[str, Asset] = field(default_factory=dict)
    """What is served besides viser's own, by path."""
    downloads: Mapping[str, Path] = field(default_factory=dict)
    """Files that may be taken away, by path."""
    health: Callable[[], bytes] = field(default=lambda: b'{"status": "ok"}')

    def refuses(self, path: str, headers: Mapping[str, str]) -> str:
        """Why the request is refused; "" when it may pass."""
        host = headers.get("Host", "")
        name = urlsplit(f"//{host}").hostname or ""
        if not self.token and not is_loopback(name):
            return "unknown Host"
        origin = headers.get("Origin", "")
        if origin and urlsplit(origin).netloc != host:
            return "foreign Origin"
        if self.token and not (self._matches(_cookie(headers.get("Cookie", ""))) or self._matches(_query_token(path))):
            return "token missing or wrong: open the address that the ground station printed"
        return ""

    def _matches(self, token: str) -> bool:
        return secrets.compare_digest(token.encode(), self.token.encode())

    def answer(self, path: str, headers: Mapping[str, str]) -> Response | None:
        """The guard's own response to a request, or None to let viser respond."""
        try:
            return self._answer(path, headers)
        except (ValueError, LookupError):  # half an IPv6 address, letters that are none, a header given twice
            return _response(http.HTTPStatus.BAD_REQUEST, b"400: not a request of a browser\n", {"Content-Type": "text/plain"})

    def _answer(self, path: str, headers: Mapping[str, str]) -> Response | None:
        if urlsplit(path).path == "/healthz" and not headers.get("Origin"):
            return _response(http.HTTPStatus.OK, self.health(), {"Content-Type": "application/json"})
        reason = self.refuses(path, headers)
        if reason:
            return _response(http.HTTPStatus.FORBIDDEN, f"403: {reason}\n".encode(), {"Content-Type": "text/plain"})
        is_page = headers.get("Upgrade", "").lower() != "websocket"
        if self.token and is_page and _query_token(path):
            cookie = f"{COOKIE}={self.token}; HttpOnly; SameSite=Strict; Path=/"
            return _response(http.HTTPStatus.FOUND, b"", {"Location": urlsplit(path).path or "/", "Set-Cookie": cookie})
        asset = self.files.get(urlsplit(path).path) if is_page else None
        if asset is not None:
            return _response(http.HTTPStatus.OK, *asset.answer(headers.get("Accept-Encoding", "")))
        file = self.downloads.get(urlsplit(path).path) if is_page else None
        if file is not None:
            return _download(file)
        return None

    def wrap(self, process_request: Callable[..., Any] | None) -> Callable[[Any, Request], Any]:
        """A ``process_request`` for the websockets server that asks the guard first."""

        def guarded(connection: Any, request: Request) -> Any:
            answer = self.answer(request.path, request.headers)
            if answer is not None or process_request is None:
                return answer
            return process_request(connection, request)

        return guarded


def _query_token(path: str) -> str:
    return parse_qs(urlsplit(path).query).get("token", [""])[0]


def _cookie(header: str) -> str:
    try:
        morsel = SimpleCookie(header).get(COOKIE)
    except CookieError:
        return ""
    return morsel.value if morsel is not None else ""


def _download(file: Path) -> Response:
    """A file to be kept, which no browser opens by itself."""
    try:
        body = file.read_bytes()
    except OSError:
        return _response(http.HTTPStatus.NOT_FOUND, b"404: there is another file by now\n", {"Content-Type": "text/plain"})
    about = {"Content-Type": "application/octet-stream", "Content-Disposition": f'attachment; filename="{file.name}"', **SAFE}
    return _response(http.HTTPStatus.OK, body, about)


def _response(status: http.HTTPStatus, body: bytes, headers: Mapping[str, str]) -> Response:
    return Response(status.value, status.phrase, Headers({**headers, "Content-Length": str(len(body))}), body)
