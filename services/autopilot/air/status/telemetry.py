"""From the autopilot's own values (NED, FRD) to messages (ENU, FLU)."""

import math

import numpy as np

from schemas.messages import (
    EstimateQuality,
    FrameTransform,
    Kind,
    MissionProgress,
    NavState,
    Pose,
    PoseInFrame,
    PosesInFrame,
    SurfaceCommand,
    Targets,
    Vector3,
    VehicleStatus,
)
from services.autopilot.air.active_mode import ActiveMode
from services.autopilot.air.inputs import intake
from services.autopilot.air.mode_table import FlightMode
from services.autopilot.air.setpoints import ControlOutput
from uvf.control.commands import Surfaces
from uvf.estimation.state import Estimate
from uvf.guidance.flight_plan import OFF_PATH, next_stop
from uvf.guidance.flight_plan import ItemKind as ItemKind
from uvf.guidance.plan_follower import PlanFollower
from uvf.guidance.route import Circle, Place
from uvf.maths.rotations import from_euler
from uvf.runtime.messages.convert import quaternion, stamp

MODES = {flown: mode for mode, flown in intake.MODES.items()}
CIRCLE_POINTS = 24


def nav_state(t: float, now: Estimate) -> NavState:
    # ENU and FLU are each half a turn away from NED and FRD: yaw is mirrored, pitch changes sign with y and z.
    """The estimate as a message in ENU and FLU, stamped ``t`` [s]."""
    attitude = from_euler(now.roll, -now.pitch, math.pi / 2 - now.yaw)
    course = now.course
    return NavState(
        timestamp=stamp(t),
        position=Vector3(x=now.east, y=now.north, z=now.height),
        velocity=Vector3(x=now.ground_speed * math.sin(course), y=now.ground_speed * math.cos(course), z=now.climb),
        orientation=quaternion(attitude),
        angular_velocity=Vector3(x=now.p, y=-now.q, z=-now.r),
        airspeed=now.airspeed,
        wind=Vector3(x=now.wind_east, y=now.wind_north),
        position_sigma=now.position_sigma,
    )


def pose(state: NavState) -> PoseInFrame:
    """The pose alone, in the world frame."""
    return PoseInFrame(timestamp=state.timestamp, frame_id="world", pose=Pose(position=state.position, orientation=state.orientation))


def body_frame(state: NavState, vehicle: str) -> FrameTransform:
    """World from base_link."""
    return FrameTransform(
        timestamp=state.timestamp,
        parent_frame_id="world",
        child_frame_id=f"{vehicle}/base_link",
        translation=state.position,
        rotation=state.orientation,
    )


def surfaces(t: float, s: Surfaces, armed: bool) -> SurfaceCommand:
    """The command to the servos [rad; throttle 0 to 1], stamped ``t`` [s]; disarmed, the motor stays off."""
    throttle = s.throttle if armed else 0.0
    levers = {"throttle": throttle, "flap": s.flap, "brake": s.brake, "brake_difference": s.brake_difference}
    return SurfaceCommand(timestamp=stamp(t), aileron=s.aileron, elevator=s.elevator, rudder=s.rudder, **levers)


def status(t: float, active: ActiveMode, now: Estimate, flown: ControlOutput) -> VehicleStatus:
    """All of the status but arming, landing, battery and the system id, stamped ``t`` [s]."""
    message = VehicleStatus(
        timestamp=stamp(t),
        kind=Kind.KIND_FIXED_WING,
        mode=MODES[active.mode],
        stopped=bool(active.stopped),
        command_source=active.source,
        reason=_reason(active),
        throttle=flown.surfaces.throttle,
        cross_track=flown.aim.error,
        altitude_error=now.height - flown.level.height,
        distance_to_waypoint=_distance(active, now),
        waypoint=active.navigator.index or 0,
    )
    if active.circle is not None:
        centre = active.circle.centre
        message.circle.centre.CopyFrom(Vector3(x=centre.east, y=centre.north, z=centre.height))
        message.circle.radius = active.circle.radius
    if active.home is not None:
        message.home.x, message.home.y, message.home.z = active.home.east, active.home.north, active.home.height
    return message


def _reason(active: ActiveMode) -> str:
    """Of the mode; and who is not listened to."""
    waits = ", ".join(active.context.setpoints_wait) if active.mode is FlightMode.OFFBOARD else ""
    return f"{active.reason}; setpoints from {active.source}, those of {waits} wait" if waits else active.reason


def _distance(active: ActiveMode, now: Estimate) -> float:
    """m, to the current item's place, to the centre of the circle that is held, or to the station behind a leader."""
    if active.station is not None:
        return active.station
    target = active.navigator.target
    place = target.place if active.mode is FlightMode.MISSION and target else active.circle.centre if active.circle else None
    return math.hypot(place.north - now.north, place.east - now.east) if place else 0.0


def progress(t: float, active: ActiveMode, mission_id: int) -> MissionProgress:
    """How far the mission has been flown, stamped ``t`` [s]."""
    navigator = active.navigator
    if not navigator.items:
        state = MissionProgress.NO_MISSION
    elif navigator.finished:
        state = MissionProgress.COMPLETE
    elif active.mode is FlightMode.MISSION:
        state = MissionProgress.ACTIVE
    else:
        state = MissionProgress.NOT_STARTED if navigator.reached < 0 and navigator.index is None else MissionProgress.PAUSED
    return MissionProgress(
        timestamp=stamp(t),
        state=state,
        current=_current(navigator),
        total=len(navigator.items),
        reached=navigator.reached,
        laps=navigator.laps,
        mission_id=mission_id,
    )


def _current(navigator: PlanFollower) -> int:
    """The last one once all are done, the first before it begins."""
    if navigator.index is not None:
        return navigator.index
    return len(navigator.items) - 1 if navigator.finished else 0


def path(t: float, active: ActiveMode) -> PosesInFrame:
    """The path at ``t`` [s], for display: the items still to come up to a return to the first of them, or the circle."""
    if active.mode is FlightMode.MISSION and active.navigator.index is not None:
        places = _ahead(active)
    elif active.mode is FlightMode.FOLLOW and active.formation is not None:
        places = active.formation.ahead()
    else:
        places = _round(active.circle) if active.circle else []
    return PosesInFrame(timestamp=stamp(t), frame_id="world", poses=[_pose(p) for p in places])


def _ahead(active: ActiveMode) -> list[Place]:
    """Each item once, then back to the first when the circuit closes."""
    navigator = active.navigator
    places = navigator.curve_ahead()
    seen: list[int] = []
    index = navigator.index
    while index is not None and navigator.items[index].kind is not ItemKind.RETURN:
        item = navigator.items[index]
        places += [item.place] if item.flies_through or item.kind in OFF_PATH else _round(Circle(item.place, item.radius or 1.0))
        if index in seen:
            break
        seen.append(index)
        index = next_stop(navigator.items, index + 1, {}).index
    return places


def _round(circle: Circle) -> list[Place]:
    angles = np.linspace(0, math.tau, CIRCLE_POINTS + 1).tolist()
    c, r = circle.centre, abs(circle.radius)
    return [Place(c.north + r * math.cos(a), c.east + r * math.sin(a), c.height) for a in angles]


def _pose(place: Place) -> Pose:
    return Pose(position=Vector3(x=place.east, y=place.north, z=place.height))


def targets(t: float, active: ActiveMode, flown: ControlOutput) -> Targets:
    """What is held at ``t`` [s], and nothing else: by hand no place, with the surfaces in hand no attitude either."""
    message = Targets(timestamp=stamp(t), airspeed=flown.airspeed)
    if flown.airspeed is not None:
        message.altitude = flown.level.height
    if flown.attitude is not None:
        message.bank, message.pitch = flown.attitude.bank, flown.attitude.pitch
    item = active.navigator.target if active.mode is FlightMode.MISSION else None
    if item is not None and active.circle is None:
        message.place.CopyFrom(Vector3(x=item.place.east, y=item.place.north, z=item.place.height))
        message.radius = 0.0 if item.flies_through or item.kind in OFF_PATH else item.radius
    elif active.circle is not None:
        centre = active.circle.centre
        message.place.CopyFrom(Vector3(x=centre.east, y=centre.north, z=centre.height))
        message.radius = active.circle.radius
    return message


def quality(t: float, now: Estimate) -> EstimateQuality:
    """How well the estimate is known (sigmas [m, m/s, rad] and test ratios [-]), stamped ``t`` [s]."""
    fits = now.ratios
    return EstimateQuality(
        timestamp=stamp(t),
        position_known=now.position_known,
        height_known=now.height_known,
        airspeed_known=now.airspeed_known,
        position_sigma=now.position_sigma,
        height_sigma=now.height_sigma,
        tilt_sigma=now.tilt_sigma,
        yaw_sigma=now.yaw_sigma,
        wind_sigma=now.wind_sigma,
        position_ratio=fits.position,
        velocity_ratio=fits.velocity,
        height_ratio=fits.height,
        airspeed_ratio=fits.airspeed,
        slip_ratio=fits.slip,
        field_ratio=fits.field,
    )
