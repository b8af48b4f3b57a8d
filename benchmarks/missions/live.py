"""A mission in real time as ``uvf up`` runs it, with a page that looks: what each process takes, and what comes late.

CPU in per cent of one core. ``late`` is the share of steps that begin more than a period late, ``worst`` the latest one since the start;
``rate`` is simulated time per time on the clock.
"""

import asyncio
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path

import psutil

from benchmarks.gcs.page_client import PageClient
from launch.commands.bench import Figures
from schemas import topics
from schemas.messages import Health
from tests.distributed.system import System

SETTLES, LOOKS = 20.0, 60.0  # s


def fleet(data: Path | None) -> Figures:
    """Six rovers that are localized on a map of their house and patrol it, and four aircraft in two pairs."""
    return live("fleet", "anne")


def live(mission: str, shown: str) -> Figures:
    """Figures by process; shown: the vehicle that the page looks at."""
    with tempfile.TemporaryDirectory() as folder, System(Path(folder), page=True, mission=mission) as system:
        page = PageClient(system.page, {}, shown)
        with ThreadPoolExecutor(1) as pool:
            looking = pool.submit(asyncio.run, page.look(SETTLES + LOOKS))
            rows = _watched(system, page)
            looking.result()
    rows["page"] = {"positions Hz": page.moved / LOOKS, "kB/s": page.received / LOOKS / 1e3, "pictures Hz": page.pictures / LOOKS}
    return {f"{mission}: {name}": row for name, row in rows.items()}


def _watched(system: System, page: PageClient) -> Figures:
    """By process, and of all together."""
    time.sleep(SETTLES)
    page.forget()
    before, cpu, clock, began = _health(system), _cpu(system), _clock(system), time.monotonic()
    time.sleep(LOOKS)
    after, gone = _health(system), time.monotonic() - began
    rows = {name: _row(before[name], health, gone) for name, health in after.items() if name in before}
    return {**rows, "all": {"CPU %": 100 * (_cpu(system) - cpu) / gone, "rate": (_clock(system) - clock) / gone}}


def _row(before: Health, after: Health, gone: float) -> dict[str, float]:
    steps = after.steps - before.steps
    return {
        "CPU %": 100 * (after.cpu_time - before.cpu_time) / gone,
        "steps/s": steps / gone,
        "late %": 100 * (after.late - before.late) / max(steps, 1),
        "skipped": float(after.skipped - before.skipped),
        "worst ms": 1e3 * after.worst_lateness,
    }


def _health(system: System) -> dict[str, Health]:
    """By process; without those that run no services."""
    found = {}
    for name in system.children():
        with suppress(TimeoutError):
            found[name] = system.client.read("sys", topics.HEALTH.by(name))
    return found


def _cpu(system: System) -> float:
    """CPU seconds of all processes so far."""
    launcher = psutil.Process(system.popen.pid)
    return sum(sum(process.cpu_times()[:2]) for process in (launcher, *launcher.children(recursive=True)))


def _clock(system: System) -> float:
    """s, simulation."""
    return system.client.read("sys", topics.CLOCK).t_ns / 1e9


CASES = {"ten_vehicles": fleet}
