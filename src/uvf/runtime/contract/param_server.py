"""Answers requests to read or set a service's parameters while it runs."""

from collections import deque
from collections.abc import Callable, Iterator
from typing import Any

import msgspec

from schemas import topics
from schemas.messages import Param, ParamReply, ParamRequest
from uvf.models.keys import hints_of, meta_of, unit_of
from uvf.models.params import Params
from uvf.models.refused_value import in_words
from uvf.models.yaml_data import nearest
from uvf.runtime.bus.interface import Query
from uvf.runtime.bus.wire import Malformed, decode
from uvf.runtime.contract.service import Service


class ParamServer:
    """Holds the parameter requests of one service instance; they are answered at the start of its next step."""

    def __init__(self, service: Service) -> None:
        self._service = service
        self._queue: deque[Query] = deque()
        self.set_params: Params | None = None
        """As they are since one was set while it runs."""

    def key(self, owner: str) -> str:
        """Key on which the requests come, for this owner."""
        return topics.PARAM.by(self._service.name).at(owner)

    @property
    def waiting(self) -> int:
        """Number of requests that wait."""
        return len(self._queue)

    def queue(self, query: Query) -> None:
        """Adds a request."""
        self._queue.append(query)

    def answer(self, due: Callable[[int], bool], refused: Callable[[str], None]) -> Iterator[tuple[Query, ParamReply]]:
        """Requests whose stamp is due now, each with its reply. refused: takes a line about each malformed one."""
        taken = [query for query in self._queue if due(query.stamp_ns)]
        self._queue = deque(query for query in self._queue if not due(query.stamp_ns))
        for query in taken:
            try:
                yield query, self.reply(decode(query.key, query.payload, ParamRequest))
            except Malformed as error:
                refused(str(error))
                yield query, ParamReply(accepted=False, reason=str(error))

    def refuse_all(self, reason: str) -> None:
        """Refuses all requests that wait."""
        while self._queue:
            self._queue.popleft().refuse(reason)

    def reply(self, request: ParamRequest) -> ParamReply:
        """Reply to a request that lists, reads or sets; a refused value leaves everything as it was."""
        fields = self._service.params.__struct_fields__
        if request.name and request.name not in fields:
            return ParamReply(
                accepted=False, reason=f"{self._service.name} has no parameter '{request.name}'; {nearest(request.name, fields)}"
            )
        if request.value and request.name in self._service.fixed_params:
            reason = f"{request.name} is fixed while running; set it in the vehicle's file and start again"
            return ParamReply(accepted=False, reason=reason)
        if request.value:
            try:
                self._set(request.name, request.value)
            except msgspec.ValidationError as error:
                return ParamReply(accepted=False, reason=f"{request.name}: {self._in_words(request, str(error))}")
            except msgspec.DecodeError:
                reason = f"{request.name}: not a value in JSON; write a number, true, false, or text in double quotes"
                return ParamReply(accepted=False, reason=reason)
            except RecursionError:
                return ParamReply(accepted=False, reason=f"{request.name}: nested too deeply")
        wanted = [request.name] if request.name else fields
        return ParamReply(accepted=True, params=[self._describe(name) for name in wanted])

    def _set(self, name: str, value: str) -> None:
        data = msgspec.to_builtins(self._service.params)
        data[name] = msgspec.json.decode(value)
        self.take_up(msgspec.convert(data, type(self._service.params)))

    def _in_words(self, request: ParamRequest, said: str) -> str:
        """What msgspec ``said`` about the value, as files of data are answered too."""
        why, _, place = said.partition(" - at `")
        if place.removesuffix("`") != f"$.{request.name}":
            return said
        hint = hints_of(type(self._service.params))[request.name]
        return in_words(msgspec.json.decode(request.value), hint, why)

    def take_up(self, params: Params) -> None:
        """Sets all parameters, to those of an instance before this one."""
        self._service.params = self.set_params = params

    def _describe(self, name: str) -> Param:
        hints = hints_of(type(self._service.params))
        param = Param(name=name, value=msgspec.json.encode(getattr(self._service.params, name)).decode())
        param.min, param.max = float("-inf"), float("inf")
        param.read_only = name in self._service.fixed_params
        _describe_limits(param, meta_of(hints[name]))
        return param


def _describe_limits(param: Param, meta: Any) -> None:
    lowest = meta.ge if meta.ge is not None else meta.gt
    highest = meta.le if meta.le is not None else meta.lt
    param.min = float("-inf") if lowest is None else lowest
    param.max = float("inf") if highest is None else highest
    param.description = meta.description or ""
    param.unit = unit_of(meta) or ""
