"""The conductor: decides, from wall time and what the participants report, how far simulation time may go."""

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field

from schemas import topics
from schemas.messages import Clock, ClockRequest, Done, Reply
from uvf.runtime.messages.step_times import NS, step_time

LONGEST_LOOK = 0.01  # s, wall: how soon a request is seen
MAX_BEHIND = 0.25  # s, wall: what a slow simulator costs beyond this is not caught up, the rate drops instead


@dataclass
class Participant:
    """A process that steps with the clock; ``autopilot.burger`` is one of those that share the work of ``autopilot``."""

    boot: int = 0
    t_ns: int = -1
    published: dict[str, int] = field(default_factory=dict)


class Conductor:
    """Advances simulation time: real time, scaled, paused, single step and lockstep, as one state machine on wall seconds.

    simulators hold the clock back always; all participants hold it back at the start and in lockstep.
    vehicles: of the mission; a kind may have a process for each.
    """

    def __init__(
        self, simulators: Iterable[str], others: Iterable[str], rate: float = 1.0, lockstep: bool = False, vehicles: Iterable[str] = ()
    ) -> None:
        self._simulators = frozenset(simulators)
        self._kinds = frozenset((*self._simulators, *others))
        self._known = self._kinds | {f"{kind}.{vehicle}" for kind in self._kinds for vehicle in vehicles}
        self._participants = {name: Participant() for name in self._kinds}
        self._rate = rate
        self._lockstep = lockstep
        self._paused = False
        self._steps_left = 0
        self._started = False
        self._allowed = 0.0  # s of simulation time that wall time has earned
        self._last_wall: float | None = None
        self._window: deque[tuple[float, int]] = deque()
        self.tick = 0
        self.t_ns = 0
        self.epoch = 1

    @property
    def started(self) -> bool:
        """Whether simulation time has begun."""
        return self._started

    def done(self, message: Done, boot: int) -> str:
        """Takes a participant's report. Returns a line to tell when a simulator has come back and time starts over."""
        kind = message.participant.partition(".")[0]
        if message.participant not in self._known:
            return ""
        self._participants.pop(kind if message.participant != kind else "", None)
        participant = self._participants.setdefault(message.participant, Participant())
        line = ""
        if not self._started and message.t_ns > 0:
            line = self._resume(message)
        # Who is known and has heard no clock yet has only been slow to hear the first one.
        restarted = participant.boot != boot and (participant.boot != 0 or (message.epoch == 0 and self.t_ns > 0))
        if restarted and kind in self._simulators and self._started:
            line = f"{message.participant} started again: everything starts afresh"
            self.reset()
        if restarted or message.epoch in (0, self.epoch):
            participant.boot, participant.published = boot, dict(message.published)
            participant.t_ns = message.t_ns if message.epoch == self.epoch else 0
        return line

    def _resume(self, message: Done) -> str:
        """A conductor that was started again takes time up where the participants stand."""
        self._started = True
        self.tick, self.t_ns, self.epoch = message.tick, message.t_ns, message.epoch
        self._allowed = self.t_ns / NS
        return f"conductor: time goes on from {self.t_ns / NS:.2f} s"

    def reset(self) -> None:
        """Starts simulation time again from zero in a new epoch."""
        self.epoch += 1
        self.tick = self.t_ns = 0
        self._allowed = 0.0
        self._window.clear()
        for participant in self._participants.values():
            participant.t_ns, participant.published = -1 if participant.t_ns < 0 else 0, {}

    def waiting_for(self) -> str:
        """Name of a participant that holds the next tick back; empty when nobody does."""
        everybody = not self._started or self._lockstep
        names = sorted(n for n in self._participants if everybody or n.partition(".")[0] in self._simulators)
        return next((n for n in names if self._participants[n].t_ns < (self.t_ns if self._started else 0)), "")

    def missing(self) -> list[str]:
        """Names of the participants that have not reported at all."""
        return sorted(name for name, p in self._participants.items() if p.t_ns < 0)

    def request(self, request: ClockRequest) -> Reply:
        """Carries out a request for the clock (rate, pause, resume, step, reset), or refuses it with the reason."""
        if request.action == ClockRequest.SET_RATE:
            if not 0 <= request.rate <= 1000:
                return Reply(accepted=False, reason=f"rate {request.rate:g}: must be 0 (as fast as it goes) to 1000")
            self._rate = request.rate
        elif request.action == ClockRequest.STEP:
            if not self._paused:
                return Reply(accepted=False, reason="not paused: pause first, then step")
            self._steps_left += 1
        elif request.action in (ClockRequest.PAUSE, ClockRequest.RESUME):
            self._paused = request.action == ClockRequest.PAUSE
        elif request.action == ClockRequest.RESET:
            self.reset()
        else:
            return Reply(accepted=False, reason=f"unknown action {request.action}")
        return Reply(accepted=True)

    def take_up(self, clock: Clock) -> None:
        """Takes over rate and pause from the last clock of a conductor before this one."""
        self._rate, self._paused = clock.rate_wanted, clock.state == Clock.PAUSED

    def advance(self, wall: float) -> Clock | None:
        """Next tick of the clock if it is due at ``wall`` [s] and nobody holds it back; else None."""
        elapsed = wall - self._last_wall if self._last_wall is not None else 0.0
        self._last_wall = wall
        if self.waiting_for():
            self._earn(elapsed)
            return None
        self._started = True
        self._earn(elapsed)
        next_ns = step_time(self.tick + 1, topics.CLOCK.hz)
        free = self._rate == 0 or self._lockstep
        if self._paused:
            if self._steps_left == 0:
                return None
            self._steps_left -= 1
            self._allowed = next_ns / NS
        elif not free and self._allowed < next_ns / NS:
            return None
        self.tick += 1
        self.t_ns = next_ns
        return self.clock(wall)

    @property
    def patience(self) -> float:
        """Longest time [s, wall] in which nothing can become due; a participant's report ends the wait."""
        if self.waiting_for() or self._paused or self._rate == 0:
            return LONGEST_LOOK
        ahead = step_time(self.tick + 1, topics.CLOCK.hz) / NS - self._allowed
        return min(max(ahead / self._rate, 0.0), LONGEST_LOOK)

    def _earn(self, elapsed: float) -> None:
        if not self._started or self._paused:
            self._allowed = self.t_ns / NS
            return
        self._allowed = min(self._allowed + elapsed * self._rate, self.t_ns / NS + MAX_BEHIND * max(self._rate, 1.0))

    def clock(self, wall: float, waiting_for: str = "") -> Clock:
        """State of the clock at ``wall`` [s] as a message; ``waiting_for`` names who has held it back for long."""
        message = Clock(tick=self.tick, t_ns=self.t_ns, epoch=self.epoch, rate_wanted=self._rate, lockstep=self._lockstep)
        message.state = Clock.PAUSED if self._paused else Clock.RUNNING
        message.waiting_for = waiting_for
        if not self._lockstep and self._rate > 0:
            message.due_wall = wall - max(self._allowed - self.t_ns / NS, 0.0) / self._rate
        message.rate = self._achieved(wall)
        if self._lockstep:
            for participant in self._participants.values():
                message.published.update(participant.published)
        return message

    def _achieved(self, wall: float) -> float:
        """Simulation seconds per wall second over the last two seconds."""
        self._window.append((wall, self.t_ns))
        while wall - self._window[0][0] >= 2.0:
            self._window.popleft()
        first_wall, first_t = self._window[0]
        return (self.t_ns - first_t) / NS / (wall - first_wall) if wall > first_wall else 0.0
