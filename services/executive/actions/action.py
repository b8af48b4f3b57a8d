"""What a task of one vehicle does: the base of all actions, and those on arming and modes."""

from collections.abc import Iterable
from typing import Protocol

from schemas.messages import ArmRequest, Mode, ModeRequest
from services.executive.asking import PendingRequest
from services.executive.interface import SOURCE
from services.executive.situation import TeamSituation


class Failed(Exception):
    """A task cannot be done; the text says why."""


class TaskAction(Protocol):
    """Something that is done in several steps."""

    reason: str
    """What it does now, in words."""

    @property
    def refusal(self) -> str:
        """Why what it asks for has been refused until now; empty where it has not."""
        ...

    def begin(self, now: TeamSituation) -> None:
        """Begins, perhaps not for the first time."""

    def step(self, now: TeamSituation) -> bool:
        """One step; whether it is done. Raises Failed."""
        ...

    def stop(self, now: TeamSituation) -> None:
        """It is needed no more, before it was done."""


def first_refusal(actions: Iterable[TaskAction]) -> str:
    """The refusal of the first action that has met one."""
    return next((action.refusal for action in actions if action.refusal), "")


class RequestAction:
    """Base of actions that ask a vehicle for something."""

    def __init__(self, vehicle: str) -> None:
        self.vehicle = vehicle
        self.reason = ""
        self._ticket: PendingRequest | None = None

    def begin(self, now: TeamSituation) -> None:
        """Begins with nothing asked."""
        self.reason, self._ticket = "", None

    def step(self, now: TeamSituation) -> bool:
        """One step; whether it is done. Raises Failed."""
        raise NotImplementedError

    def stop(self, now: TeamSituation) -> None:
        """Asks no more."""
        now.desk.drop(self._ticket)
        self._ticket = None

    @property
    def refusal(self) -> str:
        """Why what it asks for has been refused until now; empty where it has not."""
        return f"{self.vehicle}: {self._ticket.reason}" if self._ticket is not None and self._ticket.reason else ""

    def _accepted(self, now: TeamSituation, ticket: PendingRequest) -> bool:
        """Whether what was asked is accepted. Raises Failed once it is refused for good."""
        self._ticket = ticket
        self.reason = ticket.reason or f"asks {self.vehicle}"
        if ticket.refused:
            self._ticket = None
            raise Failed(f"{self.vehicle}: {ticket.reason}")
        return ticket.accepted


class ArmAction(RequestAction):
    """Arms or disarms a vehicle."""

    def __init__(self, vehicle: str, arm: bool) -> None:
        super().__init__(vehicle)
        self._arm = arm

    def step(self, now: TeamSituation) -> bool:
        """Whether the vehicle is armed, or disarmed."""
        if now.is_armed(self.vehicle) is self._arm and self._ticket is None:
            return True
        ticket = self._ticket or now.desk.ask("arm", self.vehicle, ArmRequest(arm=self._arm, source=SOURCE))
        return self._accepted(now, ticket) and now.is_armed(self.vehicle) is self._arm


class ChangeModeAction(RequestAction):
    """Changes the mode of a vehicle."""

    def __init__(self, vehicle: str, mode: int) -> None:
        super().__init__(vehicle)
        self._mode = mode

    def step(self, now: TeamSituation) -> bool:
        """Whether the vehicle has been in the mode since it was asked; takeoff and landing may be over already."""
        if now.mode(self.vehicle) == self._mode and self._ticket is None:
            return True
        ticket = self._ticket or now.desk.ask("mode", self.vehicle, ModeRequest(mode=Mode.Name(self._mode), source=SOURCE))
        return self._accepted(now, ticket)


class EngageAction(RequestAction):
    """Brings a vehicle to where it takes orders: armed, and in a mode. It is done once; a mode that others choose later is theirs."""

    def __init__(self, vehicle: str, mode: int) -> None:
        super().__init__(vehicle)
        self._parts: tuple[RequestAction, ...] = (ArmAction(vehicle, True), ChangeModeAction(vehicle, mode))
        self._at = 0

    def begin(self, now: TeamSituation) -> None:
        """Begins with arming."""
        self._at = 0
        for part in self._parts:
            part.begin(now)

    def step(self, now: TeamSituation) -> bool:
        """Whether the vehicle is armed and in the mode."""
        while self._at < len(self._parts) and self._parts[self._at].step(now):
            self._at += 1
        done = self._at == len(self._parts)
        self.reason = "" if done else self._parts[self._at].reason
        return done

    @property
    def refusal(self) -> str:
        """Why it is not armed, or not in the mode."""
        return self._parts[self._at].refusal if self._at < len(self._parts) else ""

    def stop(self, now: TeamSituation) -> None:
        """Asks no more."""
        for part in self._parts:
            part.stop(now)


class EngagedAction(RequestAction):
    """Base of what a vehicle does once it is armed and in mode Mission."""

    def __init__(self, vehicle: str) -> None:
        super().__init__(vehicle)
        self._engage = EngageAction(vehicle, Mode.MODE_MISSION)
        self._engaged = False

    def begin(self, now: TeamSituation) -> None:
        """Begins with arming the vehicle."""
        super().begin(now)
        self._engage.begin(now)
        self._engaged = False

    def stop(self, now: TeamSituation) -> None:
        """Asks no more; the vehicle goes on with its job until somebody tells it something else."""
        super().stop(now)
        self._engage.stop(now)

    @property
    def refusal(self) -> str:
        """Why it has not begun."""
        return self._engage.refusal or super().refusal

    def step(self, now: TeamSituation) -> bool:
        """Whether it is done. Raises Failed where it cannot be."""
        if not self._engaged:
            self._engaged = self._engage.step(now)
            self.reason = self._engage.reason
            return False
        return self._carry_out(now)

    def _carry_out(self, now: TeamSituation) -> bool:
        raise NotImplementedError
