"""The files that the page consists of: viser's own page with our frame of panels put into it, and what that frame loads."""

import gzip
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import viser

WEB = Path(__file__).with_name("web")
VISER_PAGE = Path(viser.__file__).parent / "client/build/index.html"
TYPES = {".css": "text/css; charset=utf-8", ".js": "text/javascript; charset=utf-8", ".html": "text/html; charset=utf-8"}
STYLES = ("theme.css", "layout.css", "parts.css", "graph.css", "plot.css", "time.css")
SCRIPT = "main.js"
SAFE = {
    "Cache-Control": "no-cache",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Content-Security-Policy": "frame-ancestors 'none'; object-src 'none'; base-uri 'none'; form-action 'none'",
}
"""Headers of every answer: no other page frames this one, and the token in the address is told to nobody."""


@dataclass(frozen=True)
class Asset:
    """A file as it is sent."""

    kind: str
    plain: bytes
    packed: bytes

    def answer(self, accepts: str) -> tuple[bytes, dict[str, str]]:
        """(body, headers) for a browser that accepts these encodings."""
        packed = "gzip" in accepts
        coding = {"Content-Encoding": "gzip"} if packed else {}
        return (self.packed if packed else self.plain), {"Content-Type": self.kind, "Vary": "Accept-Encoding", **coding, **SAFE}


def assets() -> Mapping[str, Asset]:
    """All files by their path on the server. Raises OSError when one is missing."""
    return dict(_read())


def _read() -> Iterator[tuple[str, Asset]]:
    index = _asset(".html", framed(VISER_PAGE.read_text(encoding="utf-8")).encode())
    yield from (("/", index), ("/index.html", index))
    for path in sorted(WEB.iterdir()):
        if path.suffix in (".css", ".js"):
            yield f"/gcs/{path.name}", _asset(path.suffix, path.read_bytes())


def _asset(suffix: str, body: bytes) -> Asset:
    return Asset(TYPES[suffix], body, gzip.compress(body, mtime=0))


def framed(page: str) -> str:
    """viser's page with our styles and script in its head and our panels in its body."""
    head = "".join(f'<link rel="stylesheet" href="/gcs/{name}" />' for name in STYLES)
    head += f'<script type="module" src="/gcs/{SCRIPT}"></script>'
    shell = (WEB / "shell.html").read_text(encoding="utf-8")
    page = page.replace("<title>Viser</title>", "<title>UVF ground station</title>", 1)
    before, end, after = page.rpartition("</head>")
    inner, root, rest = after.partition('<div id="root"></div>')
    return before + head + end + inner + root + shell + rest
