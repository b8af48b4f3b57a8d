"""What a run leaves behind, and how a client asks, the same in every mode."""

from uvf.runtime.log.recording import LogHash


class Outcome:
    """What a run has left: its toys, its messages in order, its hash."""

    def __init__(self, toys, samples):
        self.toys = toys
        self.samples = [s for s in samples if "/time/" not in s.key and "/health/" not in s.key]
        log_hash = LogHash()
        for s in sorted(self.samples, key=lambda s: (s.key, s.stamp_ns, s.seq)):
            log_hash.add(s.key, s.stamp_ns, s.seq, s.payload)
        self.hash = log_hash.hexdigest()

    def of(self, key):
        return [s for s in self.samples if s.key == key]


def ask(bus, request, owner, message, stamp):
    got = []

    def on_reply(reply, reason, at_ns):
        got.append((request.reply.FromString(reply) if reply is not None else None, reason, at_ns / 1e9))

    bus.call(request.at(owner), message.SerializeToString(), round(stamp * 1e9), on_reply)
    return got
