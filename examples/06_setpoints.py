"""An outside program flies an aircraft by course, altitude and airspeed: about, higher and slower. Start ``./uvf up`` first.

    .venv/bin/python examples/06_setpoints.py

The autopilot keeps its limits, turns and holds; whoever is silent for 0.5 s has lost the aircraft to it.
"""

import math

import uvf
from schemas import topics
from schemas.messages import CourseSetpoint, FlightSetpoint, Mode, ModeRequest

with uvf.connect() as run:
    now = run.read("milvus", topics.NAV_STATE)
    about = math.atan2(-now.velocity.x, -now.velocity.y)  # rad from north, clockwise
    wanted = CourseSetpoint(course=about, altitude=now.position.z + 15.0, airspeed=22.0)

    def there() -> bool:
        run.send("milvus", topics.SETPOINT.by("client"), FlightSetpoint(course=wanted))
        nav = run.read("milvus", topics.NAV_STATE)
        off = math.remainder(math.atan2(nav.velocity.x, nav.velocity.y) - wanted.course, math.tau)
        return abs(off) < 0.05 and abs(nav.position.z - wanted.altitude) < 1.0 and abs(nav.airspeed - wanted.airspeed) < 0.5

    def taken() -> bool:
        there()  # the mode is refused until setpoints have come
        return run.ask("milvus", topics.SET_MODE, ModeRequest(mode=Mode.MODE_OFFBOARD, source="client")).accepted

    run.wait(taken, timeout=20.0, what="Offboard is refused")
    run.wait(there, timeout=60.0, what="has not turned about and climbed")
    nav, status = run.read("milvus", topics.NAV_STATE), run.read("milvus", topics.STATUS)
    course = math.degrees(math.atan2(nav.velocity.x, nav.velocity.y)) % 360
    print(f"mode {Mode.Name(status.mode)}: course {course:.0f} deg, {nav.position.z:.0f} m, {nav.airspeed:.0f} m/s")
    run.ask("milvus", topics.SET_MODE, ModeRequest(mode=Mode.MODE_MISSION, source="client"))
