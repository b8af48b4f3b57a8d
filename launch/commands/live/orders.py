"""``uvf arm | disarm | mode | goal | cancel | joints``: one request to a vehicle of the running system."""

from contextlib import suppress
from math import nan
from typing import Annotated, Any

import typer

from launch.commands.live.running import SOURCE, Metre, Vehicle, running_system, tell_refusals
from uvf.models.yaml_data import BadInput, nearest

Height = Annotated[float | None, typer.Argument(help="m, world frame, of an aircraft; left out: as high as it is.")]
Yaw = Annotated[float | None, typer.Option(help="rad, from east, left positive: how it is to stand there. Left out: anyhow.")]
Places = Annotated[list[str], typer.Argument(help="As lift_joint=0.3: m, or rad of a joint that turns.")]
Force = Annotated[bool, typer.Option("--force", help="In the air, too: the motor stops.")]


def arm(vehicle: Vehicle) -> None:
    """Arm a vehicle: what it is told moves it from then on."""
    from schemas import topics
    from schemas.messages import ArmRequest

    _ask(vehicle, topics.ARM, ArmRequest(arm=True, source=SOURCE), "armed")


def disarm(vehicle: Vehicle, force: Force = False) -> None:
    """Disarm a vehicle: nothing moves it."""
    from schemas import topics
    from schemas.messages import ArmRequest

    _ask(vehicle, topics.ARM, ArmRequest(arm=False, force=force, source=SOURCE), "disarmed")


def mode(vehicle: Vehicle, name: Annotated[str, typer.Argument(help="As hold, mission, return, manual, offboard.")]) -> None:
    """Change the mode of a vehicle."""
    from schemas import topics
    from schemas.messages import Mode, ModeRequest

    modes = [each.removeprefix("MODE_").lower() for each, value in Mode.items() if value]
    with running_system() as run:
        if name.lower() not in modes:
            raise BadInput(f"no mode '{name}'; {nearest(name, modes)}")
        tell_refusals([run.ask(vehicle, topics.SET_MODE, ModeRequest(mode=f"MODE_{name.upper()}", source=SOURCE))])
        _await_status(run, vehicle)
    typer.echo(f"{vehicle}: mode {name.lower()}")


def goal(vehicle: Vehicle, x: Metre, y: Metre, z: Height = None, yaw: Yaw = None) -> None:
    """Send a vehicle to a place; 'uvf topic echo NAME/nav/status' tells how far it is. The mode is to be mission, of an aircraft hold."""
    from schemas import topics
    from schemas.messages import GoalRequest, Vector3

    with running_system() as run:
        height = run.read(vehicle, topics.POSE).pose.position.z if z is None else z
        request = GoalRequest(position=Vector3(x=x, y=y, z=height), yaw=nan if yaw is None else yaw, source=SOURCE)
        tell_refusals([run.ask(vehicle, topics.GOAL, request)])
    typer.echo(f"{vehicle}: goes to ({x:g}, {y:g})")


def cancel(vehicle: Vehicle) -> None:
    """Cancel the goal of a ground vehicle."""
    from schemas import topics
    from schemas.messages import CancelRequest

    _ask(vehicle, topics.CANCEL, CancelRequest(source=SOURCE), "its goal is cancelled")


def joints(vehicle: Vehicle, places: Places) -> None:
    """Move joints of a ground vehicle: a lift, a pan, an arm; those that its vehicle.yaml lists under ground: joints."""
    from schemas import topics
    from schemas.messages import JointTarget, MoveJointsRequest

    with running_system() as run:
        targets = [JointTarget(name=name, position=position) for name, position in map(_place_of, places)]
        tell_refusals([run.ask(vehicle, topics.MOVE_JOINTS, MoveJointsRequest(joints=targets, source=SOURCE))])
    typer.echo(f"{vehicle}: {', '.join(places)}")


def _place_of(text: str) -> tuple[str, float]:
    name, _, position = text.partition("=")
    try:
        return name, float(position)
    except ValueError:
        raise BadInput(f"'{text}': a joint and where it is to go, as lift_joint=0.3") from None


def _ask(vehicle: str, request: Any, message: Any, done: str) -> None:
    with running_system() as run:
        tell_refusals([run.ask(vehicle, request, message)])
        _await_status(run, vehicle)
    typer.echo(f"{vehicle}: {done}")


def _await_status(run: Any, vehicle: str) -> None:
    """Waits until everybody has heard of the change: the next command of a script builds on it. Not while time is paused."""
    from schemas import topics

    before = run.heard(vehicle, topics.STATUS)
    with suppress(TimeoutError):
        run.wait(lambda: run.heard(vehicle, topics.STATUS) > before + 1, 1.0)
