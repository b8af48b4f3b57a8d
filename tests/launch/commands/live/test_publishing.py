"""A message for ``uvf topic pub`` from its key and fields; what it cannot be is told in one line."""

import pytest

from launch.commands.live.publishing import message_of
from schemas import topics
from schemas.messages import DriveCommand, SurfaceCommand
from uvf.models.yaml_data import BadInput


def test_fields_become_a_message_of_the_key_s_topic():
    owner, topic, message = message_of("burger/cmd/client", "{linear: 0.1, angular: -1}")
    assert (owner, topic.at(owner), message) == ("burger", "uvf/burger/cmd/client", DriveCommand(linear=0.1, angular=-1.0))


def test_a_source_in_the_middle_of_a_key_and_the_prefix_are_understood():
    owner, topic, message = message_of("uvf/milvus/cmd/client/surfaces", "{}")
    assert (owner, topic.at(owner), message) == ("milvus", topics.SURFACES.by("client").at("milvus"), SurfaceCommand())


@pytest.mark.parametrize(
    ("key", "fields", "why"),
    [
        ("burger/cmd/client", "{linar: 1}", "DriveCommand has no field 'linar'; did you mean 'linear'?"),
        ("burger/cmd/client", "{linear: fast}", "DriveCommand: .*linear"),
        ("burger/cmd/client", "{linear: [1]}", "DriveCommand: .*linear"),
        ("burger/cmd/client", "3", "'3' are no fields"),
        ("burger/cmd/client", "{", "the message.*not valid YAML"),
        ("burger/nav/poes", "{}", "no topic 'burger/nav/poes' in the table; did you mean 'burger/nav/pose'?"),
        ("burger/cmd/*", "{}", "no topic 'burger/cmd/\\*' in the table"),
        ("burger", "{}", "no topic 'burger' in the table"),
        ("uvf", "{}", "no topic 'uvf' in the table"),
    ],
)
def test_bad_input_is_refused(key, fields, why):
    with pytest.raises(BadInput, match=why):
        message_of(key, fields)
