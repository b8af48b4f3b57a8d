"""A mission's processes beside whatever else runs on this machine: on ports and in folders of their own, for benchmarks."""

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from uvf.client import Client, connect
from uvf.models.scenario import ROOT
from uvf.models.yaml_data import BadInput

PATIENCE = 180.0  # s, until time runs: kernels may have to be compiled
LOOK = 0.2  # s
STOPPING = 60.0  # s, for all services to end and the log to be closed
OUTPUT = "up.txt"


@contextmanager
def apart(mission: Path, folder: Path) -> Iterator[Client]:
    """Starts ``uvf up`` without the page and yields a client once time has begun to run; logs go below ``folder``, the run in ``latest``.

    Raises BadInput when time does not begin to run.
    """
    endpoint, output = f"tcp/127.0.0.1:{_free_port()}", folder / OUTPUT
    command = [sys.executable, "-m", "launch.cli", "up", str(mission), "--no-gcs"]
    with output.open("wb") as out:
        process = subprocess.Popen(command, cwd=ROOT, env=_environment(endpoint, folder), stdout=out, stderr=out)
    try:
        _wait_for_time(process, output)
        with connect(endpoint) as client:
            yield client
    finally:
        _stop(process)


def _stop(process: subprocess.Popen[bytes]) -> None:
    """As Ctrl-C does; what does not heed it is ended, and its services notice that their launcher is gone."""
    process.send_signal(signal.SIGINT)
    try:
        process.wait(STOPPING)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _environment(endpoint: str, folder: Path) -> dict[str, str]:
    return {
        **os.environ,
        "UVF_ROUTER": endpoint,
        "UVF_MAVLINK_TARGETS": f"127.0.0.1:{_free_port(socket.SOCK_DGRAM)}",
        "UVF_MAVLINK_LISTEN": f"127.0.0.1:{_free_port(socket.SOCK_DGRAM)}",
        "UVF_RUNS": str(folder),
        "UVF_STATE": str(folder / "state"),
    }


def _wait_for_time(process: subprocess.Popen[bytes], output: Path) -> None:
    end = time.monotonic() + PATIENCE
    while "time runs" not in (said := output.read_text(errors="replace")):
        if process.poll() is not None or time.monotonic() > end:
            last = next((line.strip() for line in reversed(said.splitlines()) if line.strip()), "it says nothing")
            raise BadInput(f"'uvf up' does not begin to run: {last}")
        time.sleep(LOOK)


def _free_port(kind: socket.SocketKind = socket.SOCK_STREAM) -> int:
    with socket.socket(type=kind) as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port
