"""``uvf doctor``: what this machine has and lacks, a line each."""

import importlib
import importlib.metadata
import shutil
import sys
from collections.abc import Callable, Iterator

from launch import settings
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.address import address_from, host_and_port, refusal, router_from

WHEELS = ("zenoh", "pybullet", "jsbsim", "pymavlink", "viser", "numba", "mcap", "filterpy")
FREE_DISK = 2 * settings.GIGABYTE
PROBE_ENDPOINT = "tcp/127.0.0.1:7499"


def examine(say: Callable[[str], None]) -> int:
    """Prints one line per finding; 1 when something that is needed is missing."""
    findings = [*_python(), *_wheels(), *_ports(), *_zenoh(), *_browser(), *_disk()]
    for good, line in findings:
        say(f"{'ok  ' if good else 'BAD '} {line}")
    return 0 if all(good for good, _ in findings) else 1


Finding = tuple[bool, str]


def _python() -> Iterator[Finding]:
    version = ".".join(map(str, sys.version_info[:3]))
    yield sys.version_info[:2] == (3, 11), f"Python {version} at {sys.executable} (3.11 is needed: pybullet has wheels for it)"


def _wheels() -> Iterator[Finding]:
    for name in WHEELS:
        try:
            importlib.import_module(name)
        except ImportError as error:
            yield False, f"package {name}: {error}; remove .venv and run ./uvf again"
        else:
            yield True, f"package {name}"


def _ports() -> Iterator[Finding]:
    page = address_from()
    for host, port, what in ((*host_and_port(router_from()), "router"), (page.host, page.port, "page")):
        reason = refusal(host, port)
        # A taken port is what a running system looks like: worth a line, not a fault.
        yield True, f"port {port} ({what}): {f'{reason}; UVF may be running' if reason else 'free'}"


def _zenoh() -> Iterator[Finding]:
    from uvf.runtime.bus.zenoh_bus import ZenohBus, open_router

    try:
        router = open_router(PROBE_ENDPOINT)
        with ZenohBus(PROBE_ENDPOINT, timeout=2.0):
            pass
        router.close()  # type: ignore[no-untyped-call]
    except BadInput as error:
        yield False, f"zenoh: {error}"
    else:
        yield True, "zenoh: a router opens and a client connects"


def _browser() -> Iterator[Finding]:
    found = next((path for name in ("chromium", "google-chrome", "firefox") if (path := shutil.which(name))), None)
    yield True, f"browser: {found or 'none found here; any browser on this machine will do for the page'}"


def _disk() -> Iterator[Finding]:
    folder = settings.runs_folder()
    where = next(p for p in (folder, *folder.parents) if p.exists())
    free = shutil.disk_usage(where).free
    yield free > FREE_DISK, f"disk: {free / settings.GIGABYTE:.0f} GB free for logs in {folder}"
