"""The envelope beside a message, and what its numbers tell of losses."""

import tracemalloc

from uvf.runtime.bus.envelope import Envelope, GapCounter, unpack


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


def test_numbers_of_32_bits_go_on_from_zero():
    assert gaps((1, 2**32 - 2), (1, 2**32 - 1), (1, 0), (1, 3)) == 2


def test_numbers_of_64_bits_do_not():
    assert gaps((1, 2**32 - 1), (1, 2**32), (1, 2**32 + 3)) == 2


def test_a_nonsensical_number_does_not_end_the_count():
    assert gaps((1, 1), (1, 2), (1, 2**64 - 1), (1, 3), (1, 4), (1, 7), (1, 8)) == 2
    assert gaps((1, 1), (1, 2), (1, 2 + 2**20), (1, 3), (1, 4), (1, 7), (1, 8)) == 2**20 - 1 + 2


def test_a_long_outage_is_a_gap_when_the_next_message_confirms_it():
    assert gaps((1, 1), (1, 2), (1, 2**21)) == 0
    assert gaps((1, 1), (1, 2), (1, 2**21), (1, 2**21 + 1)) == 2**21 - 3


def test_a_second_writer_does_not_hide_what_is_missed_of_the_first():
    assert gaps((1, 1), (2, 50), (1, 2), (2, 51), (1, 6), (2, 52)) == 3


def test_many_keys_and_many_senders_do_not_fill_the_memory_and_those_known_are_counted_on():
    counter = GapCounter()
    counter.count("uvf/v/nav/pose", 1, 1)
    tracemalloc.start()
    for n in range(100_000):
        counter.count(f"uvf/v/x{n}/{'y' * 100}", n, 1)
        counter.count("uvf/x/nav/pose", n, 5)
    counter.count("z" * 60_000_000, 1, 1)
    grown, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert grown < 20_000_000
    counter.count("uvf/v/nav/pose", 1, 4)
    assert dict(counter.gaps) == {"uvf/v/nav/pose": 2}


def test_a_new_boot_begins_anew():
    assert gaps((1, 9), (2, 1), (2, 2)) == 0


def test_two_writers_at_a_time_are_noticed_a_successor_is_not():
    counter = GapCounter()
    for boot, seq in ((1, 1), (1, 2), (2, 1), (2, 2)):
        counter.count("k", boot, seq)
    assert counter.rivals == set()
    counter.count("k", 1, 3)
    assert counter.rivals == {"k"}
