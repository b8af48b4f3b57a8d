"""An outside program drives a rover through waypoints by PI on distance and heading. Start ``./uvf up`` first.

    ./uvf mode burger hold
    .venv/bin/python examples/08_waypoints.py 2.6,1.5 2.2,1.2

It drives straight, around nothing: the first line keeps the rover, which explores the house, in the room where it starts.

The same over MAVLink: ``09_waypoints_mavlink.py``; as a program of a mission, recorded with it: ``missions/ugv1_waypoints.yaml``.
"""

import sys
from math import atan2, cos, hypot, remainder, tau

import uvf
from schemas import topics
from schemas.messages import DriveCommand, Mode, ModeRequest
from uvf.runtime.messages.convert import yaw_of

with uvf.connect() as run:
    print(run.ask("burger", topics.SET_MODE, ModeRequest(mode=Mode.MODE_OFFBOARD, source="client")))
    for text in sys.argv[1:]:
        x, y = map(float, text.split(","))
        state = {"t": run.time, "distance": 0.0, "heading": 0.0}  # the sums of the I terms

        def there(x=x, y=y, state=state) -> bool:
            pose, dt = run.read("burger", topics.POSE).pose, run.time - state["t"]
            left = hypot(x - pose.position.x, y - pose.position.y)
            off = remainder(atan2(y - pose.position.y, x - pose.position.x) - yaw_of(pose.orientation), tau)
            state |= {"t": run.time, "distance": state["distance"] + left * dt, "heading": state["heading"] + off * dt}
            speed = min(0.6 * left + 0.01 * state["distance"], 0.2) * max(cos(off), 0.0) ** 3
            turn = max(min(1.5 * off + 0.05 * state["heading"], 1.0), -1.0)
            run.send("burger", topics.DRIVE.by("client"), DriveCommand(linear=speed, angular=turn))
            return left < 0.1

        run.wait(there, timeout=40.0, what=f"has not come to ({x:g}, {y:g})")
        print(f"at ({x:g}, {y:g}) after {run.time:.1f} s")
    run.ask("burger", topics.SET_MODE, ModeRequest(mode=Mode.MODE_MISSION, source="client"))
