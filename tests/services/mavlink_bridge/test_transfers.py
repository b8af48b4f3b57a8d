"""The mission protocol as a client, against a keeper of plans that loses packets, refuses, falls silent."""

import pytest

from services.mavlink_bridge.connection import Wire
from services.mavlink_bridge.transfers import Transfers
from tests.services.mavlink_bridge.far_end import DT, PlanKeeper, item, text
from uvf.mavlink import dialect as mav
from uvf.runtime.mavlink.mission_items import ORIGIN, packed, unpacked

OTHER_STATION = (255, 190)


class Exchange:
    def __init__(self, loss=0.0, seed=1):
        self.wire = Wire(1, 1)
        self.transfers = Transfers(self.wire)
        self.keeper = PlanKeeper(loss, seed)
        self.handlers = self.transfers.handlers()
        self.sent, self.ended = [], []

    def run(self, seconds, until=lambda: False):
        for _ in range(round(seconds / DT)):
            self.wire.t += DT
            self.transfers.tick()
            out = self.wire.take_out()
            self.sent += out
            self.keeper.hear(self.wire.t, out)
            for m in self.keeper.speak(self.wire.t):
                self.hear(m)
            if until():
                return

    def hear(self, message):
        if message.get_type() == "STATUSTEXT":
            self.wire.hear_text(message)
        else:
            self.handlers[message.get_msgId()](message)

    def read(self, kind=0):
        self.transfers.read(kind, lambda items, why, opaque: self.ended.append((items, why)))

    def write(self, items, kind=0):
        self.transfers.write(kind, [unpacked(packed(i)) for i in items], lambda good, why, opaque: self.ended.append((good, why)))


def plan(n, kind=0):
    return [item(i, x=407700000 + 1000 * i, kind=kind) for i in range(n)]


def bodies(items):
    return [ORIGIN.pack(*unpacked(packed(i))) for i in items]


@pytest.mark.parametrize(("loss", "seed"), [(0.0, 1), (0.2, 1), (0.2, 2), (0.3, 3)])
def test_a_plan_comes_down_whole_whatever_is_lost(loss, seed):
    x = Exchange(loss, seed)
    x.keeper.plans[0] = plan(30)
    x.read()
    x.run(60.0, lambda: x.ended)
    ((items, why),) = x.ended
    assert [ORIGIN.pack(*i) for i in items] == bodies(x.keeper.plans[0]) and why == ""


@pytest.mark.parametrize(("loss", "seed"), [(0.0, 1), (0.2, 1), (0.2, 2), (0.3, 3), (0.2, 4), (0.2, 5)])
def test_a_plan_goes_up_whole_whatever_is_lost_also_when_the_last_word_is(loss, seed):
    x = Exchange(loss, seed)
    x.write(plan(30))
    x.run(60.0, lambda: x.ended)
    assert x.ended == [(True, "")]
    assert bodies(x.keeper.plans[0]) == bodies(plan(30))


def test_an_upload_whose_last_word_never_comes_is_read_back():
    x = Exchange()
    x.keeper._ack = lambda result, kind: None
    x.write(plan(3))
    x.run(10.0, lambda: x.ended)
    assert x.ended == [(True, "")]


def test_and_is_refused_when_something_else_is_there():
    x = Exchange()
    x.keeper._ack = lambda result, kind: x.keeper.plans[0].pop()
    x.write(plan(3))
    x.run(10.0, lambda: x.ended)
    assert x.ended == [(False, "the autopilot has another plan than was sent")]


def test_a_refused_plan_bears_the_reason_and_the_words():
    x = Exchange()
    x.keeper.refuse = mav.MAV_MISSION_NO_SPACE
    x.write(plan(3))
    x.run(0.06)
    x.hear(text("Mission refused: 3 items; 2 are possible"))
    x.run(1.0)
    assert x.ended == [(False, "too many items: Mission refused: 3 items; 2 are possible")]


def test_an_empty_plan_clears():
    x = Exchange()
    x.keeper.plans[0] = plan(3)
    x.write([])
    x.run(1.0)
    assert x.ended == [(True, "")] and x.keeper.plans[0] == []


@pytest.mark.parametrize("job", ["read", "write"])
def test_an_autopilot_that_says_nothing_is_given_up(job):
    x = Exchange()
    x.keeper.silent = True
    x.read() if job == "read" else x.write(plan(2))
    x.run(12.0)
    assert len(x.ended) == 1 and not x.ended[0][0] and "autopilot does not" in x.ended[0][1]


def test_one_that_stops_asking_in_the_middle_is_given_up():
    x = Exchange()
    x.write(plan(200))
    x.run(0.5)
    x.keeper.silent = True
    x.run(8.0)
    assert x.ended == [(False, "the autopilot stopped asking for items 5 s ago")]


def test_jobs_wait_for_one_another_and_all_kinds_end():
    x = Exchange()
    for kind in (0, 1, 2):
        x.keeper.plans[kind] = plan(2 + kind, kind)
    x.read(0)
    x.read(1)
    x.write(plan(5, 2), 2)
    x.run(5.0)
    assert [len(x.ended[0][0]), len(x.ended[1][0]), x.ended[2]] == [2, 3, (True, "")]
    assert len(x.keeper.plans[2]) == 5


def test_what_is_meant_for_another_station_or_kind_of_plan_is_not_ours():
    x = Exchange()
    x.keeper.silent = True
    x.read()
    x.run(0.1)
    x.hear(mav.MAVLink_mission_count_message(*OTHER_STATION, 5, 0, 0))
    x.hear(mav.MAVLink_mission_count_message(255, 240, 5, 1, 0))
    x.hear(item(0))
    x.run(0.5)
    assert [m.get_type() for m in x.sent] == ["MISSION_REQUEST_LIST"] and not x.ended


def test_repeated_items_count_once():
    x = Exchange()
    x.keeper.silent = True
    x.read()
    x.run(0.1)
    x.hear(mav.MAVLink_mission_count_message(255, 240, 2, 0, 0))
    for seq in (0, 0, 1, 1):
        x.hear(item(seq, x=400000000 + seq))
    assert [i[7] for i in x.ended[0][0]] == [400000000, 400000001]


def test_older_autopilots_ask_with_the_older_request():
    x = Exchange()
    x.keeper.silent = True
    x.write(plan(1))
    x.run(0.1)
    x.hear(mav.MAVLink_mission_request_message(255, 240, 0, 0))
    assert x.wire.take_out()[-1].get_type() == "MISSION_ITEM_INT"
    x.hear(mav.MAVLink_mission_ack_message(255, 240, 0, 0, 0))
    assert x.ended == [(True, "")]


def test_a_count_out_of_all_reason_is_refused():
    x = Exchange()
    x.keeper.silent = True
    x.read()
    x.run(0.1)
    x.hear(mav.MAVLink_mission_count_message(255, 240, 60000, 0, 0))
    assert x.ended == [(None, "a plan of 60000 items")]
