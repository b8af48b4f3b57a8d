"""Which parameters are in force, told at the start and after each change, so that displays follow and a restart keeps them."""

from typing import TypeVar

import msgspec

from schemas.messages import ParamValues
from uvf.models.params import Params
from uvf.runtime.messages.convert import stamp

P = TypeVar("P", bound=Params)


class ToldParams:
    """Publishes a service's parameters; a set is another object after each request that has set one."""

    def __init__(self) -> None:
        self._told: Params | None = None
        self._changes = -1

    def news(self, t: float, params: Params) -> ParamValues | None:
        """The message stamped ``t`` [s] with all parameters; None while nothing has changed."""
        if params is self._told:
            return None
        self._told = params
        self._changes += 1
        values = {name: msgspec.json.encode(getattr(params, name)).decode() for name in params.__struct_fields__}
        return ParamValues(timestamp=stamp(t), changes=self._changes, values=values)

    def taken_up(self, said: ParamValues, params: P) -> P:
        """The parameters of an instance that has died; the count of changes continues."""
        self._changes = said.changes - 1
        values = {name: msgspec.json.decode(value) for name, value in said.values.items()}
        return msgspec.convert({**msgspec.to_builtins(params), **values}, type(params))
