"""DO_FENCE_ENABLE: the fence in force is put out of force, or back into it."""

from schemas.messages import Fence, FenceRequest
from services.autopilot.mavlink.commands.actions import SOURCE
from services.autopilot.mavlink.connection.command_server import Acknowledger, Handler, ReceivedCommand
from services.autopilot.mavlink.connection.line import VehicleConnection
from uvf.mavlink import dialect as mav


def _enable(line: VehicleConnection, command: ReceivedCommand, ack: Acknowledger) -> None:
    """The floor alone (2) is no switch of its own: it counts only above it, and not while it lands."""
    if command.p[0] not in (0.0, 1.0):
        ack(mav.MAV_RESULT_DENIED, "Fence: parameter 1 is 1 to enable or 0 to disable")
        return
    fence = Fence()
    fence.CopyFrom(line.latest.fence or Fence())
    fence.disabled = command.p[0] == 0.0
    line.ask("set_fence", FenceRequest(fence=fence, source=SOURCE), ack.outcome("Fence refused"))


FENCE_SWITCH: dict[int, Handler] = {mav.MAV_CMD_DO_FENCE_ENABLE: _enable}
