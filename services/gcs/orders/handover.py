"""Control of a vehicle goes from one operator to another."""

from schemas.messages import Event
from services.gcs.actions.page import AnswerControl, RequestControl
from services.gcs.orders.by_hand import ManualDriving
from services.gcs.state.control import called
from services.gcs.state.session import BrowserSession
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import VehicleModel


class ControlHandover:
    """Carries out requests for control, and writes each into the log."""

    def __init__(self, model: Model, by_hand: ManualDriving) -> None:
        self._model = model
        self._by_hand = by_hand

    def negotiate(self, t: float, session: BrowserSession, asked: RequestControl | AnswerControl) -> None:
        """Asks for control, gives it away or keeps it."""
        control, vehicle = self._model.control, self._model.vehicles.get(asked.vehicle)
        if vehicle is None or not session.operator:
            return
        match asked:
            case RequestControl():
                control.ask(t, vehicle.name, session.operator)
                self._model.note(vehicle.name, f"{called(session.operator)} asks for control", Event.NOTICE, of_operator=True)
            case AnswerControl(_, _, give) if control.holders.get(vehicle.name) == session.operator and vehicle.name in control.asking:
                if give:
                    self._give(t, vehicle, control.asking[vehicle.name][0])
                else:
                    control.keep(vehicle.name)
                    self._model.note(vehicle.name, f"{called(session.operator)} keeps control", Event.NOTICE, of_operator=True)

    def hand_over(self, t: float) -> None:
        """Gives control to those whose requests succeed at ``t`` [s, wall]."""
        for name, operator in self._model.control.due(t, self._model.present):
            if name in self._model.vehicles:
                self._give(t, self._model.vehicles[name], operator)

    def _give(self, t: float, vehicle: VehicleModel, operator: str) -> None:
        self._by_hand.free(t, vehicle.name)
        self._model.control.take(vehicle.name, operator)
        line = self._model.note(vehicle.name, f"{called(operator)} controls it from now on", Event.NOTICE, of_operator=True)
        self._model.log.tell(t, line)
