"""A watch that hears what a test says, and tokens as living services declare them."""

from schemas import topics
from services.gcs.watch import WatchedMessage


class FakeWatch:
    def __init__(self):
        self.on = self.closed = False
        self.starts = 0
        self.heard = []
        self.told = None

    def start(self):
        self.on, self.starts = True, self.starts + 1

    def stop(self):
        self.on = False

    def samples(self):
        taken, self.heard = self.heard, []
        return taken

    def tokens(self):
        return self.told

    def close(self):
        self.closed = True

    def say(self, key, message, boot=1):
        self.heard.append(WatchedMessage(key, message.DESCRIPTOR.full_name, message.SerializeToString(), 0.0, boot))


class LocalWatch(FakeWatch):
    """Hears, while it is on, what is said on a bus inside this process."""

    def __init__(self, bus):
        super().__init__()
        bus.subscribe("uvf/**", topics.Qos.STATE, self._hear)

    def _hear(self, sample):
        if self.on:
            self.heard.append(WatchedMessage(sample.key, sample.type_name, sample.payload, 0.0, sample.boot, sample.stamp_ns * 1e-9))


def service_tokens(name, boot=1, pub=(), sub=(), need=()):
    """Tokens of ``owner/service``; its endpoints as topics of the owner, or keys."""
    owner = name.partition("/")[0]
    ends = [(way, one) for way, some in (("pub", pub), ("sub", sub), ("need", need)) for one in some]
    tokens = [f"@node/{name}/{boot:x}"]
    for way, one in ends:
        key, kind = (one, "x") if isinstance(one, str) else (one.at(owner), one.message.DESCRIPTOR.full_name)
        tokens.append(f"@ep/{name}/{way}/{key.replace('/', '%').replace('*', '+')}/{kind}")
    return tokens
