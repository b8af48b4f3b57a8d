"""A ground station and an aircraft that circles at the start, with what tests of single flights share."""

import msgspec
import numpy as np
import pytest

from services.autopilot.mavlink.build import facts_of
from tests.services.autopilot.mavlink.airborne import Airborne, field
from tests.services.autopilot.mavlink.parameters.test_parameters import setting, value
from uvf.mavlink import dialect as mav
from uvf.models.scenario import MissionVehicle

REAL = mav.MAV_PARAM_TYPE_REAL32
ALTITUDE, HOLD, MISSION, RETURN, LAND = 0x00020000, 0x03040000, 0x04040000, 0x05040000, 0x06040000
ACCEPTED = 0


def in_the_air(*faults):
    """Milvus in Hold over the airfield, in a light wind."""
    site = field()
    member = site.members["milvus"]
    start = msgspec.structs.replace(member.entry.start, x=0.0, y=0.0, z=80.0, speed=25.0)
    entry = msgspec.structs.replace(member.entry, start=start)
    site.members["milvus"] = MissionVehicle(member.name, entry, member.file, member.folder)
    site.mission.faults.extend(faults)
    return site


class Station(Airborne):
    """Sends heartbeats, and sticks, as long as told to."""

    def __init__(self, site):
        super().__init__(site)
        self.linked, self.sticks = True, False
        self.facts = facts_of(site)[0]

    def _tick(self, t):
        if self.linked and round(t * 100) % 100 == 0:
            self.say(mav.MAVLink_heartbeat_message(mav.MAV_TYPE_GCS, mav.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3))
        if self.sticks and round(t * 100) % 4 == 0:
            self.say(mav.MAVLink_manual_control_message(1, 0, 0, 500, 0, 0))
        return super()._tick(t)

    def newest(self, kind):
        return next((m for _, m in reversed(self.heard) if m.get_type() == kind), None)

    @property
    def mode(self):
        return self.newest("HEARTBEAT").custom_mode

    def set(self, name, number, kind=REAL):
        """Waits, as QGroundControl does, until it is told."""
        self.say(setting(name, number, kind))
        self.hears("PARAM_VALUE", 1.0, lambda m: m.param_id == name and value(m) == pytest.approx(number, rel=1e-6, abs=1e-9))

    def take(self, mode):
        self.say(mav.MAVLink_set_mode_message(1, 157, mode))
        self.hears("HEARTBEAT", 1.0, lambda m: m.custom_mode == mode)

    def told(self, text, since=0.0):
        """Times [s]."""
        return [t for t, m in self.heard if m.get_type() == "STATUSTEXT" and m.text.startswith(text) and t > since]

    def until(self, seconds, sees):
        """s until it has become so."""
        begun = self.t
        assert self.fly(seconds, sees), (self.t, self.mode, self.texts()[-8:])
        return self.t - begun

    def upload(self, items, kind=0):
        """The result of the final acknowledgement."""
        self.say(mav.MAVLink_mission_count_message(1, 1, len(items), kind))
        while (m := self._next("MISSION_REQUEST_INT", "MISSION_ACK")).get_type() != "MISSION_ACK":
            self.say(items[m.seq])
        return m.type

    def _next(self, *kinds):
        """The next message of one of these kinds."""
        seen, found = len(self.heard), []

        def came():
            found.extend(m for _, m in self.heard[seen:] if m.get_type() in kinds)
            return bool(found)

        assert self.fly(2.0, came, 0.02)
        return found[0]

    def item(self, seq, command, p=(0.0,) * 4, place=(0.0, 0.0, 0.0), kind=0):
        """place: x, y [m, world], z above home."""
        latitude, longitude, _ = self.facts.geodetic(np.array(place))
        e7 = (round(latitude * 1e7), round(longitude * 1e7))
        return mav.MAVLink_mission_item_int_message(1, 1, seq, 3, command, 0, 1, *p, *e7, place[2], kind)

    def centre(self):
        """(2,) m, world, of the circle that is flown."""
        target = self.newest("POSITION_TARGET_GLOBAL_INT")
        place = self.facts.world(target.lat_int * 1e-7, target.lon_int * 1e-7, 0.0)
        return np.array((place.x, place.y))

    def radii(self, seconds):
        """m, from that centre, lately."""
        places = [(m.position.x, m.position.y) for t, m in self.truth if t > self.t - seconds]
        return np.hypot(*(np.array(places) - self.centre()).T)


def circling(site):
    """The station, once the aircraft has told that it holds."""
    flight = Station(site)
    assert flight.fly(20.0, lambda: flight.newest("HEARTBEAT") is not None and flight.mode == HOLD)
    flight.fly(3.0)
    return flight
