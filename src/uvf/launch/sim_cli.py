"""``uvf sim ...``: change the running simulation: put things in, move them, save it, hold its time."""

from typing import Annotated, Any

import typer

from uvf.runtime.params import BadInput

sim_app = typer.Typer(no_args_is_help=True, help="Change the running simulation.")

Name = Annotated[str, typer.Argument(help="Of a vehicle or of what has been spawned.")]
State = Annotated[str, typer.Argument(help="Under which name the state is kept.")]
Metre = Annotated[float, typer.Argument(help="m, world frame.")]
Yaw = Annotated[float, typer.Option(help="rad, from east, left positive.")]
Height = Annotated[float | None, typer.Option("--z", help="m; of a shape's middle, by default as it stands on the floor.")]
SOURCE = "cli"


def _ask(request: Any, message: Any) -> None:
    """Exit code 0 when it was done, 1 with the reason when it was refused, 2 without a running system."""
    from schemas.topics import SYSTEM
    from uvf.client import connect

    try:
        with connect() as run:
            reply = run.ask(SYSTEM, request, message)
    except (BadInput, TimeoutError) as error:
        typer.echo(f"uvf: {error}", err=True)
        raise typer.Exit(2) from error
    if not reply.accepted:
        typer.echo(f"uvf: {reply.reason}", err=True)
        raise typer.Exit(1)


@sim_app.command()
def spawn(
    name: Annotated[str, typer.Argument(help="A new name.")],
    what: Annotated[str, typer.Argument(help="box, cylinder, sphere, or a folder in vehicles/.")],
    x: Metre,
    y: Metre,
    z: Height = None,
    yaw: Yaw = 0.0,
    size: Annotated[str, typer.Option(help="m: 0.3,0.3,0.3 of a box; radius,height of a cylinder; radius of a sphere.")] = "",
    mass: Annotated[float, typer.Option(help="kg; 0 = it stands fast.")] = 0.0,
) -> None:
    """Put a shape or a vehicle in."""
    from schemas import topics
    from schemas.convert import planar_pose
    from schemas.messages import SimObject, SpawnRequest

    if what not in HALF:
        made = SimObject(name=name, model=what, pose=planar_pose(x, y, yaw, z or 0.0))
    else:
        sides = _sizes(what, size)
        middle = HALF[what](sides) if z is None else z
        made = SimObject(name=name, shape=what, size=sides, mass=mass, pose=planar_pose(x, y, yaw, middle))
    _ask(topics.SPAWN, SpawnRequest(object=made, source=SOURCE))


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

    _ask(topics.REMOVE, RemoveRequest(name=name, source=SOURCE))


@sim_app.command()
def pose(name: Name, x: Metre, y: Metre, z: Annotated[float, typer.Option("--z", help="m.")] = 0.0, yaw: Yaw = 0.0) -> None:
    """Put a ground vehicle or a spawned object elsewhere, at rest."""
    from schemas import topics
    from schemas.convert import planar_pose
    from schemas.messages import SetPoseRequest

    _ask(topics.SET_POSE, SetPoseRequest(name=name, pose=planar_pose(x, y, yaw, z), source=SOURCE))


@sim_app.command()
def save(name: State) -> None:
    """Keep the ground simulation's state."""
    from schemas import topics
    from schemas.messages import StateRequest

    _ask(topics.SAVE, StateRequest(name=name, source=SOURCE))


@sim_app.command()
def restore(name: State) -> None:
    """Go back to a state that was kept; time goes on."""
    from schemas import topics
    from schemas.messages import StateRequest

    _ask(topics.RESTORE, StateRequest(name=name, source=SOURCE))


def _clock(action: str) -> None:
    from schemas import topics
    from schemas.messages import ClockRequest

    _ask(topics.CLOCK_REQUEST, ClockRequest(action=action))


@sim_app.command()
def reset() -> None:
    """Everything begins again at time 0, in a new epoch."""
    _clock("RESET")


@sim_app.command()
def pause() -> None:
    """Time stands."""
    _clock("PAUSE")


@sim_app.command()
def resume() -> None:
    """Time goes on."""
    _clock("RESUME")


@sim_app.command()
def step() -> None:
    """One tick of 10 ms while time stands."""
    _clock("STEP")
