"""``uvf param``: the parameters of a vehicle's services while they run."""

import json
from typing import Annotated, Any

import typer

from launch.commands.live.running import NUMBERS, SOURCE, Vehicle, running_system, tell_refusals
from uvf.models.yaml_data import BadInput, nearest, parse_yaml

param_app = typer.Typer(no_args_is_help=True, help="Read and set parameters of running services.")

Name = Annotated[str, typer.Argument(metavar="SERVICE.PARAMETER", help="As tracker.speed.")]


@param_app.command("list")
def param_list(vehicle: Vehicle, service: Annotated[str | None, typer.Argument(help="By default all that have some.")] = None) -> None:
    """Parameters with value, unit and meaning."""
    with running_system() as run:
        for name in run.services(vehicle) if service is None else [_known(run, vehicle, service)]:
            for param in _asked(run, vehicle, name).params:
                unit = f" {param.unit}" if param.unit else ""
                fixed = " (fixed while it runs)" if param.read_only else ""
                typer.echo(f"{name}.{param.name} = {param.value}{unit}  {param.description}{fixed}")


@param_app.command("get")
def param_get(vehicle: Vehicle, name: Name) -> None:
    """The value of one parameter."""
    with running_system() as run:
        service, param = _parts(run, vehicle, name)
        typer.echo(_asked(run, vehicle, service, param).params[0].value)


@param_app.command("set", context_settings=NUMBERS)
def param_set(vehicle: Vehicle, name: Name, value: Annotated[str, typer.Argument(help="A number, true, false or a word.")]) -> None:
    """Set one parameter until the service is started again; the vehicle's file stays as it is."""
    with running_system() as run:
        service, param = _parts(run, vehicle, name)
        data = parse_yaml(value, name) if value.strip() else ""
        typer.echo(f"{name} = {_asked(run, vehicle, service, param, json.dumps(data, default=str)).params[0].value}")


def _known(run: Any, vehicle: str, service: str) -> str:
    services = run.services(vehicle)
    if service not in services:
        raise BadInput(f"{vehicle} has no service '{service}'; {nearest(service, services)}")
    return service


def _parts(run: Any, vehicle: str, name: str) -> tuple[str, str]:
    service, _, param = name.partition(".")
    if not param:
        raise BadInput(f"'{name}': write it as SERVICE.PARAMETER; the services are {', '.join(run.services(vehicle))}")
    return _known(run, vehicle, service), param


def _asked(run: Any, vehicle: str, service: str, name: str = "", value: str = "") -> Any:
    from schemas import topics
    from schemas.messages import ParamRequest

    reply = run.ask(vehicle, topics.PARAM.by(service), ParamRequest(name=name, value=value, source=SOURCE))
    tell_refusals([reply])
    return reply
