"""A stranger on the bus: for every line of the table and every request, messages that nobody may act upon. Seeded."""

import math
import random
from collections import Counter

from google.protobuf.descriptor import FieldDescriptor as F

from schemas import topics
from schemas.limits import BYTES, ENTRIES, LENGTHS, MOST, OPEN, PATTERNS, RANGES, TEXT, size_of
from schemas.messages import StopCommand
from uvf.runtime.bus.interface import Sample

STRANGER = 666  # its boot id
NUMBERS = (math.nan, math.inf, -math.inf, 1e300, -1e13)
TEXTS = ("x" * (TEXT + 2001), "\x1b[2J", "\u202etxt.exe", "a\x00b", "\u2066\u2069")
FLOATS = (F.TYPE_DOUBLE, F.TYPE_FLOAT)
LONG = (F.TYPE_INT64, F.TYPE_UINT64)
SOURCES = ("gcs", "client", "teleop", "mavlink", "planner", "evil", "..", "<b>")
AHEAD = 3_000_000_000  # ns, more than anybody's latency
FAR = 2**62
WEIGHTS = (20, 20, 20, 1, 20, 20, 20, 20)
"""Of the kinds of messages: the oversized ones are seldom, for each is up to a megabyte."""


class Stranger:
    """Makes samples and requests; ``sent`` counts them by what is wrong with them."""

    def __init__(self, seed, owners, largest=1e3):
        """largest: of the numbers in messages that are sound."""
        self.random = random.Random(seed)
        self.largest = largest
        self.owners = owners
        self.sent = Counter()
        self.newest = ""
        """What is wrong with what was made last."""
        self.seq = 0

    def sample(self, topic, t_ns, epoch=0):
        """One hostile message of a topic at simulation time ``t_ns``."""
        kinds = (
            self.wrong_type,
            self.random_bytes,
            self.truncated,
            self.oversized,
            self.bad_field,
            self.ahead,
            self.other_epoch,
            self.foreign,
        )
        return self.random.choices(kinds, WEIGHTS)[0](topic, t_ns, epoch)

    def _count(self, what):
        self.newest = what
        self.sent[what] += 1

    def _made(self, what, topic, payload, t_ns, epoch=0, owner=None, type_name=None):
        self._count(what)
        self.seq += 1
        owner = owner or (self.random.choice(self.owners) if topic.per_vehicle else topics.SYSTEM)
        key = topic.by(self.random.choice(SOURCES)).at(owner)
        seq = self.random.choice((self.seq, 0, 2**32, 2**64 - 1))
        return Sample(key, topic.message.DESCRIPTOR.full_name if type_name is None else type_name, payload, t_ns, seq, STRANGER, epoch)

    def wrong_type(self, topic, t_ns, epoch):
        type_name = self.random.choice(("", "uvf.v1.Nothing", "x" * 10_000, "foxglove.Pose", "\u202e"))
        return self._made("wrong type", topic, self.sound(topic.message), t_ns, epoch, type_name=type_name)

    def random_bytes(self, topic, t_ns, epoch):
        payload = b"\xff" + self.random.randbytes(self.random.randrange(1, 200))  # no message begins so
        return self._made("random bytes", topic, payload, t_ns, epoch)

    def truncated(self, topic, t_ns, epoch):
        return self._made("truncated", topic, self.sound(topic.message) + b"\x0a\x7f", t_ns, epoch)

    def oversized(self, topic, t_ns, epoch):
        most = size_of(topic.message)
        if most > 2**20:
            return self.truncated(topic, t_ns, epoch)
        return self._made("oversized", topic, bytes(most + 1), t_ns, epoch)

    def bad_field(self, topic, t_ns, epoch):
        payload = self.unsound(topic.message)
        return self._made("bad field", topic, payload, t_ns, epoch) if payload else self.random_bytes(topic, t_ns, epoch)

    def ahead(self, topic, t_ns, epoch):
        """Sound, but of a time that has not come; what does not age is no matter of time."""
        stamp = self.random.choice((t_ns + AHEAD, FAR))
        return self._made("stamped ahead", topic, self.sound(topic.message), stamp, epoch)

    def other_epoch(self, topic, t_ns, epoch):
        return self._made(
            "other epoch", topic, self.sound(topic.message), t_ns, epoch + self.random.choice((1, 2, 1000, 2**32 - 1 - epoch))
        )

    def foreign(self, topic, t_ns, epoch):
        """Sound, about somebody who is not there."""
        if not topic.per_vehicle:
            return self.random_bytes(topic, t_ns, epoch)
        owner = self.random.choice(("nobody", "sys", "..", "<img src=x onerror=alert(1)>", "A" * 500, "v" + str(self.seq)))
        return self._made("foreign owner", topic, self.sound(topic.message), t_ns, epoch, owner=owner)

    def sound(self, type_):
        """A message within all limits, of random content."""
        message = type_()
        self._fill(message, depth=0)
        return message.SerializeToString()

    def _fill(self, message, depth, most=math.inf):
        for field in message.DESCRIPTOR.fields:
            if self.random.random() < 0.3 or field.containing_oneof is not None:
                continue
            repeated = field.label == F.LABEL_REPEATED
            if field.message_type is not None:
                if field.message_type.GetOptions().map_entry or depth > 3:
                    continue
                inner = getattr(message, field.name)
                for one in [inner.add() for _ in range(2)] if repeated else [inner]:
                    one.SetInParent()
                    self._fill(one, depth + 1, MOST.get(field.full_name, math.inf) / 2)
            elif repeated:
                getattr(message, field.name).extend([self._value(field, most)] * 3)
            else:
                setattr(message, field.name, self._value(field, most))

    def _value(self, field, most):
        if field.full_name in PATTERNS:
            return "burger"
        if field.type in FLOATS:
            largest = min(self.largest, most, MOST.get(field.full_name, math.inf))
            one = min(1.0, largest)
            return self.random.choice((0.0, one, self.random.uniform(-one, one), self.random.uniform(-1, 1) * largest))
        if field.type == F.TYPE_STRING:
            return self.random.choice(("", "evil", "<script>alert(1)</script>", "../../etc/passwd"))
        if field.type == F.TYPE_BYTES:
            return self.random.randbytes(BYTES.get(field.full_name, 8))
        if field.type == F.TYPE_BOOL:
            return self.random.random() < 0.5
        if field.type == F.TYPE_ENUM:
            return self.random.choice(field.enum_type.values).number
        if field.full_name in RANGES:
            return self.random.choice((*RANGES[field.full_name], 0, 1))
        return self.random.choice((0, 1, self.random.randrange(0, 100), 2**31 - 1 if self.largest > 1e6 else 7))

    def unsound(self, type_):
        """A message with one field beyond its limits; empty where no field has any."""
        spots = list(spots_of(type_.DESCRIPTOR))
        if not spots:
            return b""
        message = type_()
        self._fill(message, depth=0)
        holder, (way, field) = message, self.random.choice(spots)
        for name in way:
            inner = getattr(holder, name)
            holder = inner.add() if hasattr(inner, "add") else inner
        self._spoil(holder, field)
        if isinstance(message, StopCommand):
            message.engaged = False  # whoever says stop is believed, however broken his words
        return message.SerializeToString()

    def _spoil(self, holder, field):
        if field.label == F.LABEL_REPEATED:
            entries = getattr(holder, field.name)
            if field.message_type is None and field.type in FLOATS:
                entries.append(self.random.choice(NUMBERS))
            elif field.message_type is None:
                most = LENGTHS.get(field.full_name, ENTRIES)
                entries.extend(["" if field.type == F.TYPE_STRING else b"" if field.type == F.TYPE_BYTES else 0] * (most + 1))
        elif field.full_name in PATTERNS:
            setattr(holder, field.name, self.random.choice(("../..", "<b>", "a b")))
        elif field.type in FLOATS:
            setattr(holder, field.name, self.random.choice(NUMBERS) if field.type == F.TYPE_DOUBLE else math.nan)
        elif field.type == F.TYPE_STRING:
            setattr(holder, field.name, self.random.choice(TEXTS))
        elif field.type == F.TYPE_ENUM:
            setattr(holder, field.name, self.random.choice((99, -1, 2**31 - 1)))
        elif field.full_name in RANGES:
            setattr(holder, field.name, RANGES[field.full_name][1] + 1)
        else:
            setattr(holder, field.name, 2**63 - 1)

    def request(self, request):
        """Key and bytes of a request that has to be refused."""
        payload = self.unsound(request.message) if self.random.random() < 0.6 else b""
        kind = "bad field" if payload else self.random.choice(("random bytes", "truncated", "oversized"))
        made = {
            "random bytes": b"\xff" + self.random.randbytes(50),
            "truncated": b"\x0a\x7f",
            "oversized": bytes(size_of(request.message) + 1),
        }
        self._count(f"request: {kind}")
        owner = self.random.choice(self.owners) if request.per_vehicle else topics.SYSTEM
        return request.by(self.random.choice(("autopilot_ground", "planner", "evil"))).at(owner), payload or made[kind]


def spots_of(type_, way=(), depth=0):
    """(way to its holder, field) of every field that can be beyond its limits."""
    for field in type_.fields:
        if field.message_type is not None and field.message_type.GetOptions().map_entry:
            continue
        if field.name in OPEN.get(type_.full_name, ()):
            continue
        if field.message_type is not None:
            if depth < 3:
                yield from spots_of(field.message_type, (*way, field.name), depth + 1)
        elif (field.type in (*FLOATS, *LONG, F.TYPE_STRING, F.TYPE_ENUM) or field.full_name in RANGES) and not field.full_name.endswith(
            "Engagement.id"
        ):
            if field.full_name != "uvf.v1.StopCommand.id":
                yield way, field
        elif field.label == F.LABEL_REPEATED and field.type != F.TYPE_BYTES:
            yield way, field
