"""A run of a simulator in lockstep that can be asked things between two moments."""

from collections import defaultdict

from uvf.runtime.time.lockstep import Lockstep


class Asked:
    """``own``: the vehicle that is meant when none is named."""

    def __init__(self, hosts, own, topics):
        self.own = own
        self.lockstep = Lockstep(hosts)
        self.heard = defaultdict(list)
        for topic in topics:
            keep = lambda sample, kind=topic.message: self.heard[sample.key].append(kind.FromString(sample.payload))  # noqa: E731
            self.lockstep.bus.subscribe(topic.at("*" if topic.per_vehicle else "sys"), topic.qos, keep)

    def ask(self, request, message, until):
        """The reply; what is asked for is done 0.05 s before ``until`` [s]."""
        got, stamp = [], round((until - 0.05) * 1e9)
        self.lockstep.bus.call(request.at("sys"), message.SerializeToString(), stamp, lambda reply, reason, _: got.append((reply, reason)))
        self.lockstep.run(until)
        return request.reply.FromString(got[0][0])

    def of(self, topic, owner=""):
        return self.heard[topic.at(owner or self.own)]
