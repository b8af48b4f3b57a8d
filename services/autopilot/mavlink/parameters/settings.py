"""What was set over MAVLink: remembered on this machine, and given to an autopilot that has begun with its vehicle's file."""

import json
from collections.abc import Mapping
from typing import Any

import msgspec

from schemas.messages import ParamRequest, ParamValues
from services.autopilot.mavlink.connection.asking import Done
from services.autopilot.mavlink.connection.line import VehicleConnection
from services.autopilot.mavlink.parameters.parameter_store import Store, UnreadableStore
from uvf.mavlink import dialect as mav
from uvf.models.yaml_data import BadInput, convert

SOURCE = "mavlink"
ASK_AGAIN = 1.0  # s
Settings = dict[str, Any]


class ParameterSettings:
    """The autopilot's own parameters by name, as this end knows them."""

    def __init__(self, line: VehicleConnection, store: Store) -> None:
        self._line = line
        self._store = store
        self._file: Settings = msgspec.to_builtins(line.facts.params)
        self.note = ""
        """What every ground station should hear about them."""
        self._said = dict(self._file)
        self._wanted = self._load()
        """To be set as soon as the autopilot listens."""
        self._kept = dict(self._wanted)
        self._heard: ParamValues | None = None
        self._asking: set[str] = set()
        self._ask_at = 0.0
        self._publish()

    @property
    def own(self) -> Settings:
        """The autopilot's parameters by name, with those still to be set."""
        return {**self._said, **self._wanted}

    @property
    def is_settled(self) -> bool:
        """Whether nothing is left to be set."""
        return not self._wanted

    def hear(self) -> bool:
        """Takes the autopilot's report; returns whether there was a new one.

        An autopilot that has begun with its file is given the stored settings; one that was changed before this end started keeps its own.
        """
        heard = self._line.latest.params
        if heard is None or heard is self._heard:
            return False
        begins_anew = heard.changes == 0 and self._heard is not None and self._heard.changes > 0
        goes_on = heard.changes > 0 and self._heard is None
        self._heard = heard
        self._said |= {name: json.loads(value) for name, value in heard.values.items() if name in self._file}
        if begins_anew or goes_on:
            self._wanted = dict(self._kept) if begins_anew else {}
        self._wanted = {name: value for name, value in self._wanted.items() if self._said.get(name) != value}
        self._publish()
        return True

    def tick(self) -> None:
        """Requests the settings that are still to be set."""
        if self._heard is None or self._line.t < self._ask_at or self._line.latest.is_paused:
            return
        for name, value in self._wanted.items():
            if name not in self._asking:
                self._asking.add(name)
                self._ask(name, value, self._end_of(name))

    def _end_of(self, name: str) -> Done:
        def asked(accepted: bool, reason: str) -> None:
            self._asking.discard(name)
            if not accepted:
                self._ask_at = self._line.t + ASK_AGAIN

        return asked

    def set(self, settings: Mapping[str, Any], done: Done) -> None:
        """Sets parameters one after the other; ``done`` hears once whether all are set, or why one is not."""
        (name, value), *rest = settings.items()

        def asked(accepted: bool, reason: str) -> None:
            if accepted and rest:
                self.set(dict(rest), done)
            else:
                done(accepted, reason)

        self._ask(name, value, asked)

    def _ask(self, name: str, value: Any, done: Done) -> None:
        def asked(accepted: bool, reason: str) -> None:
            if accepted:
                self._said[name] = value
                self._wanted.pop(name, None)
                self._publish()
            done(accepted, reason)

        call = "ground_param" if self._line.facts.is_ground else "air_param"
        self._line.ask(call, ParamRequest(name=name, value=json.dumps(value), source=SOURCE), asked)

    def reset(self) -> None:
        """Restores the values of the vehicle's file."""
        self._want(self._file)

    def reload(self) -> None:
        """Restores the stored settings."""
        self._want({**self._file, **self._load()})

    def _want(self, target: Settings) -> None:
        self._wanted = {name: value for name, value in target.items() if self._said.get(name) != value}
        self._publish()

    def save(self) -> str:
        """Stores what differs from the vehicle's file; returns what went wrong, or ""."""
        try:
            self._store.save(self._kept)
        except OSError as error:
            return f"Parameters cannot be kept on this machine: {error.strerror}"
        return ""

    def _publish(self) -> None:
        """Tells the other protocols, and remembers what has changed."""
        own = self.own
        self._line.latest.own = own
        kept = {name: value for name, value in own.items() if value != self._file[name]}
        if kept != self._kept:
            self._kept = kept
            if trouble := self.save():
                self._line.text(mav.MAV_SEVERITY_WARNING, trouble)

    def _load(self) -> Settings:
        """Those that are remembered and still make sense."""
        try:
            found = self._store.load()
        except UnreadableStore as error:
            self.note = f"Parameters: {error}; those of the vehicle's file count"
            return {}
        good = {name: value for name, value in found.items() if self._is_good(name, value)}
        if strange := sorted(found.keys() - good.keys()):
            self.note = f"Parameters: {', '.join(strange)} are remembered but not possible; the vehicle's file counts"
        return {name: value for name, value in good.items() if value != self._file[name]}

    def _is_good(self, name: str, value: Any) -> bool:
        if name not in self._file or name in self._line.facts.fixed_params:
            return False
        try:
            convert({**self._file, name: value}, type(self._line.facts.params), "")
        except BadInput:
            return False
        return True
