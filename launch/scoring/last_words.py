"""Why a vehicle has not done its mission: its events from where it went wrong on, and what planner and autopilot said at the end."""

from collections import defaultdict, deque
from collections.abc import Iterator, Sequence

from launch.scoring.recorded_track import CRASHED
from launch.scoring.scores import Verdict
from schemas import topics
from schemas.messages import Event, Mode, NavStatus, VehicleStatus
from uvf.runtime.bus.interface import Bus, Sample
from uvf.runtime.messages.enum_names import enum_name

KEPT = 2000  # events of a vehicle
TOLD = 5  # of them
JUST_BEFORE = 1.0  # s


class LastWords:
    """Listens to a run on any bus (or is fed from a log) and keeps the events and last states of each vehicle."""

    def __init__(self) -> None:
        self.crashes: list[str] = []
        """A line for each aircraft that its simulator says has crashed."""
        self._events: defaultdict[str, deque[tuple[float, str]]] = defaultdict(lambda: deque(maxlen=KEPT))
        self._states: defaultdict[str, dict[str, tuple[float, str]]] = defaultdict(dict)  # by vehicle and topic: since when [s], what

    def follow(self, bus: Bus) -> None:
        """Subscribes to what vehicles say of themselves."""
        for topic in (topics.EVENTS.by("*"), topics.NAV_STATUS, topics.STATUS):
            bus.subscribe(topic.at("*"), topic.qos, self.heard, depth=256)

    def heard(self, sample: Sample) -> None:
        """Stores a sample of a vehicle; a state counts from the first message that says so."""
        _, vehicle, name = sample.key.split("/", 2)
        t = sample.stamp_ns / 1e9
        if name.startswith("state/events/"):
            event = Event.FromString(sample.payload)
            self._events[vehicle].append((t, event_text(event)))
            if event.text == CRASHED:
                self.crashes.append(f"{vehicle} crashed at {t:.1f} s: {event.cause}")
            return
        planner = name == "nav/status"
        text = _planner(NavStatus.FromString(sample.payload)) if planner else _autopilot(VehicleStatus.FromString(sample.payload))
        if self._states[vehicle].get(name, (t, ""))[1] != text:
            self._states[vehicle][name] = t, text

    def of(self, vehicle: str, since: float | None = None) -> list[str]:
        """Lines about a vehicle: events with their times, then its states with the time since when they hold [s, simulation].

        Told are the events from ``since`` [s] on, or the last ones.
        """
        events = list(self._events[vehicle])
        chosen = events[-TOLD:] if since is None else [event for event in events if event[0] >= since - JUST_BEFORE][:TOLD]
        told = [f"{vehicle} at {t:.1f} s: {text}" for t, text in chosen]
        told += [f"{vehicle} since {t:.1f} s: {text}" for t, text in self._states[vehicle].values()]
        return told or [f"{vehicle}: no event and no status was recorded"]


def why(verdicts: Sequence[Verdict], told: LastWords) -> Iterator[str]:
    """What vehicles with failed criteria did: from the first moment on that decided one, or at the end of the run."""
    failed = [verdict for verdict in verdicts if not verdict.passed]
    for vehicle in dict.fromkeys(verdict.criterion.vehicle for verdict in failed if verdict.criterion.vehicle):
        moments = [verdict.found.t for verdict in failed if verdict.criterion.vehicle == vehicle and verdict.found.t is not None]
        yield from told.of(vehicle, min(moments, default=None))


def event_text(event: Event) -> str:
    """``warning: low battery (cause: 10.5 V)``."""
    cause = f" (cause: {event.cause})" if event.cause else ""
    return f"{enum_name(Event.Severity, event.severity)}: {event.text}{cause}"


def _planner(status: NavStatus) -> str:
    job = f", job {status.job}" if status.job else ""
    return f"planner {enum_name(NavStatus.State, status.state)}{job}" + (f": {status.reason}" if status.reason else "")


def _autopilot(status: VehicleStatus) -> str:
    why = [status.reason, *status.failsafes, *(status.prearm if not status.armed else ())]
    armed = "armed" if status.armed else "disarmed"
    return f"autopilot in mode {enum_name(Mode, status.mode)}, {armed}" + "".join(f"; {reason}" for reason in why if reason)
