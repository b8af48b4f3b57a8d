"""A container's process is called as ``uvf up`` calls it."""

import pytest
import yaml

from launch.supervise import process_name
from uvf.models.scenario import ROOT
from uvf.models.yaml_data import BadInput


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ("service slam --mission demo", "slam"),
        ("service slam --mission demo --vehicle burger", "slam.burger"),
        ("service slam --vehicle=burger", "slam.burger"),
        ("router --listen tcp/0.0.0.0:7447", "router"),
        ("record /runs", "recorder"),
    ],
)
def test_its_name_is_that_of_the_process(arguments, name):
    assert process_name(arguments.split()) == name


@pytest.mark.parametrize("arguments", ["", "service", "up demo", "topic echo x"])
def test_what_is_no_process_of_a_run_is_refused(arguments):
    with pytest.raises(BadInput, match="cannot supervise"):
        process_name(arguments.split())


def test_every_container_is_supervised_under_the_name_of_its_stanza():
    stanzas = yaml.safe_load((ROOT / "docker-compose.yml").read_text())["services"]
    for name, stanza in stanzas.items():
        command, *arguments = stanza["command"]
        assert (command, process_name(arguments)) == ("supervise", name)
