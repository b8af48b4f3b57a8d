"""What comes in: whose it is, whether it may be heard, and for which vehicle. A new connection is greeted."""

from collections.abc import Sequence

from services.autopilot.mavlink.connection.line import Sender
from services.autopilot.mavlink.connection.peers import Peers
from services.autopilot.mavlink.connection.signing import SignatureVerdict, Signing
from services.autopilot.mavlink.connection.stations import Stations
from services.autopilot.mavlink.connection.targets import Reserved
from services.autopilot.mavlink.vehicle_link import VehicleLink
from uvf.mavlink import dialect as mav
from uvf.mavlink.codec import AUTOPILOT
from uvf.mavlink.endpoint import DatagramLink, Peer

ENGAGING = frozenset(
    {
        *range(mav.MAVLINK_MSG_ID_PARAM_REQUEST_READ, mav.MAVLINK_MSG_ID_PARAM_SET + 1),
        *range(mav.MAVLINK_MSG_ID_MISSION_ITEM, mav.MAVLINK_MSG_ID_MISSION_ACK + 1),
        mav.MAVLINK_MSG_ID_MISSION_REQUEST_INT,
        mav.MAVLINK_MSG_ID_MISSION_ITEM_INT,
        mav.MAVLINK_MSG_ID_FILE_TRANSFER_PROTOCOL,
        mav.MAVLINK_MSG_ID_MANUAL_CONTROL,
        mav.MAVLINK_MSG_ID_RC_CHANNELS_OVERRIDE,
        mav.MAVLINK_MSG_ID_SET_ATTITUDE_TARGET,
        mav.MAVLINK_MSG_ID_SET_POSITION_TARGET_LOCAL_NED,
        mav.MAVLINK_MSG_ID_SET_POSITION_TARGET_GLOBAL_INT,
    }
)
"""Words of who transfers something or steers, and is not to be forgotten for the sake of who only calls."""


class Reception:
    """Checks incoming messages and passes them on to the vehicles they address."""

    def __init__(self, vehicles: Sequence[VehicleLink], link: DatagramLink, signing: Signing, reserved: Reserved) -> None:
        self.stations = Stations()
        self._vehicles = vehicles
        self._own_ids = {vehicle.line.facts.system_id for vehicle in vehicles}
        self._link = link
        self._signing = signing
        self._reserved = reserved
        self._peers = Peers()

    def take(self, t: float, message: mav.MAVLink_message, peer: Peer) -> None:
        """Takes a valid message at ``t`` [s, wall]; own packets that come back are dropped."""
        header = message.get_header()
        sender = Sender(peer, header.srcSystem, header.srcComponent)
        if sender.system in self._own_ids:
            return
        self._link.keep(t, peer, message.get_msgId() in ENGAGING)
        self._welcome(t, sender)
        verdict = self._signing.check(t, message, sender)
        if verdict in (SignatureVerdict.SIGNED, SignatureVerdict.UNSIGNED):
            self.stations.hear(t, message, sender)
        self._pass_on(t, message, sender, verdict)

    def _welcome(self, t: float, sender: Sender) -> None:
        """A connection begins with default rates, unsigned, and with a word about what this is to each system in it."""
        news = self._peers.hear(t, sender)
        if not news.system:
            return
        self.forget(t)
        if news.connection:
            self._signing.forget(sender.peer)
        for vehicle in self._at(sender.peer):
            if news.connection:
                vehicle.schedule.renew(sender.peer)
            vehicle.welcome(sender.peer)

    def forget(self, t: float) -> None:
        """Drops what is known of peers that are gone at ``t`` [s, wall]."""
        known = self._link.peers(t)
        self._peers.forget(t, known)
        self._signing.forget_all_but(known)

    def _pass_on(self, t: float, message: mav.MAVLink_message, sender: Sender, verdict: SignatureVerdict) -> None:
        addressed = self._addressed(message, sender.peer)
        if isinstance(message, mav.MAVLink_setup_signing_message):
            self._set_up(message, sender, verdict, addressed)
            return
        for vehicle in addressed:
            if verdict is SignatureVerdict.REFUSED:
                vehicle.line.text(mav.MAV_SEVERITY_WARNING, self._signing.why_refused(sender.peer), sender.peer)
            elif verdict is not SignatureVerdict.REPLAYED:
                vehicle.hear(message, sender)

    def _at(self, peer: Peer) -> list[VehicleLink]:
        """All vehicles, or the one that a port is reserved for."""
        only = self._reserved.get(peer)
        return [vehicle for vehicle in self._vehicles if only in (None, vehicle.line.facts.system_id)]

    def _addressed(self, message: mav.MAVLink_message, peer: Peer) -> list[VehicleLink]:
        """The vehicle with the number that the message names, or all."""
        target = getattr(message, "target_system", getattr(message, "target", 0))
        if getattr(message, "target_component", 0) not in (0, AUTOPILOT):
            return []
        return [vehicle for vehicle in self._at(peer) if target in (0, vehicle.line.facts.system_id)]

    def _set_up(
        self, message: mav.MAVLink_setup_signing_message, sender: Sender, verdict: SignatureVerdict, addressed: Sequence[VehicleLink]
    ) -> None:
        """The link is one for all vehicles; the one that is asked answers."""
        if not addressed:
            return
        armed = any(vehicle.line.latest.status is not None and vehicle.line.latest.status.armed for vehicle in addressed)
        if said := self._signing.setup(message, sender, verdict, armed):
            addressed[0].line.text(mav.MAV_SEVERITY_INFO if "from now" in said else mav.MAV_SEVERITY_WARNING, said, sender.peer)
