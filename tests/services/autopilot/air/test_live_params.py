"""Every parameter of the autopilot is read where it is used, in each cycle of the modes it is for: none is copied when it starts."""

import pytest

from schemas.messages import Battery, Fence, FenceRequest, FenceZone, Link, Mode, ModeRequest, Vector3
from tests.services.autopilot.air.sensing import Bench
from tests.services.autopilot.air.test_manual_control import is_manual
from tests.services.live_params import all_settable_are_read
from uvf.models.scenario import ROOT

ELSEWHERE = {
    "follow_p": "src/uvf/guidance/formation_slot.py",
    "follow_i": "src/uvf/guidance/formation_slot.py",
    "follow_sep": "src/uvf/guidance/separation.py",
    "takeoff_pitch": "services/autopilot/air/modes/takeoff.py",
    "launch_push": "services/autopilot/air/modes/takeoff.py",
    "land_flap": "services/autopilot/air/modes/landing.py",
    "descend_alt": "services/autopilot/air/modes/return_mode.py",
    "gnss_action": "services/autopilot/air/failsafes/table.py",
    "link_action": "services/autopilot/air/failsafes/table.py",
    "attitude_action": "services/autopilot/air/failsafes/table.py",
    "wind_action": "services/autopilot/air/failsafes/table.py",
}
"""Of states that this flight does not come to: the module that is handed the parameters of each cycle and reads it."""


def mode(wanted):
    return [ModeRequest(mode=Mode.Value(f"MODE_{wanted}"))]


def test_each_is_read_in_flight():
    bench = Bench()
    bench.run(10)
    with all_settable_are_read(bench.service, ELSEWHERE):
        bench.run(60, link=Link(stations=1), battery=Battery(remaining=0.01))
        for wanted in ("HOLD", "RETURN", "MISSION", "LAND", "ALTITUDE", "STABILIZED"):
            is_manual(bench, 10, mode=mode(wanted))
        bench.run(60)
        zone = FenceZone(centre=Vector3(x=500.0), radius=900.0)
        bench.run(fence=[FenceRequest(fence=Fence(zones=[zone], ceiling=200.0, floor=-50.0))])
        bench.run(10)


@pytest.mark.parametrize(("name", "module"), ELSEWHERE.items())
def test_the_others_are_read_of_what_each_cycle_is_handed(name, module):
    text = (ROOT / module).read_text()
    assert f"params.{name}" in text or f'_chosen("{name}")' in text
