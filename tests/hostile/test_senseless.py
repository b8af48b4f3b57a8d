"""What is within the limits of the schema and still senseless raises nothing in any service: impossible sensors, plans of another world."""

import os
import traceback

import pytest

from launch import catalogue
from schemas import topics
from tests.hostile.bus_client import Stranger
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.time.lockstep import Lockstep

SECONDS = float(os.environ.get("UVF_HOSTILE_SECONDS", "6"))
A_TICK = 4  # messages to each instance
TO_A_SIMULATOR = 0.1  # of the ticks: it steps more often than the others together
LARGEST = 1e11
TIMES = (topics.CLOCK, topics.DONE)  # who forges these stops or turns back time, and is told so: docs/explanation/security.md


class Beset:
    """A mission in lockstep in which everybody hears senseless things about everything that it reads."""

    def __init__(self, mission, seed):
        site = load_scenario(ROOT / "missions" / f"{mission}.yaml")
        kinds = [kind for kind in catalogue.needed(site) if kind.clock == "sim" and kind.name != "sim_camera"]
        self.lockstep = Lockstep(catalogue.hosts(site, kinds), LocalBus())
        self.stranger = Stranger(seed, sorted(site.members), LARGEST)
        self.faults = {}
        for shell in self.lockstep.shells:
            self._watch(shell)

    def _watch(self, shell):
        step = shell._step

        def watched(t_ns):
            try:
                step(t_ns)
            except Exception as error:  # noqa: BLE001  # whatever it is, it is what is looked for
                self.faults[f"{shell.type.name}: {error!r}"] = traceback.format_exc()
                shell._make()
                shell._listen()

        shell._step = watched

    def _at_tick(self, t):
        for shell in self.lockstep.shells:
            reads = [(name, d.topic) for name, d, _ in shell.reads() if name in shell._boxes and d.topic not in TIMES]
            if not reads or (shell.type.simulator and self.stranger.random.random() > TO_A_SIMULATOR):
                continue
            for _ in range(A_TICK):
                name, topic = self.stranger.random.choice(reads)
                payload = self.stranger.sound(topic.message)
                shell._boxes[name].push(self.stranger._made("senseless", topic, payload, round(t * 1e9) - 1))
        return True

    def run(self, until):
        self.lockstep.run(until, self._at_tick)
        self.lockstep.close()


@pytest.mark.parametrize("mission", ["demo", "team"])
def test_nobody_raises(mission):
    beset = Beset(mission, seed=5)
    beset.run(SECONDS)
    assert not beset.faults, "\n".join(beset.faults.values())
    assert beset.stranger.sent["senseless"] > 1000 * SECONDS
