"""An outside program flies an aircraft by its surfaces: wings level for a while. Start ``./uvf up`` first.

    .venv/bin/python examples/05_surfaces.py

Whoever is silent for 0.5 s has lost the aircraft to its autopilot, which holds.
"""

import uvf
from schemas import topics
from schemas.messages import Mode, ModeRequest, SurfaceCommand
from uvf.maths.rotations import enu_flu_from_ned_frd, to_euler
from uvf.runtime.messages.convert import wxyz

SECONDS = 4.0

with uvf.connect() as run:
    trim = run.read("milvus", topics.SURFACE_COMMAND)  # what the autopilot has it fly with
    begin = run.time

    def flown() -> bool:
        nav = run.read("milvus", topics.NAV_STATE)
        roll, pitch, _ = to_euler(enu_flu_from_ned_frd(wxyz(nav.orientation)))
        q = -nav.angular_velocity.y  # rad/s, nose up
        elevator = trim.elevator + 0.3 * (pitch - 0.06) + 0.15 * q
        command = SurfaceCommand(aileron=-0.3 * roll - 0.05 * nav.angular_velocity.x, elevator=elevator, throttle=0.7)
        run.send("milvus", topics.SURFACES.by("client"), command)
        return run.time - begin > SECONDS

    flown()  # the first command is there before the mode is asked for
    print(run.ask("milvus", topics.SET_MODE, ModeRequest(mode=Mode.MODE_MANUAL, source="client")))
    run.wait(flown, timeout=60.0, what="has not flown")
    nav, status = run.read("milvus", topics.NAV_STATE), run.read("milvus", topics.STATUS)
    roll, _, _ = to_euler(enu_flu_from_ned_frd(wxyz(nav.orientation)))
    print(f"flown by {status.command_source}: {nav.airspeed:.0f} m/s, roll {roll:+.2f} rad, {nav.position.z:.0f} m")
    run.ask("milvus", topics.SET_MODE, ModeRequest(mode=Mode.MODE_MISSION, source="client"))
