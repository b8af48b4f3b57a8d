"""Round trips between two processes through the router, in one run: raw zenoh, UVF with encoding and decoding but without the checks
at the border, and UVF as it is."""

import json
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median, quantiles

import zenoh

from benchmarks.runtime.bus.echo import MESSAGES, READERS
from uvf.runtime.bus.zenoh_bus import ZenohBus

WARM_UP = 5
TRIPS = 50
ROUNDS = 60
PATIENCE = 5.0  # s

KINDS = ("raw", *READERS)

Trip = Callable[[], None]


def round_trips(data: Path | None) -> dict[str, dict[str, float]]:
    """p50 and p99 [us] and ratios of the medians, rounds of all kinds taking turns; ``checks``: of UVF to itself unchecked."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        endpoint = f"tcp/127.0.0.1:{probe.getsockname()[1]}"
    processes = [subprocess.Popen([sys.executable, "-m", "launch.cli", "router", "--listen", endpoint])]
    try:
        with ZenohBus(endpoint) as bus:
            processes += [subprocess.Popen([sys.executable, "-m", "benchmarks.runtime.bus.echo", kind, endpoint]) for kind in KINDS]
            return _measure(endpoint, bus)
    finally:
        for process in reversed(processes):
            process.terminate()
            process.wait()


def _measure(endpoint: str, bus: ZenohBus) -> dict[str, dict[str, float]]:
    config = zenoh.Config()
    config.insert_json5("mode", '"client"')
    config.insert_json5("connect/endpoints", json.dumps([endpoint]))
    figures = {}
    with zenoh.open(config) as session:
        for name in MESSAGES:
            trips = {"raw": _raw_trip(session, name)} | {kind: _uvf_trip(bus, kind, name) for kind in READERS}
            times: dict[str, list[float]] = {kind: [] for kind in KINDS}
            for _ in range(ROUNDS):
                for kind, trip in trips.items():
                    times[kind] += _time(trip)
            figures[name] = _figures(times)
    return figures


def _figures(times: dict[str, list[float]]) -> dict[str, float]:
    out = {}
    for kind, taken in times.items():
        out[f"{kind} p50 us"] = median(taken) * 1e6
        out[f"{kind} p99 us"] = quantiles(taken, n=100)[-1] * 1e6
    return out | {"ratio": out["uvf p50 us"] / out["raw p50 us"], "checks": out["uvf p50 us"] / out["unchecked p50 us"]}


def _time(trip: Trip) -> list[float]:
    taken = []
    for i in range(WARM_UP + TRIPS):
        begun = time.perf_counter()
        trip()
        if i >= WARM_UP:
            taken.append(time.perf_counter() - begun)
    return taken


def _until(send: Trip, here: threading.Event) -> None:
    """The far end may still be starting: sends again until something comes back."""
    end = time.monotonic() + PATIENCE
    while True:
        send()
        if here.wait(0.2):
            here.clear()
            return
        if time.monotonic() > end:
            raise SystemExit("bench bus: no echo")


def _raw_trip(session: zenoh.Session, name: str) -> Trip:
    message, _ = MESSAGES[name]
    payload, here = message.SerializeToString(), threading.Event()
    publisher = session.declare_publisher(f"raw/there/{name}", express=True)
    session.declare_subscriber(f"raw/back/{name}", lambda _: here.set())
    return lambda: _until(lambda: publisher.put(payload), here)


def _uvf_trip(bus: ZenohBus, kind: str, name: str) -> Trip:
    message, qos = MESSAGES[name]
    type_, read, got = type(message), READERS[kind], []
    publisher = bus.publisher(f"uvf/{kind}/there/{name}", type_.DESCRIPTOR.full_name, qos)
    bus.subscribe(f"uvf/{kind}/back/{name}", qos, lambda s: got.append(read(s, type_)), depth=8, wake=True)

    def trip() -> None:
        got.clear()
        end = time.monotonic() + PATIENCE
        publisher.put(message.SerializeToString(deterministic=True), 1)
        while not got:
            bus.wait(0.2)
            bus.poll()
            if time.monotonic() > end:
                raise SystemExit("bench bus: no echo")

    deadline = time.monotonic() + PATIENCE
    while not got and time.monotonic() < deadline:
        publisher.put(message.SerializeToString(deterministic=True), 1)
        bus.wait(0.2)
        bus.poll()
    return trip


CASES = {"round_trips": round_trips}
