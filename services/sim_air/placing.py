"""The request that puts an aircraft elsewhere."""

from collections.abc import Mapping

from schemas.messages import Reply, SetPoseRequest
from services.sim_air.aircraft import Aircraft
from uvf.models.mission import file as mission_file
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.messages.convert import array, yaw_of
from uvf.runtime.messages.spawned import pose_fault

STEEPEST, QUICKEST, FASTEST = 1.5, 3.0, 1e3  # rad, rad/s, m/s


def place(aircraft: Mapping[str, Aircraft], request: SetPoseRequest) -> Reply:
    """Puts an aircraft elsewhere; if that is refused, the aircraft is as it was."""
    if request.name not in aircraft:
        return Reply(reason=f"there is no aircraft '{request.name}'; {nearest(request.name, aircraft)}")
    if fault := fault_of(request):
        return Reply(reason=fault)
    try:
        aircraft[request.name].begin_anew(start_of(request))
    except BadInput as error:
        return Reply(reason=str(error))
    return Reply(accepted=True)


def start_of(request: SetPoseRequest) -> mission_file.StartPose:
    """The start pose that a request asks for."""
    x, y, z = array(request.pose.position).tolist()
    yaw, climb, turn_rate = yaw_of(request.pose.orientation), request.climb, request.turn_rate
    return mission_file.StartPose(x=x, y=y, z=z, yaw=yaw, speed=request.speed, climb=climb, turn_rate=turn_rate)


def fault_of(request: SetPoseRequest) -> str:
    """Why nothing can be placed there; "" = it may."""
    if fault := pose_fault(request.pose):
        return fault
    if request.pose.position.z < 0:
        return "it would be under the ground; z is the height above it, 0 = standing"
    if not (0 <= request.speed <= FASTEST and abs(request.climb) <= STEEPEST and abs(request.turn_rate) <= QUICKEST):
        return f"speed must be 0 to {FASTEST:g} m/s, climb within {STEEPEST:g} rad, turn_rate within {QUICKEST:g} rad/s"
    return ""
