"""What waits for a slow reader is bounded in number and in bytes; the newest is never lost."""

import threading

from uvf.runtime.bus.backlog import Backlog


def waiting(backlog):
    return list(iter(backlog.take, None))


def test_in_order_and_the_oldest_go_first():
    backlog = Backlog(3, len)
    for text in ("a", "b", "c", "d"):
        backlog.push(text)
    assert waiting(backlog) == ["b", "c", "d"]
    assert backlog.take() is None


def test_large_messages_push_out_more_than_one():
    backlog = Backlog(100, len, bytes_most=10)
    for text in ("aaaa", "bbbb", "cc", "ddddddd"):
        backlog.push(text)
    assert waiting(backlog) == ["cc", "ddddddd"]
    backlog.push("e" * 10)
    assert waiting(backlog) == ["e" * 10]


def test_one_that_is_larger_than_all_is_not_kept_and_the_next_one_is():
    backlog = Backlog(100, len, bytes_most=10)
    backlog.push("x" * 11)
    backlog.push("y")
    assert waiting(backlog) == ["y"]


def test_the_count_of_bytes_holds_between_two_threads():
    backlog = Backlog(50, len, bytes_most=1000)
    pushing = threading.Thread(target=lambda: [backlog.push("x" * (i % 90)) for i in range(20_000)])
    pushing.start()
    while pushing.is_alive():
        backlog.take()
    rest = waiting(backlog)
    assert len(rest) <= 50 and sum(map(len, rest)) <= 1000
    for _ in range(50):
        backlog.push("y" * 20)
    assert len(waiting(backlog)) == 50
