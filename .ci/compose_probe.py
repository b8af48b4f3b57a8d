"""Looks at the composed system from the host: all healthy, the page there, both vehicles seen moving by MAVSDK.

Then kills a service until it is given up: started again within 2 s, and the third time STOP ALL and an unhealthy container.
"""

import json
import math
import re
import subprocess
import time
import urllib.request
from collections.abc import Callable

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.telemetry import Telemetry

PATIENCE = 120.0  # s
MOVED = 1e-6  # deg, about 0.1 m
VICTIM = "planner"
RESPAWN = 2.0  # s


def wait(condition: Callable[[], bool], what: str) -> None:
    """Says how long it took, or ends with what did not come true."""
    begun = time.monotonic()
    while not condition():
        if time.monotonic() - begun > PATIENCE:
            raise SystemExit(f"compose: not within {PATIENCE:.0f} s: {what}")
        time.sleep(0.5)
    print(f"compose: {what} after {time.monotonic() - begun:.0f} s", flush=True)


def output(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def all_healthy() -> bool:
    ids = output("docker", "ps", "-aq", "--filter", "label=com.docker.compose.project=uvf_ci").split()
    states = [each["State"] for each in json.loads(output("docker", "inspect", *ids))]
    return len(states) >= 11 and all(s.get("Health", {}).get("Status") == "healthy" for s in states)


def page_answers() -> bool:
    with urllib.request.urlopen("http://127.0.0.1:8080/", timeout=5) as page:
        return page.status == 200


def main() -> None:
    wait(all_healthy, "all containers healthy")
    wait(page_answers, "the page answers on the host")
    # Where the containers find the host; on Linux the address of the engine's bridge.
    host = output("docker", "exec", "uvf_ci_mavlink_1", "getent", "hosts", "host.docker.internal").split()[0]
    with Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION)) as sdk:
        sdk.add_any_connection(f"udpin://{host}:14540")
        wait(lambda: len(sdk.get_systems()) == 2, "MAVSDK on the host sees two vehicles")
        telemetry = [Telemetry(system) for system in sdk.get_systems()]
        wait(lambda: all(math.isfinite(t.position().latitude_deg) for t in telemetry), "both have a position")
        before = [(t.position().latitude_deg, t.position().longitude_deg) for t in telemetry]

        def moved() -> bool:
            now = [(t.position().latitude_deg, t.position().longitude_deg) for t in telemetry]
            return all(max(abs(a - c), abs(b - d)) > MOVED for (a, b), (c, d) in zip(before, now, strict=True))

        wait(moved, "both vehicles move")
    die_three_times()


KILL_THREE_TIMES = """
import psutil, time
def life():
    found = [p for p in psutil.process_iter(["cmdline"]) if "service" in (p.info["cmdline"] or []) and "supervise" not in p.info["cmdline"]]
    return found[0] if found else None
begun = time.monotonic()
for _ in range(3):
    while (now := life()) is None and time.monotonic() < begun + 10:
        time.sleep(0.01)
    print(time.monotonic() - begun)
    begun = time.monotonic()
    now.kill()
    now.wait()
"""


def uvf(*command: str) -> str:
    return output("docker", "exec", "uvf_ci_router_1", "python", "-m", "launch.cli", *command)


def says(wanted: str, *command: str) -> Callable[[], bool]:
    return lambda: re.search(wanted, uvf(*command)) is not None


def die_three_times() -> None:
    _, *respawns = map(float, output("docker", "exec", f"uvf_ci_{VICTIM}_1", "python", "-c", KILL_THREE_TIMES).split())
    print(f"compose: started again {', '.join(f'{took:.2f} s' for took in respawns)} after kill -9")
    if max(respawns) > RESPAWN:
        raise SystemExit(f"compose: more than {RESPAWN:g} s")
    wait(says(rf"process +{VICTIM} +failed.*started again 2 times", "node", "list"), f"{VICTIM} is given up")
    wait(says("engaged: true", "topic", "echo", f"sys/cmd/launcher.{VICTIM}", "-n", "1"), "STOP ALL")
    for vehicle in ("burger", "milvus"):
        wait(says("stopped: true", "topic", "echo", f"{vehicle}/state/vehicle", "-n", "1"), f"{vehicle} has stopped or holds")
    wait(lambda: not all_healthy(), f"the container of {VICTIM} is unhealthy")


if __name__ == "__main__":
    main()
