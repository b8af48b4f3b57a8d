"""An outside program drives: turn on the spot for a while, from the measured heading. Start ``./uvf up`` first.

.venv/bin/python examples/03_external_controller.py
"""

import uvf
from schemas import topics
from schemas.messages import DriveCommand, Mode, ModeRequest
from uvf.runtime.messages.convert import yaw_of

with uvf.connect() as run:
    print(run.ask("burger", topics.SET_MODE, ModeRequest(mode=Mode.MODE_OFFBOARD, source="client")))
    goal = yaw_of(run.read("burger", topics.POSE).pose.orientation) + 1.0

    def turned() -> bool:
        error = goal - yaw_of(run.read("burger", topics.POSE).pose.orientation)
        error = (error + 3.14159) % 6.28318 - 3.14159
        run.send("burger", topics.DRIVE.by("client"), DriveCommand(angular=max(min(2.0 * error, 0.8), -0.8)))
        return abs(error) < 0.05

    run.wait(turned, timeout=20.0, what="did not turn")
    print("turned by 1 rad")
    run.ask("burger", topics.SET_MODE, ModeRequest(mode=Mode.MODE_MISSION, source="client"))
