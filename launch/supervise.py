"""``uvf supervise``: a launcher around one process, as every container has one."""

import contextlib
import sys

from launch.launcher import LOOK, Launcher, Say, stop_flag
from uvf.models.yaml_data import BadInput

CONNECT_PATIENCE = 1.0  # s, one attempt


def supervise(arguments: list[str], say: Say) -> int:
    """Runs ``uvf <arguments>`` until Ctrl-C or SIGTERM; returns the exit code. Raises BadInput for an unknown process.

    A process that is given up stays down, and the launcher stays to report that: a container that ended would be restarted,
    and with it the count of deaths.
    """
    name, stop = process_name(arguments), stop_flag()
    launcher = Launcher(f"launcher.{name}", say)
    launcher.start(name, arguments, _to_terminal)
    try:
        while not stop.wait(LOOK):
            if launcher.bus is None:
                with contextlib.suppress(BadInput):  # the router may come later, or be the process itself
                    launcher.connect(CONNECT_PATIENCE)
            launcher.look()
    finally:
        launcher.stop()
    return 1 if launcher.failed else 0


def process_name(arguments: list[str]) -> str:
    """The name by which ``uvf up`` knows a process: ``slam``, ``slam.burger`` of one vehicle, ``router``, ``recorder``. Raises BadInput."""
    match arguments:
        case ["service", name, *options]:
            words = [word for option in options for word in option.split("=")]
            vehicle = words[words.index("--vehicle") + 1 :][:1] if "--vehicle" in words else []
            return ".".join([name, *vehicle])
        case ["router", *_]:
            return "router"
        case ["record", *_]:
            return "recorder"
    raise BadInput(f"cannot supervise '{' '.join(arguments)}'; give it 'service NAME ...', 'router ...' or 'record ...'")


def _to_terminal(line: bytes) -> None:
    sys.stdout.buffer.write(line)
    sys.stdout.buffer.flush()
