"""Bodies of processes for the shutdown tests: ``python -m tests.distributed.scripts CASE ENDPOINT``."""

import sys
import threading
import time

from launch.worker import worker
from schemas import topics
from uvf.runtime.bus.zenoh_bus import ZenohBus


def busy(endpoint):
    """A bus with every kind of endpoint declared."""
    bus = ZenohBus(endpoint, timeout=5.0)
    for topic in (topics.POSE, topics.MAP, topics.EVENTS.by("x"), topics.CLOCK):
        bus.subscribe(topic.at("*"), topic.qos, lambda s: None, depth=4)
        bus.publisher(topic.at("v"), "t", topic.qos).put(b"x", 1)
    bus.serve("uvf/v/srv/x", lambda q: None)
    bus.call("uvf/v/srv/none", b"", 0, lambda *a: None)
    bus.subscribe("uvf/sys/time/clock", topics.CLOCK.qos, lambda s: None, depth=4, wake=True)
    bus.token("@node/v/x/1")
    return bus


def normal_end(endpoint):
    with busy(endpoint):
        pass


def sys_exit(endpoint):
    with busy(endpoint):
        sys.exit(3)


def exception(endpoint):
    with busy(endpoint):
        raise RuntimeError("boom")


def unanswered_query(endpoint):
    with busy(endpoint) as bus:
        bus.call("uvf/v/srv/x", b"", 0, lambda *a: None)
        time.sleep(0.1)
        bus.poll()


def publishing_thread(endpoint):
    """A thread that publishes until it is told to stop, and is joined before the session closes."""
    stop = threading.Event()
    with busy(endpoint) as bus:
        publisher = bus.publisher("uvf/v/nav/pose", "t", topics.POSE.qos)
        thread = threading.Thread(target=lambda: [publisher.put(b"x" * 1000, 1) for _ in iter(stop.is_set, True)])
        thread.start()
        time.sleep(0.2)
        stop.set()
        thread.join()


def waiting(endpoint):
    """As every service: until a signal, or until its launcher is gone."""
    with worker("waiting") as life, busy(endpoint) as bus:
        sys.stdout.write("ready\n")
        sys.stdout.flush()
        while not life.stop.is_set() and not life.orphaned():
            bus.wait(0.05)
            bus.poll()


def unreachable(endpoint):
    from launch.processes import open_bus

    with worker("lonely") as life:
        sys.stdout.write("ready\n")
        sys.stdout.flush()
        open_bus(life).close()


if __name__ == "__main__":
    globals()[sys.argv[1]](sys.argv[2])
