"""The commands that a vehicle is offered now, and why one cannot be given: the page shows it, and the ground station refuses by it."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from google.protobuf.message import Message

from schemas.messages import ArmRequest, CancelRequest, Mode, ModeRequest, NavStatus
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import VehicleModel

SOURCE = "gcs"
STOPPED = "STOP ALL is engaged: release it first"


@dataclass(frozen=True)
class Offer:
    """A command. risky: wants a second click; why_not: why it cannot be given now, and the mend."""

    key: str
    label: str
    request: Message
    hint: str
    why_not: str = ""
    lit: bool = False
    risky: bool = False
    main: bool = False
    """What an operator most likely wants next."""

    @property
    def name(self) -> str:
        """The service's output by which the request is sent."""
        return {ArmRequest: "arm", CancelRequest: "cancel"}.get(type(self.request), "mode")


def offers(model: Model, v: VehicleModel) -> list[Offer]:
    """The commands of a vehicle in the order in which they are shown, those that make no sense now with their reason."""
    return list(_of_aircraft(model, v) if v.flies else _of_rover(model, v))


def offer_of(model: Model, v: VehicleModel, key: str) -> Offer | None:
    """The command with this key, if the vehicle is offered it at all."""
    return next((offer for offer in offers(model, v) if offer.key == key), None)


def is_driving_to_goal(v: VehicleModel) -> bool:
    """Whether it drives to a person's goal, which can be cancelled."""
    ended = (NavStatus.REACHED, NavStatus.CANCELLED)
    return v.nav_status is not None and v.nav_status.job == "goal" and v.nav_status.state not in ended


def _arming(model: Model, v: VehicleModel) -> Offer:
    armed = v.status is not None and v.status.armed
    if armed:
        return Offer("disarm", f"Disarm {v.name}", ArmRequest(arm=False, source=SOURCE), "Motors off", risky=True)
    unfit = v.status.prearm[0] if v.status is not None and v.status.prearm else ""
    why = STOPPED if model.stopped else unfit
    return Offer("arm", f"Arm {v.name}", ArmRequest(arm=True, source=SOURCE), "Motors may turn from now on", why, risky=True, main=True)


def _mode(v: VehicleModel, key: str, label: str, mode: Any, hint: str, why_not: str = "") -> Offer:
    lit = v.status is not None and v.status.mode == mode
    return Offer(key, label, ModeRequest(mode=mode, source=SOURCE), hint, why_not, lit)


def cannot_move(model: Model, v: VehicleModel) -> str:
    """Why it would not move, whatever it is told, and the mend; "" if it would."""
    if model.stopped:
        return STOPPED
    if v.status is None:
        return f"{v.name} has not told its state yet: wait until it is heard"
    return "" if v.status.armed else f"{v.name} is disarmed: arm it first"


def _of_rover(model: Model, v: VehicleModel) -> Iterator[Offer]:
    bound = cannot_move(model, v)
    yield _mode(v, "hold", "Hold", Mode.MODE_HOLD, "Stop and stand")
    yield _mode(v, "mission", "Mission", Mode.MODE_MISSION, "Go on with the job, or with the goal", bound)
    if v.member.file.ground is not None:
        yield _mode(v, "manual", "Manual", Mode.MODE_MANUAL, "Obey the keys and gamepads that drive it", bound)
    yield _arming(model, v)
    if is_driving_to_goal(v):
        yield Offer("cancel", "Cancel goal", CancelRequest(source=SOURCE), "Stop, and go back to the job")


def _of_aircraft(model: Model, v: VehicleModel) -> Iterator[Offer]:
    armed = v.status is not None and v.status.armed
    landed = v.status is not None and v.status.landed
    bound = cannot_move(model, v)
    grounded = f"{v.name} is on the ground: take off first" if landed else ""
    empty = "" if v.mission is not None and v.mission.items else "no mission is loaded: draw one in Plan and upload it"
    if landed:
        yield _arming(model, v)
        takeoff = ModeRequest(mode=Mode.MODE_TAKEOFF, source=SOURCE)
        yield Offer("takeoff", "Take off", takeoff, "Climb to the height of takeoff, then circle", bound, risky=True, main=armed)
    yield _mode(v, "mission", "Mission", Mode.MODE_MISSION, "Fly the mission", bound or empty)
    yield _mode(v, "hold", "Hold", Mode.MODE_HOLD, "Circle here", grounded)
    if v.leader:
        yield _mode(v, "follow", "Follow leader", Mode.MODE_FOLLOW, f"Go to its place behind {v.leader}", bound or grounded)
    yield _mode(v, "return", "Return", Mode.MODE_RETURN, "Fly home", grounded)
    yield _mode(v, "land", "Land", Mode.MODE_LAND, "Land at the landing place", grounded)
    if not landed:
        yield _arming(model, v)
