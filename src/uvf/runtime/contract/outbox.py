"""What one service instance says: checked against its declarations, left out where a link is cut, put on the bus."""

from typing import Any

from google.protobuf.message import Message

from schemas.topics import Qos, Request, Topic
from uvf.runtime.bus.interface import Bus, Publisher
from uvf.runtime.contract.link_cuts import LinkCuts
from uvf.runtime.contract.open_calls import OpenCalls
from uvf.runtime.contract.request_desk import ContractError
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.outputs import OutputMessages
from uvf.runtime.messages.validation import error_in


class OutputBox:
    """Of an instance of a service type, on a bus."""

    def __init__(self, type_: type[Service], owner: str, bus: Bus, links: LinkCuts) -> None:
        self.published: dict[str, int] = {}
        """The number of the newest message on each key."""
        self.left: dict[str, bytes] = {}
        """The newest bytes on each key that is kept: what an instance after it resumes from."""
        self.calls = OpenCalls(type_.calls, bus)
        """The requests that wait for an answer."""
        self._type, self._owner, self._bus, self._links = type_, owner, bus, links
        self._publishers: dict[str, Publisher] = {}

    def publish(self, outputs: OutputMessages, stamp: int) -> None:
        """Sends what a step has returned, stamped ``stamp`` [ns]. Raises ContractError for what is not declared or not sound."""
        for name, value in outputs.items():
            if name in self._type.requests:
                continue
            topic = self._type.outputs.get(name) or self._type.calls.get(name)
            if topic is None:
                raise ContractError(f"{self._type.name}: step returned '{name}', which is not declared")
            by_owner = value if isinstance(value, dict) else {self._owner: value}
            for owner, messages in by_owner.items():
                for message in messages if isinstance(messages, (list, tuple)) else (messages,):
                    self._send(name, topic, owner, message, stamp)

    def publish_one(self, topic: Topic[Any], message: Message, stamp: int) -> None:
        """Sends one message of its owner, declared or not."""
        self.put(topic.at(self._owner), topic.message, topic.qos, message.SerializeToString(deterministic=True), stamp)

    def put(self, key: str, message: type[Message], qos: Qos, payload: bytes, stamp: int) -> None:
        """Sends bytes of a message type on a key."""
        if key not in self._publishers:
            self._publishers[key] = self._bus.publisher(key, message.DESCRIPTOR.full_name, qos)
        self.published[key] = self._publishers[key].put(payload, stamp)

    def _send(self, name: str, topic: Topic[Any] | Request[Any, Any], owner: str, message: Message, stamp: int) -> None:
        if not isinstance(message, topic.message):
            raise ContractError(f"{self._type.name}: '{name}' is {type(message).__name__}, declared {topic.message.__name__}")
        key = topic.at(owner)
        is_cut = self._links.cut(owner, stamp)
        if isinstance(topic, Request):
            if is_cut:
                self.calls.fail(name, owner, message, stamp, f"no answer: the link to {owner} is cut")
            else:
                self.calls.send(name, topic, owner, message, stamp)
        if is_cut or isinstance(topic, Request):
            return
        payload = message.SerializeToString(deterministic=True)
        if "/actuator/" in key and (why := error_in(message)):
            raise ContractError(f"{key}: {why}")  # the simulator would refuse it: better the instance fails and is started afresh
        if topic.kept:
            self.left[key] = payload
        self.put(key, topic.message, topic.qos, payload, stamp)
