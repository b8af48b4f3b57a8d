"""What a terminal sends as keys, and how the terminal is left."""

import os
import pty
import termios

import pytest

from launch.teleop.terminal import Keys, TerminalClosed, key_by_key
from uvf.models.yaml_data import BadInput


@pytest.mark.parametrize(
    ("data", "keys"),
    [
        (b"wWa ", ["w", "W", "a", " "]),
        (b"\x1b[A\x1b[B\x1b[C\x1b[D", ["up", "down", "right", "left"]),
        (b"\x1bOA\x1bOD", ["up", "left"]),
        (b"\x1b[3~w", ["w"]),
        (b"\x1b[1;5Aw", ["w"]),
        (b"\x1bww", ["w", "w"]),
        (b"", []),
        (b"\xff\x00", ["\ufffd", "\x00"]),
    ],
)
def test_letters_arrows_and_nothing_else(data, keys):
    assert Keys().feed(data) == keys


def test_a_sequence_that_comes_in_pieces_is_one_key():
    keys = Keys()
    assert [keys.feed(piece) for piece in (b"w\x1b", b"[", b"Aw", b"\x1bO", b"B")] == [["w"], [], ["up", "w"], [], ["down"]]


@pytest.fixture
def terminal(monkeypatch):
    """(our side, its settings): standard input is a terminal of its own."""
    ours, its = pty.openpty()
    monkeypatch.setattr("sys.stdin", os.fdopen(its, "r"))
    yield ours, lambda: termios.tcgetattr(its)
    try:
        os.close(ours)
    except OSError:
        return


def test_keys_come_without_return_and_the_settings_are_put_back(terminal):
    ours, settings = terminal
    before = settings()
    with key_by_key() as keys:
        assert settings()[3] & (termios.ICANON | termios.ECHO) == 0
        os.write(ours, b"w\x1b[A")
        assert keys.read(1.0) == ["w", "up"]
        assert keys.read(0.0) == []
    assert settings() == before


def test_a_key_can_be_pressed_from_within_and_loses_nothing(terminal):
    ours, _ = terminal
    with key_by_key() as keys:
        os.write(ours, b"w")
        keys.press("x")
        assert keys.read(1.0) + keys.read(1.0) == ["x", "w"]


def test_a_signal_throws_no_key_away(terminal):
    ours, _ = terminal
    with key_by_key() as keys:
        os.write(ours, b"w\x03")
        assert keys.read(1.0) == ["w"]


def test_the_settings_are_put_back_after_an_exception(terminal):
    _, settings = terminal
    before = settings()
    with pytest.raises(ZeroDivisionError), key_by_key():
        raise ZeroDivisionError
    assert settings() == before


def test_a_terminal_that_is_closed_is_noticed_and_leaving_it_raises_nothing(terminal):
    ours, _ = terminal
    with pytest.raises(TerminalClosed), key_by_key() as keys:
        os.close(ours)
        keys.read(1.0)


def test_no_terminal_is_refused(monkeypatch):
    with open(os.devnull) as nothing:  # noqa: PTH123
        monkeypatch.setattr("sys.stdin", nothing)
        with pytest.raises(BadInput, match="its input is no terminal"), key_by_key():
            pass


@pytest.mark.usefixtures("terminal")
def test_a_line_is_cut_to_the_width(monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "10")
    with key_by_key() as keys:
        keys.show("0123456789abc")
        assert capsys.readouterr().out == "\r\x1b[2K012345678"
