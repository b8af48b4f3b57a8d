"""How the command line speaks of what it finds."""

from launch.refusal import counted


def test_one_thing_is_no_plural():
    assert [counted(n, "problem") for n in (0, 1, 2)] == ["0 problems", "1 problem", "2 problems"]
