"""An autopilot that dies in flight is taken up by the next one: mode, lap, item, attitude, parameters."""

import numpy as np
import pytest

from schemas import topics
from schemas.messages import Mode, ParamRequest
from tests.services.autopilot.air.test_flight import Flight, distance_to_circuit

GONE = 3.0  # s


@pytest.mark.parametrize("dies_at", [38.0, 44.0])
def test_the_flight_goes_on_where_it_was(dies_at):
    flight = Flight()
    newest = {}
    for topic in (topics.STATUS, topics.MISSION, topics.PROGRESS, topics.NAV_STATE, topics.PARAMS.by("autopilot_air")):
        flight.bus.subscribe(topic.at("milvus"), topic.qos, lambda sample: newest.update({sample.key: sample.payload}))
    setting = ParamRequest(name="takeoff_alt", value="77.0").SerializeToString()
    flight.bus.call(topics.PARAM.by("autopilot_air").at("milvus"), setting, 0, lambda *answer: None)
    flight.lockstep.run(dies_at)
    before = flight.progress[-1][1]
    (shell,) = [s for s in flight.lockstep.shells if s.type.name == "autopilot_air"]
    shell.restart(0)
    shell.recall(newest.get)
    shell.skip_to(round((dies_at + GONE) * 1e9))
    flight.lockstep.run(dies_at + 60.0)
    after, status = flight.progress[-1][1], flight.status[-1][1]
    assert shell.service.params.takeoff_alt == 77.0
    assert (after.laps, after.reached) > (before.laps, before.reached)
    assert status.mode == Mode.MODE_MISSION and status.armed
    assert np.abs(flight.positions(after=dies_at)[:, 2] - 60.0).max() < 20.0
    assert max(map(distance_to_circuit, flight.positions(after=dies_at + 25.0))) < 15.0
