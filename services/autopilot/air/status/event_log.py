"""Events: what changed since the last cycle, in words."""

from collections.abc import Iterable

from schemas.messages import Event
from services.autopilot.air.active_mode import ActiveMode
from services.autopilot.air.mode_table import FlightMode
from uvf.guidance.flyable import curve_text
from uvf.guidance.plan_follower import PlanFollower
from uvf.runtime.messages.convert import stamp


class EventLog:
    """Compares each cycle with the one before; the first cycle reports the mode it starts in."""

    def __init__(self) -> None:
        self._mode: FlightMode | None = None
        self._reason = ""
        self._armed: bool | None = None
        self._reached = -1
        self._pictures = (0, 0)
        self._notes: list[tuple[str, str]] = []
        self._curves: set[str] = set()
        self._laps = 0
        self._finished = False
        self._lost = False

    def events(self, t: float, active: ActiveMode, armed: bool) -> list[Event]:
        """What has happened since the cycle before, as events stamped ``t`` [s]."""
        navigator = active.navigator
        found: list[Event] = []
        if self._lost:
            found.append(_event(t, Event.NOTICE, "IMU back"))
        if (active.mode, active.reason) != (self._mode, self._reason):
            found.append(_event(t, Event.NOTICE, f"mode {active.mode.value}", active.reason))
        if self._armed is not None and armed != self._armed:
            found.append(_event(t, Event.NOTICE, "armed" if armed else "disarmed"))
        if navigator.reached != self._reached and navigator.reached >= 0:
            found.append(_event(t, Event.INFO, f"mission item {navigator.reached} reached"))
        if navigator.laps > self._laps:
            found.append(_event(t, Event.INFO, f"lap {navigator.laps} closed"))
        pictures = (navigator.camera.pictures, active.shutter.pictures)
        for camera, before in zip((navigator.camera, active.shutter), self._pictures, strict=True):
            if camera.pictures > before and camera.last is not None:
                north, east = camera.last
                found.append(_event(t, Event.INFO, f"camera trigger {sum(pictures)}", f"at x {east:.1f} m, y {north:.1f} m"))
        self._watch_curves(navigator)
        found += [_event(t, Event.INFO, text, cause) for text, cause in self._notes]
        self._pictures, self._notes = pictures, []
        if navigator.finished and not self._finished:
            found.append(_event(t, Event.NOTICE, "mission complete"))
        self._mode, self._reason, self._armed, self._lost = active.mode, active.reason, armed, False
        self._reached, self._laps, self._finished = navigator.reached, navigator.laps, navigator.finished
        return found

    def new_mission(self, advice: Iterable[tuple[str, str]]) -> None:
        """What is flown otherwise than it is drawn, what and why, is told; later only what changes."""
        told = list(advice)
        self._curves = {text for text, _ in told}
        self.note(told)

    def _watch_curves(self, navigator: PlanFollower) -> None:
        """A corner that has no room any more, with the wind and the bank of now, and one that has again."""
        if navigator.corner is None:
            return
        index, is_rounded = navigator.corner
        text = curve_text(index)
        if is_rounded:
            self._curves.discard(text)
        elif text not in self._curves:
            self._curves.add(text)
            self.note([(text, "its corner has no room on its legs with the wind and the bank of now")])

    def note(self, notes: Iterable[tuple[str, str]]) -> None:
        """To be told with the next events: what and why."""
        self._notes += notes

    def lost(self, t: float, missing: tuple[str, ...]) -> list[Event]:
        """At ``t`` [s] without the IMU: told once, until it is back."""
        if self._lost:
            return []
        self._lost = True
        return [_event(t, Event.CRITICAL, "IMU lost: surfaces at trim", ", ".join(missing))]


def _event(t: float, severity: Event.Severity, text: str, cause: str = "") -> Event:
    return Event(timestamp=stamp(t), severity=severity, text=text, cause=cause, source="autopilot")
