"""``uvf topic`` and ``uvf node``: what is said on the bus, and by whom."""

from typing import Annotated

import typer

from launch.commands.live.running import running_system
from launch.commands.log import KeyArgument
from launch.refusal import bad_input_is_one_line, within

topic_app = typer.Typer(no_args_is_help=True, help="Look at messages, and send some.")
node_app = typer.Typer(no_args_is_help=True, help="Look at running services.")


@topic_app.command("list")
def topic_list(live: Annotated[bool, typer.Option(help="Only what is on the bus now.")] = False) -> None:
    """The table of topics and requests."""
    from launch.commands.live.topic import list_live, list_table

    with bad_input_is_one_line():
        if live:
            list_live()
        else:
            list_table()


@topic_app.command("echo")
def topic_echo(
    key: KeyArgument,
    count: Annotated[int, typer.Option("-n", min=0, help="Stop after so many.")] = 0,
) -> None:
    """Print messages as they come."""
    from launch.commands.live.topic import echo

    with bad_input_is_one_line():
        echo(key, count)


@topic_app.command("pub")
def topic_pub(
    key: Annotated[str, typer.Argument(help="As burger/cmd/client; * is not possible.")],
    fields: Annotated[str, typer.Argument(help="Fields of the message as YAML: '{linear: 0.1}'.")] = "{}",
    rate: Annotated[float, typer.Option(callback=within(0.01, 1000.0), help="Messages a second.")] = 1.0,
    count: Annotated[int, typer.Option("-n", min=0, help="How many; 0: until Ctrl-C.")] = 1,
) -> None:
    """Send messages. A topic that a service writes has two writers then, and its readers hear both."""
    from launch.commands.live.publishing import message_of, publish

    with bad_input_is_one_line():
        owner, topic, message = message_of(key, fields)
    with running_system() as run:
        publish(run, owner, topic, message, rate, count)


@topic_app.command("hz")
def topic_hz(
    key: KeyArgument, seconds: Annotated[float, typer.Option("--for", callback=within(0.01), help="How long to count.")] = 5.0
) -> None:
    """Measure rates, by wall and by simulation time."""
    from launch.commands.live.topic import rates

    with bad_input_is_one_line():
        rates(key, seconds)


@topic_app.command("info")
def topic_info(key: KeyArgument) -> None:
    """Type, rate, QoS, writers and readers of a topic."""
    from launch.commands.live.topic import info

    with bad_input_is_one_line():
        info(key)


@node_app.command("list")
def node_list() -> None:
    """The services that are alive."""
    from launch.commands.live.node import list_nodes

    with bad_input_is_one_line():
        list_nodes()


@node_app.command("graph")
def node_graph() -> None:
    """Who writes what for whom."""
    from launch.commands.live.node import graph

    with bad_input_is_one_line():
        graph()
