"""A follower's place in a formation: what it hears of the others, whether its leader is there, and the mode that keeps it there."""

from collections.abc import Mapping

from schemas.messages import NavState
from services.autopilot.air.setpoints import FlightPhase, PathSetpoint, Setpoint
from uvf.control.commands import AltitudeAirspeedSetpoint
from uvf.estimation.state import Estimate
from uvf.guidance.formation_slot import FormationSlot, SlotKeeping
from uvf.guidance.leader_track import LeaderReport, LeaderTrack
from uvf.guidance.route import Place
from uvf.guidance.separation import Threat, evasion, threat
from uvf.models.vehicle.flight_params import AirParams
from uvf.runtime.messages.convert import seconds

LOST = 1.0  # s without a word of the leader
PATIENCE = 5.0  # s, that the leader's first word is waited for
UNSURE = 10.0  # m, of an aircraft's position: one that does not know where it is is as good as silent
DRAWN = 12  # places of the trail, for display


def report(message: NavState) -> LeaderReport:
    """From ENU."""
    p, v = message.position, message.velocity
    return LeaderReport(seconds(message.timestamp), p.y, p.x, p.z, v.y, v.x, v.z, message.airspeed)


class FormationLink:
    """Who follows whom where; told before each step what the others say."""

    def __init__(self, name: str, leader: str, station: FormationSlot) -> None:
        self.name = name
        self.leader = leader
        self.station = station
        self.trail = LeaderTrack()
        self.others: dict[str, LeaderReport] = {}
        self.t = 0.0  # s, now
        self.threat: Threat | None = None
        self._begun: float | None = None  # s

    def hear(self, t: float, states: Mapping[str, NavState]) -> None:
        """What the others tell of themselves up to ``t`` [s]. A leader that is back after it was lost leaves a new trail."""
        self.t = t
        self._begun = t if self._begun is None else self._begun
        sure = {name: state for name, state in states.items() if name != self.name and state.position_sigma <= UNSURE}
        self.others.update({name: report(state) for name, state in sure.items()})
        if self.leader in sure:
            heard = self.others[self.leader]
            if self.trail.newest is not None and heard.t - self.trail.newest.t > LOST:
                self.trail = LeaderTrack()
            self.trail.add(heard)

    @property
    def is_led(self) -> bool:
        """Whether the leader was heard within the last ``LOST`` seconds."""
        newest = self.trail.newest
        return newest is not None and self.t - newest.t <= LOST

    @property
    def is_lost(self) -> bool:
        """Nothing is heard of the leader, and was not within the first seconds either."""
        waiting = self.trail.newest is None and (self._begun is None or self.t - self._begun <= PATIENCE)
        return not (self.is_led or waiting)

    @property
    def lost_reason(self) -> str:
        """What the status tells while it holds for want of a leader."""
        return f"leader {self.leader} lost: holds until it is heard again"

    @property
    def reason(self) -> str:
        """What the status tells while it follows."""
        clear = f", keeps clear of {self.threat.name}" if self.threat is not None else ""
        return f"follows {self.leader}{clear}"

    def ahead(self) -> list[Place]:
        """The trail from the station to the leader."""
        if self.trail.newest is None:
            return []
        delay = self.station.behind / self.trail.pace
        spots = (self.trail.at(self.t - delay * (1 - i / DRAWN)) for i in range(DRAWN + 1))
        return [Place(spot.north, spot.east, spot.height) for spot in spots]


class FollowMode(FlightPhase):
    """At the station behind the leader; straight on and level until the leader is heard."""

    def __init__(self, formation: FormationLink) -> None:
        self._formation = formation
        self._keeping = SlotKeeping(formation.station)
        self._height: float | None = None
        self.distance = 0.0
        """m, from the station."""

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """Setpoint of this cycle of ``dt`` [s]: towards the slot behind the leader, clear of the others."""
        formation = self._formation
        if formation.trail.newest is None:
            self._height = now.height if self._height is None else self._height
            return Setpoint(AltitudeAirspeedSetpoint(0.0, self._height, 0.0, params.trim_airspeed))
        steered = self._keeping.step(formation.trail, formation.t, now, params, dt)
        self.distance = steered.distance
        formation.threat = threat(formation.t, now, formation.others, params.follow_sep)
        if formation.threat is None:
            return Setpoint(PathSetpoint(steered.aim, steered.height, steered.climb, steered.airspeed))
        height, airspeed = evasion(formation.threat, formation.name, (steered.height, steered.airspeed), params)
        return Setpoint(PathSetpoint(steered.aim, height, 0.0, airspeed))
