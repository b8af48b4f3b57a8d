"""Turns what is asked for of a vehicle's map into requests."""

import re

from google.protobuf.message import Message

from schemas.messages import MappingRequest, PlaceRequest, RelocalizeRequest, SaveMapRequest
from services.gcs.actions.maps import BeginMap, Mapping, OfMap, Relocalize, SaveMap
from services.gcs.orders.offers import SOURCE
from services.gcs.orders.orders import OrderBook
from services.gcs.orders.outbox import Outbox
from services.gcs.state.pointing import Pointed
from services.gcs.state.session import BrowserSession
from services.gcs.state.vehicle_model import VehicleModel
from uvf.runtime.messages.convert import planar_pose

PLAIN = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,39}")
"""A name, never a path: what is asked for on a page is written nowhere else."""


class MapOrders:
    """Saves maps, and says to a localized vehicle where it is."""

    def __init__(self, orders: OrderBook) -> None:
        self._orders = orders

    def ask(self, t: float, session: BrowserSession, action: OfMap, out: Outbox) -> None:
        """Carries out an action at ``t`` [s, wall]."""
        request: Message
        match action:
            case SaveMap(_, _, form):
                name = form.name.strip()
                name_fault = "" if PLAIN.fullmatch(name) else f"'{name}' is no name of a map: letters, digits, - and _, as in house-1"
                key, request, why = "save_map", SaveMapRequest(name=name, source=SOURCE), name_fault
            case Relocalize():
                key, request, why = "relocalize", RelocalizeRequest(source=SOURCE), ""
            case Mapping(_, _, on):
                wanted = MappingRequest.GO_ON if on else MappingRequest.HOLD
                key, request, why = "mapping", MappingRequest(action=wanted, source=SOURCE), ""
            case BeginMap(_, _, method):
                key, request, why = "mapping", MappingRequest(action=MappingRequest.BEGIN, method=method, source=SOURCE), ""
                if not self._orders.is_sure(t, session, action.vehicle, f"begin {method}", request):
                    return
                session.to_confirm = None
            case _:
                return
        if self._orders.begin(t, session, action.vehicle, request, why) is not None:
            out.call(key, action.vehicle, request)

    def settled(self, v: VehicleModel, request: MappingRequest) -> None:
        """A vehicle has accepted what was asked of its mapping."""
        v.mapping.held = request.action == MappingRequest.HOLD
        if request.action == MappingRequest.BEGIN:
            v.mapping.method = request.method

    def place(self, t: float, session: BrowserSession, at: Pointed, yaw: float, out: Outbox) -> None:
        """The vehicle is where the page has clicked, and looks along ``yaw`` [rad, world]."""
        request = PlaceRequest(pose=planar_pose(at.x, at.y, yaw), source=SOURCE)
        if self._orders.begin(t, session, at.vehicle, request) is not None:
            out.call("place", at.vehicle, request)
