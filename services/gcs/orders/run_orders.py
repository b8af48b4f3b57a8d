"""What is asked of the simulation as a whole: its clock, the wind, and another mission."""

from math import cos, isfinite, radians, sin

from google.protobuf.message import Message

from schemas.messages import ClockRequest, LaunchRequest, Vector3, WindRequest
from services.gcs.actions.page import LaunchMission, RunClock, SetRate, SetWind, WindForm
from services.gcs.orders.offers import SOURCE
from services.gcs.orders.orders import OrderBook
from services.gcs.orders.outbox import Outbox
from services.gcs.state.session import BrowserSession

CLOCK_ACTIONS = {
    "pause": ClockRequest.PAUSE,
    "resume": ClockRequest.RESUME,
    "step": ClockRequest.STEP,
    "reset": ClockRequest.RESET,
}


class RunOrders:
    """Turns them into requests to the conductor and the launcher."""

    def __init__(self, orders: OrderBook) -> None:
        self._orders = orders

    def ask(self, t: float, session: BrowserSession, action: RunClock | SetRate | SetWind | LaunchMission, out: Outbox) -> None:
        """What concerns the simulation as a whole: anybody may ask for it, and what loses the run wants a second click."""
        request: Message
        match action:
            case RunClock(_, what):
                name, request = "clock_request", ClockRequest(action=CLOCK_ACTIONS[what])
            case SetRate(_, rate):
                name, request = "clock_request", ClockRequest(action=ClockRequest.SET_RATE, rate=rate)
            case SetWind(_, form):
                velocity = _wind(form)
                if velocity is None:
                    self._orders.refuse(t, None, "wind", f"'{form.direction}' and '{form.speed}' are not degrees and metres per second")
                    return
                name, request = "wind", WindRequest(velocity=velocity, source=SOURCE)
            case LaunchMission(_, mission):
                name, request = "launch", LaunchRequest(mission=mission, source=SOURCE)
        key = f"{name} {getattr(action, 'what', getattr(action, 'mission', ''))}"
        loses = isinstance(action, LaunchMission) or (isinstance(action, RunClock) and action.what == "reset")
        if loses and not self._orders.is_sure(t, session, "", key, request):
            return
        session.to_confirm = None
        self._orders.open(t, None, request)
        out.calls.setdefault(name, []).append(request)


def _wind(form: WindForm) -> Vector3 | None:
    """m/s, world, where it blows to; None where the form holds no numbers."""
    try:
        came_from, speed = radians(float(form.direction)), float(form.speed)
    except ValueError:
        return None
    if not isfinite(came_from) or not isfinite(speed):
        return None
    return Vector3(x=-speed * sin(came_from), y=-speed * cos(came_from))
