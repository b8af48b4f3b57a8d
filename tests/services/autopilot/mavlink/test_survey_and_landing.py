"""A plan of QGroundControl with take-off, survey and landing pattern: uploaded, flown, its landing given up once, landed, disarmed."""

import numpy as np
import pytest

from tests.services.autopilot.mavlink.airborne import Airborne
from tests.services.autopilot.mavlink.qgc_plan import items_of
from tests.services.autopilot.mavlink.rig import long
from uvf.mavlink import dialect as mav

PLAN = items_of("survey_and_landing")
TOUCH = -60.0, 0.0  # m, east and north, of NAV_LAND
CIRCLE, RADIUS, HEIGHT = (-380.0, -75.0), 75.0, 40.0  # m, of the pattern
PASSED = {i for i, item in enumerate(PLAN) if item.command >= mav.MAV_CMD_NAV_LAST}
COMPLETE = 5

pytestmark = pytest.mark.timeout(400)


class Story:
    """The flight, and what was seen of it."""

    def __init__(self):
        self.flight = flight = Airborne()
        assert flight.fly(30.0, self._ready), flight.texts()
        self.ack = self._upload()
        self.results = [flight.ask(long(176, 157.0, 4.0, 4.0))[0], flight.ask(long(400, 1.0))[0]]
        assert flight.fly(220.0, self._is_low), flight.texts()
        self.given_up_at = flight.t
        self.results.append(flight.ask(long(191, 50.0))[0])
        assert flight.fly(120.0, lambda: flight.now[0][2] > 30.0), flight.texts()
        assert flight.fly(160.0, lambda: not self._newest("HEARTBEAT").base_mode & 128), flight.texts()
        flight.fly(1.0)

    def _newest(self, kind):
        return next((m for _, m in reversed(self.flight.heard) if m.get_type() == kind), None)

    def _ready(self):
        status = self._newest("SYS_STATUS")
        return status is not None and bool(status.onboard_control_sensors_health & mav.MAV_SYS_STATUS_PREARM_CHECK)

    def _upload(self):
        self.flight.say(mav.MAVLink_mission_count_message(1, 1, len(PLAN), 0))
        for item in PLAN:
            self.flight.hears("MISSION_REQUEST_INT", 1.5, lambda m, seq=item.seq: m.seq == seq)
            self.flight.say(item)
        return self.flight.hears("MISSION_ACK", 1.5)[1].type

    def _is_low(self):
        """On the final approach, 15 m up."""
        current = self._newest("MISSION_CURRENT")
        return current.seq == len(PLAN) - 1 and self.flight.now[0][2] < 15.0

    def told(self, kind, field):
        """A field of all messages of a kind, without repetitions."""
        values = [getattr(m, field) for _, m in self.flight.heard if m.get_type() == kind]
        return [b for a, b in zip([None, *values], values, strict=False) if a != b]

    def way(self, begin=0.0):
        """(n, 3) true positions from ``begin`` [s] on."""
        return np.array([(m.position.x, m.position.y, m.position.z) for t, m in self.flight.truth if t > begin])


@pytest.fixture(scope="module")
def story():
    return Story()


def test_the_plan_is_taken_as_it_is_with_one_word_about_the_camera(story):
    assert story.ack == mav.MAV_MISSION_ACCEPTED and story.results == [0, 0, 0]
    texts = story.flight.texts()
    assert [t for t in texts if "skipped" in t] == ["Mission: camera and gimbal items are skipped"]


def test_each_waypoint_is_flown_in_its_turn_and_told_once(story):
    reached = [m.seq for _, m in story.flight.heard if m.get_type() == "MISSION_ITEM_REACHED"]
    assert reached == list(range(len(PLAN)))
    current = [seq for seq in story.told("MISSION_CURRENT", "seq") if seq not in PASSED]
    assert current == [i for i in range(len(PLAN)) if i not in PASSED]


def test_the_landing_leaves_its_circle_at_its_height_and_is_given_up_when_asked(story):
    way = story.way()
    near = np.hypot(way[:, 0] - CIRCLE[0], way[:, 1] - CIRCLE[1])
    on = (np.abs(near - RADIUS) < 5.0) & (way[:, 0] < CIRCLE[0])
    assert on.any() and np.abs(way[on, 2] - HEIGHT).max() < 4.0
    assert story.way(story.given_up_at)[:, 2].min() < 20.0 < story.way(story.given_up_at)[:, 2].max()
    assert any("go-around" in text for text in story.flight.texts())


def test_it_touches_where_the_plan_says_and_stays_on_the_strip(story):
    down = story.way(story.given_up_at + 20.0)
    first = down[np.argmax(down[:, 2] < 0.55)]
    assert abs(first[0] - TOUCH[0]) < 15.0 and abs(first[1]) < 3.0
    assert np.abs(down[down[:, 2] < 0.6, 1]).max() < 6.0


def test_it_disarms_itself_and_the_mission_is_complete(story):
    assert story.told("MISSION_CURRENT", "mission_state")[-1] == COMPLETE
    assert story.told("EXTENDED_SYS_STATE", "landed_state")[-1] == mav.MAV_LANDED_STATE_ON_GROUND


def test_nothing_pops_up_over_the_map(story):
    assert [m.text for _, m in story.flight.heard if m.get_type() == "STATUSTEXT" and m.severity <= mav.MAV_SEVERITY_ERROR] == []
