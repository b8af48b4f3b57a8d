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
from uvf.runtime.params import BadInput
from uvf.runtime.site import ROOT

PATIENCE = 180.0  # s, until time runs: kernels may have to be compiled
LOOK = 0.2  # s
OUTPUT = "up.txt"


@contextmanager
def apart(mission: Path, folder: Path) -> Iterator[Client]:
    """``uvf up`` without the page, from when time begins to run; everything it leaves is below ``folder``, the run in ``latest``.

    Raises BadInput when time does not begin to run.
    """
    endpoint, output = f"tcp/127.0.0.1:{_free_port()}", folder / OUTPUT
    command = [sys.executable, "-m", "uvf.launch.cli", "up", str(mission), "--no-gcs"]
    with output.open("wb") as out:
        process = subprocess.Popen(command, cwd=ROOT, env=_environment(endpoint, folder), stdout=out, stderr=out)
    try:
        _wait_for_time(process, output)
        with connect(endpoint) as client:
            yield client
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()


def _environment(endpoint: str, folder: Path) -> dict[str, str]:
    return {
        **os.environ,
        "UVF_ROUTER": endpoint,
        "UVF_MAVLINK_TARGETS": f"127.0.0.1:{_free_port()}",
        "UVF_MAVLINK_LISTEN": f"127.0.0.1:{_free_port()}",
        "UVF_RUNS": str(folder),
        "UVF_STATE": str(folder / "state"),
    }


def _wait_for_time(process: subprocess.Popen[bytes], output: Path) -> None:
    end = time.monotonic() + PATIENCE
    while "time runs" not in output.read_text():
        if process.poll() is not None or time.monotonic() > end:
            raise BadInput(f"'uvf up' does not begin to run: {output.read_text().strip()}")
        time.sleep(LOOK)


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port
