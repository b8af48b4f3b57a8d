"""The envelope beside a message, and what its numbers tell of losses."""

from uvf.runtime.envelope import Envelope, GapCounter, unpack


def test_it_survives_the_wire_and_nonsense_is_empty():
    envelope = Envelope(7, -1, 2**63, 3)
    assert unpack(envelope.pack()) == envelope
    assert unpack(b"nonsense") == unpack(b"") == Envelope()


def gaps(*pairs):
    counter = GapCounter()
    for boot, seq in pairs:
        counter.count("k", boot, seq)
    return counter.gaps["k"]


def test_missing_numbers_are_gaps():
    assert gaps((1, 1), (1, 2), (1, 5)) == 2


def test_history_that_comes_late_or_twice_is_none():
    assert gaps((1, 4), (1, 5), (1, 3), (1, 5), (1, 6)) == 0


def test_a_new_boot_begins_anew():
    assert gaps((1, 9), (2, 1), (2, 2)) == 0


def test_two_writers_at_a_time_are_noticed_a_successor_is_not():
    counter = GapCounter()
    for boot, seq in ((1, 1), (1, 2), (2, 1), (2, 2)):
        counter.count("k", boot, seq)
    assert counter.rivals == set()
    counter.count("k", 1, 3)
    assert counter.rivals == {"k"}
