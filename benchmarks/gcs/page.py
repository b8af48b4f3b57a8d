"""The ground station before ten vehicles at 20 Hz, with their maps and a camera: its processor time and memory, and how old what a page
shows is when it arrives there.

Real processes on a real router: the service as ``uvf up`` starts it, one that says what ten vehicles say, pages on websockets.
"""

import asyncio
import os
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from statistics import median, quantiles

import psutil

from benchmarks.gcs.feeder import AIRCRAFT, ROVERS, mission
from benchmarks.gcs.page_client import PageClient
from launch.commands.bench import Figures
from tests.services.gcs.wire import free_port
from uvf.models.scenario import ROOT

PATIENCE = 60.0  # s
SETTLES = 10.0  # s
CIRCLES = ROVERS | AIRCRAFT
SHOWN = "aircraft0"
MOMENTS = (2, 12, 30)  # minutes


@dataclass(frozen=True)
class Station:
    """A running ground station: its page's port and its process."""

    port: int
    process: psutil.Process

    def cpu(self) -> float:
        """CPU seconds so far."""
        times = self.process.cpu_times()
        return float(times.user + times.system)

    def rss_mb(self) -> float:
        """Resident memory now."""
        return float(self.process.memory_info().rss / 1e6)


@contextmanager
def ten_vehicles() -> Iterator[Station]:
    """A router, a ground station, and ten vehicles that move."""
    endpoint, port = f"tcp/127.0.0.1:{free_port()}", free_port()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "ten.yaml"
        file.write_text(mission())
        environment = {**os.environ, "UVF_ROUTER": endpoint, "UVF_GCS_PORT": str(port), "UVF_STATE": folder}
        commands = (
            ("launch.cli", "router", "--listen", endpoint),
            ("launch.cli", "service", "gcs", "--mission", str(file)),
            ("benchmarks.gcs.feeder", endpoint),
        )
        processes = [subprocess.Popen([sys.executable, "-m", *words], cwd=ROOT, env=environment) for words in commands]
        try:
            _wait_for(port)
            yield Station(port, psutil.Process(processes[1].pid))
        finally:
            for process in reversed(processes):
                process.terminate()
                process.wait()


def _wait_for(port: int) -> None:
    end = time.monotonic() + PATIENCE
    while True:
        try:
            urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=5).close()
        except (urllib.error.URLError, ConnectionError, TimeoutError):
            if time.monotonic() > end:
                raise SystemExit("bench gcs: the page does not open") from None
            time.sleep(0.2)
        else:
            return


def pages(count: int, seconds: float, _: Path | None = None) -> Figures:
    """So many pages that look for ``seconds``."""
    return {f"{count} {'page' if count == 1 else 'pages'}": _looked_at([0.0] * count, seconds)}


def slow_page(seconds: float, _: Path | None = None) -> Figures:
    """A page that takes half a second over each batch beside a fast one, whose figures are told."""
    return {"1 page beside a slow one": _looked_at([0.0, 0.5], seconds)}


def _looked_at(pauses: list[float], seconds: float) -> dict[str, float]:
    with ten_vehicles() as station:
        clients = [PageClient(station.port, CIRCLES, SHOWN, pause) for pause in pauses]
        cpu, memory, gone = asyncio.run(_measured(station, clients, seconds))
    fast = clients[0]
    late = [1e3 * age for age in fast.ages]
    return {
        "CPU %": 100 * cpu / gone,
        "p50 ms": median(late),
        "p95 ms": quantiles(late, n=20)[-1],
        "positions Hz": len(late) / gone / len(CIRCLES),
        "pictures Hz": fast.pictures / gone,
        "kB/s": fast.received / gone / 1e3,
        "join s": fast.joined,
        "MB": memory,
    }


async def _measured(station: Station, clients: list[PageClient], seconds: float) -> tuple[float, float, float]:
    """CPU seconds of the station once it has settled, its memory [MB] at the end, and the time [s] between."""
    looks = [asyncio.create_task(client.look(SETTLES + seconds)) for client in clients]
    await asyncio.sleep(SETTLES)
    for client in clients:
        client.forget()
    cpu, began = station.cpu(), time.monotonic()
    await asyncio.sleep(seconds)
    found = station.cpu() - cpu, station.rss_mb(), time.monotonic() - began
    await asyncio.gather(*looks)
    return found


def long_run(_: Path | None = None) -> Figures:
    """Memory over half an hour before one page; what is kept to look back at is full after ten minutes."""
    with ten_vehicles() as station:
        at = asyncio.run(_remembered(station))
    return {"half an hour": {f"MB at {minute} min": mb for minute, mb in zip(MOMENTS, at, strict=True)}}


async def _remembered(station: Station) -> list[float]:
    client, found, began = PageClient(station.port, CIRCLES, SHOWN), list[float](), time.monotonic()
    look = asyncio.create_task(client.look(60.0 * MOMENTS[-1] + 1.0))
    for minute in MOMENTS:
        await asyncio.sleep(60.0 * minute - (time.monotonic() - began))
        found.append(station.rss_mb())
        client.forget()
    await look
    return found


CASES = {
    "one_page": partial(pages, 1, 60.0),
    "three_pages": partial(pages, 3, 60.0),
    "slow_page": partial(slow_page, 60.0),
    "half_an_hour": long_run,
}
