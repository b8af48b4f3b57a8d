"""A MAVSDK script as a process of its own, and what its transcript says."""

import contextlib
import json
import os
import signal
import subprocess
import time
from pathlib import Path

FLIGHT = Path(__file__).parent / "mavsdk_flight.py"


class Script:
    """Flies one vehicle by the MAVSDK of an interpreter; its transcript stays in ``folder``."""

    def __init__(self, python, port, system_id, vehicles, transcript, *more):
        self._transcript = transcript
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        command = [str(python), str(FLIGHT), str(port), str(system_id), str(vehicles), *more]
        with transcript.open("wb") as out:
            self._process = subprocess.Popen(
                command, env=environment, cwd=transcript.parent, stdout=out, stderr=out, start_new_session=True
            )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        """With the server that MAVSDK 3 starts: neither version always lets its program end."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()

    def ends(self, seconds):
        """Whether it comes to its end within that time."""
        give_up = time.monotonic() + seconds
        while not self.has_ended():
            if time.monotonic() > give_up or self._process.poll() is not None:
                return self.has_ended()
            time.sleep(0.2)
        return True

    def has_ended(self):
        return any(step["what"] == "end" for step in self.steps())

    def said(self):
        return self._transcript.read_text(errors="replace")

    def steps(self):
        """[{t [s], what, ...}] Lines of the library between them do not count."""
        return [json.loads(line) for line in self.said().splitlines() if line.startswith('{"t":') and line.endswith("}")]

    def step(self, what):
        return next(step for step in self.steps() if step["what"] == what)

    def told(self, stream):
        """The values of a stream one after the other, from its autopilot's first word on: until then a program may have heard UNKNOWN."""
        values = [step["now"] for step in self.steps() if step["what"] == stream]
        return values[values[:1] == ["UNKNOWN"] :]

    def amiss(self):
        """What was refused or did not come in time."""
        return [step for step in self.steps() if "failed" in step]
