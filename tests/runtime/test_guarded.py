"""What ends a process ends only its copy."""

import ctypes
import gc
import os

import pytest

from uvf.runtime import guarded as guarding
from uvf.runtime.guarded import Died, guarded
from uvf.runtime.params import BadInput
from uvf.runtime.quiet import c_output_discarded


def test_an_answer_comes_back():
    assert guarded(lambda: {"pid": os.getpid()})["pid"] != os.getpid()


def test_bad_input_is_raised_here():
    def work():
        raise BadInput("a line")

    with pytest.raises(BadInput, match="a line"):
        guarded(work)


def test_an_abort_is_told_with_the_last_words_even_where_output_is_discarded():
    def work():
        with c_output_discarded():
            os.write(2, b"FATAL: no such table\n")
            ctypes.CDLL(None).abort()

    with pytest.raises(Died, match="SIGABRT: FATAL: no such table"):
        guarded(work)


def test_an_end_without_an_answer_is_told():
    with pytest.raises(Died, match="exit code 3"):
        guarded(lambda: os._exit(3))


def test_what_never_ends_is_ended(monkeypatch):
    monkeypatch.setattr(guarding, "PATIENCE", 1)
    with pytest.raises(Died, match="not done within 1 s"):
        guarded(lambda: ctypes.CDLL(None).pause())


def test_a_copy_that_is_stuck_is_made_again(monkeypatch, tmp_path):
    monkeypatch.setattr(guarding, "IDLE", 0.2)
    first = tmp_path / "first"

    def work():
        if not first.exists():
            first.touch()
            ctypes.CDLL(None).pause()
        return "done"

    assert guarded(work) == "done"


class Waiting:
    """What is only let go of by a thread that the copy does not have."""

    def __init__(self):
        self.itself, self.home = self, os.getpid()

    def __del__(self):
        if os.getpid() != self.home:
            ctypes.CDLL(None).pause()


def test_the_copy_does_not_collect_what_the_process_has_left_behind(monkeypatch):
    monkeypatch.setattr(guarding, "IDLE", 0.2)
    gc.collect()
    Waiting()
    assert guarded(lambda: len([[] for _ in range(100_000)])) == 100_000
