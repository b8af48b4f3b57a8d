"""``uvf up``: every process of a mission, supervised, until Ctrl-C."""

import os
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Event as Flag

from launch import catalogue, settings
from launch.launcher import LOOK, Launcher, Say, stop_flag
from launch.output import RotatingLog
from launch.runs import new_run
from launch.vehicles.mission_faults import warnings_from_outside
from launch.waits import Waits
from schemas import topics
from schemas.messages import Clock, LaunchRequest, Reply
from uvf.models.scenario import load_scenario
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.bus.interface import Query, Sample
from uvf.runtime.bus.wire import Malformed, decode, guarded
from uvf.runtime.bus.zenoh_bus import ZenohBus
from uvf.runtime.log.folder import LOG_FOLDER
from uvf.runtime.messages.refusals import Refusals

ROUTER_PATIENCE = 60.0  # s, for a router that is slow to start
ATTEMPT = 3.0  # s


@dataclass(frozen=True)
class StartOptions:
    """Options of ``uvf up``."""

    mission: str
    rate: float = 1.0
    page: bool = True
    seconds: float | None = None


def up(wanted: StartOptions, folder: Path, say: Say, new_folder: Callable[[], Path] = new_run) -> int:
    """Runs until Ctrl-C, SIGTERM or the time is over; returns the exit code. Raises BadInput before anything starts.

    A mission that is asked for meanwhile (``LAUNCH``) takes the place of the one that runs, with a folder of its own.
    """
    stop = stop_flag()
    while True:
        run = _run_once(wanted, folder, say, stop)
        if run.next_mission is None or stop.is_set():
            return 1 if run.launcher.failed else 0
        wanted, folder = replace(wanted, mission=run.next_mission), new_folder()
        say(f"mission {wanted.mission}; logs in {folder}")


def _run_once(wanted: StartOptions, folder: Path, say: Say, stop: Flag) -> "RunningMission":
    site = load_scenario(settings.mission_path(wanted.mission))
    kinds = [k for k in catalogue.needed(site) if wanted.page or k.name != "gcs"]
    for line in warnings_from_outside(site):
        say(line)
    run = RunningMission(wanted, folder, say)
    try:
        run.start([k.name for k in kinds], stop)
        run.watch(stop)
    finally:
        say("stopping")
        run.launcher.stop()
        say(f"{run.simulated:.1f} s simulated; log and output in {folder}")
    return run


def launch_fault(mission: str) -> str:
    """Why a mission that is asked for cannot be started; "" if it can."""
    names = sorted(path.stem for path in (settings.ROOT / "missions").glob("*.yaml"))
    if mission not in names:
        return f"no mission '{mission[:80]}'; {nearest(mission[:80], names)}"
    try:
        load_scenario(settings.mission_path(mission))
    except BadInput as error:
        return str(error)
    return ""


class RunningMission:
    """The processes of one run."""

    def __init__(self, wanted: StartOptions, folder: Path, say: Say) -> None:
        self._wanted = wanted
        self._say = say
        self._folder = folder
        os.environ[LOG_FOLDER] = str(folder.resolve())  # for the processes that the launcher starts
        self.launcher = Launcher("launcher", say)
        self._moving_since: float | None = None
        self._begun = time.monotonic()
        self.simulated = 0.0  # s
        self.next_mission: str | None = None
        """The mission that somebody has asked for, to take the place of this one."""

    def start(self, services: list[str], stop: Flag) -> None:
        """Starts the router first, then all others; the conductor starts time when all are there.

        Raises BadInput where no router comes; ``stop`` ends the wait for it.
        """
        mission = self._wanted.mission
        self._start("router", "router")
        bus, refuse = self._connect(stop), Refusals(self._say).refuse
        if bus is None:
            return
        bus.subscribe(topics.CLOCK.at("sys"), topics.CLOCK.qos, guarded(topics.CLOCK, self._on_clock, refuse))
        for name in ("conductor", "recorder"):
            told = topics.SYSTEM_EVENTS.by(name)
            bus.subscribe(told.at("sys"), told.qos, guarded(told, lambda event, _: self._say(event.text), refuse), depth=16)
        bus.serve(topics.LAUNCH.at("sys"), self._on_launch)
        waits, signs = Waits(self._say, services), topics.HEALTH.by("*")
        bus.subscribe(signs.at("sys"), signs.qos, guarded(signs, lambda health, _: waits.hear(health), refuse), depth=64)
        self._start("conductor", "service", "conductor", "--mission", mission, "--rate", str(self._wanted.rate))
        for name in services:
            self._start(name, "service", name, "--mission", mission)
        self._start("recorder", "record", str(self._folder), "--mission", mission)
        self.launcher.tell()

    def _connect(self, stop: Flag) -> ZenohBus | None:
        end, said = time.monotonic() + ROUTER_PATIENCE, False
        while not stop.is_set():
            try:
                return self.launcher.connect(ATTEMPT)
            except BadInput:
                self.launcher.look()  # starts a router again that has died
                if self.launcher.failed or time.monotonic() > end:
                    raise
            if not said:
                self._say("waiting for the router, which is slow to start")
                said = True
        return None

    def _start(self, name: str, *arguments: str) -> None:
        self.launcher.start(name, [*arguments], RotatingLog(self._folder / f"{name}.log").write)

    def _on_launch(self, query: Query) -> None:
        """Only missions of the project are started, by their names; one that cannot run leaves this one as it is."""
        try:
            wanted = decode(query.key, query.payload, LaunchRequest).mission
            fault = launch_fault(wanted)
        except Malformed as error:
            wanted, fault = "", str(error)
        if not fault:
            self._say(f"mission {wanted} is asked for")
            self.next_mission = wanted
        query.answer(Reply(accepted=not fault, reason=fault).SerializeToString(deterministic=True), 0)

    def _on_clock(self, clock: Clock, sample: Sample) -> None:
        self.simulated = clock.t_ns / 1e9
        if clock.tick and self._moving_since is None:
            self._moving_since = time.monotonic()
            self._say(f"time runs, {self._moving_since - self._begun:.1f} s after the start")

    def watch(self, stop: Flag) -> None:
        """Supervises until ``stop``; restarts what dies."""
        while not stop.wait(LOOK) and self.next_mission is None and not self._over() and not self._cannot_begin():
            self.launcher.look()

    def _over(self) -> bool:
        """Whether the seconds asked for have passed since time began to run."""
        wanted, since = self._wanted.seconds, self._moving_since
        return wanted is not None and since is not None and time.monotonic() - since > wanted

    def _cannot_begin(self) -> bool:
        """Whether a service has been given up that time waits for."""
        return self.launcher.failed and self._moving_since is None
