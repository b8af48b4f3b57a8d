"""``uvf sim ...``: change the running simulation: put things in, move them, save it, hold its time."""

from typing import Annotated, Any

import typer

from launch.commands.live.running import NUMBERS, SOURCE, Metre, running_system, tell_refusals

sim_app = typer.Typer(no_args_is_help=True, help="Change the running simulation.")

Name = Annotated[str, typer.Argument(help="Of a vehicle or of what has been spawned.")]
State = Annotated[str, typer.Argument(help="Under which name the state is kept.")]
Yaw = Annotated[float, typer.Option(help="rad, from east, left positive.")]
Height = Annotated[float | None, typer.Option("--z", help="m; of a shape's middle, by default as it stands on the floor.")]


def _ask(message: Any, *requests: Any) -> None:
    """What one of the simulators does. Exit code 0 when it was done, 1 with the reason when it was refused, 2 without a running system."""
    with running_system() as run:
        replies = _replies(run, requests, message)
    if not any(reply.accepted for reply in replies):
        tell_refusals(replies)


def _ask_all(message: Any, *requests: Any) -> None:
    """What all simulators that run do at the same time, or none."""
    with running_system() as run:
        if not run.is_paused and run.time > 0:  # or the question would wait for the next step, as what is asked for does
            question = type(message)()
            question.CopyFrom(message)
            question.only_ask = True
            tell_refusals(_replies(run, requests, question))
        replies = _replies(run, requests, message)
    tell_refusals(replies)


def _replies(run: Any, requests: Any, message: Any) -> list[Any]:
    """Of those that run. Raises TimeoutError when that is none."""
    from schemas.topics import SYSTEM

    replies = [reply for reply in run.ask_together(SYSTEM, requests, message) if reply is not None]
    if not replies:
        raise TimeoutError(f"nobody answers {' or '.join(request.at(SYSTEM) for request in requests)}")
    return replies


@sim_app.command(context_settings=NUMBERS)
def spawn(
    name: Annotated[str, typer.Argument(help="A new name.")],
    what: Annotated[str, typer.Argument(help="box, cylinder, sphere, or a folder in vehicles/.")],
    x: Metre,
    y: Metre,
    z: Height = None,
    yaw: Yaw = 0.0,
    size: Annotated[str, typer.Option(help="m: 0.3,0.3,0.3 of a box; radius,height of a cylinder; radius of a sphere.")] = "",
    mass: Annotated[float, typer.Option(help="kg; 0 = it stands fast.")] = 0.0,
    speed: Annotated[float, typer.Option(help="m/s through the air, of an aircraft; by default its trim speed.")] = 0.0,
) -> None:
    """Add a shape or a vehicle; an aircraft stands without --z, and flies level with it."""
    from schemas import topics
    from schemas.messages import SimObject, SpawnRequest
    from uvf.runtime.messages.convert import planar_pose

    if what not in HALF:
        made = SimObject(name=name, model=what, pose=planar_pose(x, y, yaw, z or 0.0))
        _ask(SpawnRequest(object=made, source=SOURCE, speed=speed), topics.SPAWN, topics.AIR_SPAWN)
    else:
        sides = _sizes(what, size)
        middle = HALF[what](sides) if z is None else z
        made = SimObject(name=name, shape=what, size=sides, mass=mass, pose=planar_pose(x, y, yaw, middle))
        _ask(SpawnRequest(object=made, source=SOURCE), topics.SPAWN)


HALF: dict[str, Any] = {"box": lambda s: s[2] / 2, "cylinder": lambda s: s[1] / 2, "sphere": lambda s: s[0]}
"""Height [m] of the middle of a shape that stands on the floor."""
COUNT = {"box": 3, "cylinder": 2, "sphere": 1}


def _sizes(shape: str, text: str) -> list[float]:
    try:
        sides = [float(part) for part in text.split(",")]
    except ValueError:
        sides = []
    if len(sides) != COUNT[shape]:
        typer.echo(f"uvf: --size '{text}': a {shape} takes {COUNT[shape]} numbers [m] with commas between", err=True)
        raise typer.Exit(2)
    return sides


@sim_app.command()
def remove(name: Name) -> None:
    """Take out what has been spawned."""
    from schemas import topics
    from schemas.messages import RemoveRequest

    _ask(RemoveRequest(name=name, source=SOURCE), topics.REMOVE, topics.AIR_REMOVE)


@sim_app.command(context_settings=NUMBERS)
def pose(name: Name, x: Metre, y: Metre, z: Annotated[float, typer.Option("--z", help="m.")] = 0.0, yaw: Yaw = 0.0) -> None:
    """Put a ground vehicle or a spawned object elsewhere, at rest."""
    from schemas import topics
    from schemas.messages import SetPoseRequest
    from uvf.runtime.messages.convert import planar_pose

    _ask(SetPoseRequest(name=name, pose=planar_pose(x, y, yaw, z), source=SOURCE), topics.SET_POSE)


@sim_app.command(context_settings=NUMBERS)
def fly(
    name: Name,
    x: Metre,
    y: Metre,
    z: Metre,
    yaw: Yaw = 0.0,
    speed: Annotated[float, typer.Option(help="m/s through the air; by default its trim speed.")] = 0.0,
) -> None:
    """Put an aircraft elsewhere: into level flight, with z = 0 onto its wheels."""
    from schemas import topics
    from schemas.messages import SetPoseRequest
    from uvf.runtime.messages.convert import planar_pose

    _ask(SetPoseRequest(name=name, pose=planar_pose(x, y, yaw, z), speed=speed, source=SOURCE), topics.AIR_POSE)


@sim_app.command()
def save(name: State) -> None:
    """Save the state of the simulation, on the ground and in the air."""
    from schemas import topics
    from schemas.messages import StateRequest

    _ask_all(StateRequest(name=name, source=SOURCE), topics.SAVE, topics.AIR_SAVE)


@sim_app.command()
def restore(name: State) -> None:
    """Restore a saved state; the clock runs on."""
    from schemas import topics
    from schemas.messages import StateRequest

    _ask_all(StateRequest(name=name, source=SOURCE), topics.RESTORE, topics.AIR_RESTORE)


def _clock(action: str) -> None:
    from schemas import topics
    from schemas.messages import ClockRequest

    _ask(ClockRequest(action=action), topics.CLOCK_REQUEST)


@sim_app.command()
def reset() -> None:
    """Restart the simulation at time 0, in a new epoch."""
    _clock("RESET")


@sim_app.command()
def pause() -> None:
    """Pause the simulation clock."""
    _clock("PAUSE")


@sim_app.command()
def resume() -> None:
    """Resume the simulation clock."""
    _clock("RESUME")


@sim_app.command()
def step() -> None:
    """Advance a paused clock by one tick (10 ms)."""
    _clock("STEP")
