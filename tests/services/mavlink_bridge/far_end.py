"""An autopilot by script at the far end of a wire: says what a test tells it to, with losses, and keeps plans by the protocol."""

import random

from services.mavlink_bridge.station import COMPONENT, SYSTEM
from uvf.mavlink import dialect as mav

DT = 0.02
PX4, ARDUPILOT = mav.MAV_AUTOPILOT_PX4, mav.MAV_AUTOPILOT_ARDUPILOTMEGA
US = SYSTEM, COMPONENT


def heartbeat(autopilot=PX4, type_=mav.MAV_TYPE_FIXED_WING, custom=50593792, base=1, status=mav.MAV_STATE_ACTIVE):
    return mav.MAVLink_heartbeat_message(type_, autopilot, base, custom, status, 3)


def ack(command, result, to=US):
    return mav.MAVLink_command_ack_message(command, result, target_system=to[0], target_component=to[1])


def text(words, severity=mav.MAV_SEVERITY_WARNING, id=0, seq=0):
    return mav.MAVLink_statustext_message(severity, words.encode(), id, seq)


def item(seq, command=16, frame=6, x=407700000, y=147900000, z=50.0, p=(0.0, 0.0, 0.0, float("nan")), kind=0):
    return mav.MAVLink_mission_item_int_message(*US, seq, frame, command, 0, 1, *p, x, y, z, kind)


def addressed(m):
    """The same item, to us."""
    head = (m.seq, m.frame, m.command, m.current, m.autocontinue, m.param1, m.param2, m.param3, m.param4)
    return mav.MAVLink_mission_item_int_message(*US, *head, m.x, m.y, m.z, m.mission_type)


class PlanKeeper:
    """The autopilot's half of the mission protocol, as its specification has it: asks for each item, and again."""

    def __init__(self, loss=0.0, seed=1):
        self.plans = {0: [], 1: [], 2: []}
        self.out = []
        self.refuse = None
        self.silent = False
        self._rng = random.Random(seed)
        self._loss = loss
        self._coming = None
        self._asked_at = 0.0

    def _lost(self):
        return self._rng.random() < self._loss

    def hear(self, t, messages):
        for m in messages:
            if not self.silent and not self._lost():
                self._take(t, m)

    def _take(self, t, m):
        kind = m.get_type()
        if kind == "MISSION_REQUEST_LIST":
            self.out.append(mav.MAVLink_mission_count_message(*US, len(self.plans[m.mission_type]), m.mission_type, 0))
        elif kind == "MISSION_REQUEST_INT":
            plan = self.plans[m.mission_type]
            if m.seq < len(plan):
                self.out.append(addressed(plan[m.seq]))
        elif kind == "MISSION_COUNT":
            if self.refuse is not None:
                self._ack(self.refuse, m.mission_type)
            else:
                self._coming = [m.mission_type, m.count, []]
                self._ask(t)
        elif kind == "MISSION_CLEAR_ALL":
            self.plans[m.mission_type] = []
            self._ack(0, m.mission_type)
        elif kind == "MISSION_ITEM_INT" and self._coming and m.seq == len(self._coming[2]):
            self._coming[2].append(m)
            if len(self._coming[2]) == self._coming[1]:
                self.plans[self._coming[0]] = self._coming[2]
                self._ack(0, self._coming[0])
                self._coming = None
            else:
                self._ask(t)

    def _ack(self, result, kind):
        self.out.append(mav.MAVLink_mission_ack_message(*US, result, kind, 0))

    def _ask(self, t):
        self._asked_at = t
        self.out.append(mav.MAVLink_mission_request_int_message(*US, len(self._coming[2]), self._coming[0]))

    def speak(self, t):
        if self._coming and t - self._asked_at > 0.25:
            self._ask(t)
        out, self.out = self.out, []
        return [m for m in out if not self.silent and not self._lost()]
