"""A stranger before the whole system, started as a person starts it: on its bus, on its MAVLink port and on the page's socket.

By hand: ``python -m tests.hostile.live_storm MISSION MESSAGES``; a million of them take some minutes.
"""

import asyncio
import contextlib
import itertools
import random
import socket
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import psutil
import websockets
import zenoh

from schemas import topics
from schemas.messages import Health, Process, VehicleStatus
from tests.distributed.system import System
from tests.hostile import mavlink_client
from tests.hostile.bus_client import STRANGER, Stranger
from tests.hostile.test_page_socket import CAMERA, nonsense, pack
from tests.services.gcs.wire import Browser, connect
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.bus.envelope import Envelope
from uvf.runtime.bus.wire import Malformed, decode_sample
from uvf.runtime.bus.zenoh_bus import ZenohBus
from uvf.runtime.messages.topic_lookup import topic_of

A_BURST = 200
ASKED = 10  # requests in a burst
PAGE_EVERY = 20  # bursts
WAITING_MOST = 200
"""Requests without an answer, of which there may be so many before the next ones are sent."""
AHEAD = 60_000_000_000  # ns
BELIEVED = (topics.CLOCK, topics.DONE, topics.STOP, topics.STOP_STATE, topics.EXTERNAL_VEHICLE)
"""Of which a sound message is believed, whoever sends it: docs/explanation/security.md. What is broken is refused there too."""
TYPE_MOST = 200  # characters; of longer ones Zenoh's own client panics before it sends them


EVERY_KEY = {*(t.key for t in topics.TOPICS.values()), *(r.key for r in topics.REQUESTS.values()), "UDP", "websocket"}


def dealt(dice, cards):
    """All cards in random order, again and again: none is left out for long."""
    cards = list(cards)
    while True:
        yield from dice.sample(cards, len(cards))


class Ear:
    """What the services themselves say, whatever the stranger says on their keys."""

    def __init__(self, bus):
        self._bus = bus
        self.status, self.health = {}, {}
        self.position, self.clock = {}, None
        for topic in (topics.STATUS.at("*"), topics.HEALTH.by("*").at("sys"), topics.CLOCK.at("sys"), topics.TRUTH.at("*")):
            bus.subscribe(topic, topics.Qos.STATE, self._take, depth=256)

    def _take(self, sample):
        if sample.boot == STRANGER:
            return
        topic = topic_of(sample.key)
        try:
            message = decode_sample(sample, topic.message)
        except Malformed as error:
            raise AssertionError(f"one of ours sends what is refused: {error}") from error
        if isinstance(message, VehicleStatus):
            self.status[sample.key.split("/")[1]] = message
        elif isinstance(message, Health):
            self.health[message.service] = message
        elif topic is topics.CLOCK:
            self.clock = message
        else:
            self.position[sample.key.split("/")[1]] = message.position

    def wait(self, condition, seconds, what):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, what
            time.sleep(0.005)
            self._bus.poll()


class Storm:
    """On a system that runs, with its page. ``sent`` counts by border, key and what is wrong."""

    def __init__(self, system, mission, seed):
        self.system, self.sent, self.answers = system, Counter(), Counter()
        self.members = sorted(load_scenario(ROOT / "missions" / f"{mission}.yaml").members)
        self._dice = random.Random(seed)
        self._topics = dealt(self._dice, topics.TOPICS.values())
        self._requests = dealt(self._dice, topics.REQUESTS.values())
        self._bursts = itertools.count()
        self._stranger = Stranger(seed, self.members)
        self._bus = ZenohBus(system.endpoint, timeout=10.0)
        self.ear = Ear(self._bus)
        self._session = self._bus._session
        self._waiting = []
        self._udp = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(4)]
        self._mavlink = ("127.0.0.1", int(system.environment["UVF_MAVLINK_LISTEN"].rpartition(":")[2]))
        self.browser = Browser(system.page)
        everybody = set(self.members)
        self.ear.wait(lambda: self.ear.clock and set(self.ear.status) == everybody, 60.0, "not all vehicles tell their state")
        self._family = {
            name: psutil.Process(process.pid) for name, process in system.children().items() if process.state == Process.RUNNING
        }
        self._family["launcher"] = psutil.Process(system.popen.pid)
        self.before = self.megabytes()

    def close(self):
        self.browser.close()
        for sock in self._udp:
            sock.close()
        self._bus.close()
        sys.stderr.write("".join(f"{line}\n" for line in self._deaths()))

    def megabytes(self):
        """Memory of each process, all of which are there yet."""
        gone = [name for name, process in self._family.items() if not process.is_running()]
        assert gone == [], self._deaths()
        return {name: process.memory_info().rss / 1e6 for name, process in self._family.items()}

    @property
    def count(self):
        return sum(self.sent.values())

    def burst(self):
        for _ in range(A_BURST):
            self._say(next(self._topics))
        for _ in range(ASKED):
            self._ask()
        for _ in range(ASKED):
            self._datagram()
        if next(self._bursts) % PAGE_EVERY == 0:
            self._to_the_page()
        self._bus.poll()
        self._hear()

    def _say(self, topic):
        clock = self.ear.clock
        if topic in BELIEVED:
            what, make = self._dice.choice(
                (
                    ("truncated", self._stranger.truncated),
                    ("random bytes", self._stranger.random_bytes),
                    ("bad field", self._stranger.bad_field),
                )
            )
            sample = make(topic, clock.t_ns, clock.epoch)
        else:
            sample = self._stranger.sample(topic, clock.t_ns + AHEAD, clock.epoch)
        what = self._stranger.newest
        with contextlib.suppress(zenoh.ZError):  # keys that Zenoh itself does not take
            self._session.put(
                sample.key,
                sample.payload,
                encoding=f"application/protobuf;{sample.type_name[:TYPE_MOST]}",
                attachment=Envelope(sample.seq, sample.stamp_ns, STRANGER, sample.epoch).pack(),
            )
            self.sent["bus", topic.key, what] += 1

    def _ask(self):
        if len(self._waiting) >= WAITING_MOST:
            return
        request = next(self._requests)
        key, payload = self._stranger.request(request)
        replies = self._session.get(key, payload=payload, attachment=Envelope(0, self.ear.clock.t_ns, STRANGER, 0).pack(), timeout=5.0)
        self._waiting.append((request, replies))
        self.sent["request", request.key, self._stranger.newest] += 1

    def _hear(self):
        """Answers: each a refusal."""
        waiting = []
        for request, replies in self._waiting:
            try:
                reply = replies.try_recv()
            except zenoh.ZError:
                self.answers[request.key, "nobody is asked there"] += 1
                continue
            if reply is None:
                waiting.append((request, replies))
            elif reply.ok is None:
                said = reply.err.payload.to_string()
                self.answers[request.key, "no answer" if said == "Timeout" else "refused as broken"] += 1
            else:
                assert not request.reply.FromString(reply.ok.payload.to_bytes()).accepted, request.key
                self.answers[request.key, "refused"] += 1
        self._waiting = waiting

    def _datagram(self):
        """Frames that are broken, and any message to somebody who is not there: what an operator could say would be done."""
        kind = self._dice.choice(mavlink_client.KINDS)
        packet = mavlink_client.framed(
            kind, mavlink_client.payload(self._dice, kind), self._dice.randrange(1, 250), self._dice.randrange(256)
        )
        what = self._dice.choice(("broken frame", "random bytes"))
        if what == "broken frame":
            at = self._dice.randrange(1, len(packet))
            packet = packet[:at] + bytes((packet[at] ^ 0x55,)) + packet[at + 1 :]
        else:
            packet = self._dice.randbytes(self._dice.randrange(1, 1400))
        self._dice.choice(self._udp).sendto(packet, self._mavlink)
        self.sent["MAVLink", "UDP", what] += 1

    def _to_the_page(self):
        ids = list(self.browser.elements)
        payloads = [nonsense(self._dice, [*ids, "root", ""]) for _ in range(20)]
        asyncio.run(_join_and_send(self.system.page, payloads))
        self.sent["page", "websocket", "nonsense"] += len(payloads)

    def stop_all_works(self):
        """Engaged and released in the midst of it, as a person's own program does."""
        self.system.client.stop_all("storm")
        self.ear.wait(self._meanwhile(lambda: all(status.stopped for status in self.ear.status.values())), 30.0, "not all are stopped")
        self.system.client.wait(lambda: "storm" in self.browser.html(), 30.0, "the page does not show who stops all")
        self.system.client.release_stop()
        self.ear.wait(self._meanwhile(lambda: not any(status.stopped for status in self.ear.status.values())), 30.0, "not released")

    def the_page_works(self):
        shown = self.browser.html()
        self.ear.wait(self._meanwhile(lambda: self.browser.html() != shown), 20.0, "the page stands still")
        assert self.browser.alive

    def time_goes_on(self):
        epoch, then = self.ear.clock.epoch, self.ear.clock.t_ns
        self.ear.wait(self._meanwhile(lambda: self.ear.clock.t_ns > then + 1_000_000_000), 30.0, "time stands")
        assert self.ear.clock.epoch == epoch

    def nobody_has_died(self):
        self.megabytes()
        restarted = {p.name: p.reason for p in self.system.children().values() if p.restarts or p.state != Process.RUNNING}
        assert restarted == {}, self._deaths()

    def _deaths(self):
        return [line for line in self.system.said().splitlines() if "ended" in line or "given up" in line]

    def _meanwhile(self, condition):
        def storms_on():
            self.burst()
            return condition()

        return storms_on

    def table(self):
        """What was sent and refused, as Markdown."""
        kinds = sorted({what for _, _, what in self.sent})
        rows = sorted({(border, key) for border, key, _ in self.sent})
        yield f"| border | key | {' | '.join(kinds)} |"
        yield f"|---|---|{'---:|' * len(kinds)}"
        for border, key in rows:
            yield f"| {border} | {key} | {' | '.join(str(self.sent[border, key, kind] or '') for kind in kinds)} |"
        yield "\n| answers to requests | count |\n|---|---:|"
        for why, count in Counter({why: sum(n for (_, w), n in self.answers.items() if w == why) for _, why in self.answers}).most_common():
            yield f"| {why} | {count} |"
        yield "\n| process | refused | MB before | MB after | most often |\n|---|---:|---:|---:|---|"
        after = self.megabytes()
        for name in sorted(after):
            health = self.ear.health.get(name, Health())
            first = "; ".join(f"{r.count} x {r.key}: {r.why[:70]}" for r in health.refusals[:2])
            yield f"| {name} | {health.malformed} | {self.before[name]:.0f} | {after[name]:.0f} | {first} |"


async def _join_and_send(port, payloads):
    async with connect(port) as client:
        with contextlib.suppress(websockets.ConnectionClosed):
            for payload in (pack(CAMERA), *payloads):
                await client.send(payload)


@contextlib.contextmanager
def storm_on(runs, mission, seed=1):
    with System(runs, page=True, mission=mission) as system, contextlib.closing(Storm(system, mission, seed)) as storm:
        yield storm


def main(mission, messages):
    with tempfile.TemporaryDirectory() as runs, storm_on(Path(runs), mission) as storm:
        begun, each = time.monotonic(), max(messages // 10, 1)
        while storm.count < messages:
            end = storm.count + each
            while storm.count < end:
                storm.burst()
            storm.stop_all_works()
            storm.the_page_works()
            storm.time_goes_on()
            storm.nobody_has_died()
            grown = {name: round(now - storm.before[name]) for name, now in storm.megabytes().items()}
            sys.stderr.write(
                f"{storm.count} sent in {time.monotonic() - begun:.0f} s, {storm.ear.clock.t_ns / 1e9:.0f} s simulated, MB more: {grown}\n"
            )
        sys.stdout.write("\n".join(storm.table()) + "\n")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
