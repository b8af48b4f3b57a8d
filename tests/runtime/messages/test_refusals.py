"""What a service does not take is counted by key, whatever a stranger makes of keys."""

from schemas.messages import Health
from uvf.runtime.messages.refusals import KEYS_MOST, LENGTH, SHOWN, TOLD_MOST, Refusals, together
from uvf.runtime.messages.validation import error_in, is_text
from uvf.runtime.time.health import told_gaps


def test_counted_by_key_and_told_once_for_each_reason() -> None:
    told: list[str] = []
    refusals = Refusals(told.append)
    for line in ("uvf/a/scan: untyped bytes", "uvf/a/scan: 9 bytes", "uvf/a/scan: untyped bytes", "uvf/b/cmd: stamped ahead"):
        refusals.refuse(line)
    assert told == ["uvf/a/scan: untyped bytes", "uvf/a/scan: 9 bytes", "uvf/b/cmd: stamped ahead"]
    assert [(r.key, r.count, r.why) for r in refusals] == [("uvf/a/scan", 3, "untyped bytes"), ("uvf/b/cmd", 1, "stamped ahead")]


def test_instances_of_a_process_are_counted_together() -> None:
    one, other = Refusals(lambda line: None), Refusals(lambda line: None)
    for refusals, line in ((one, "a: x"), (other, "b: y"), (other, "b: z"), (other, "a: w"), (other, "b: y")):
        refusals.refuse(line)
    assert [(r.key, r.count, r.why) for r in together((one, other))] == [("b", 3, "y"), ("a", 2, "x")]


def test_keys_that_nobody_should_see_leave_a_sound_message_of_bounded_size() -> None:
    told: list[str] = []
    refusals = Refusals(told.append)
    for i in range(1000):
        refusals.refuse(f"uvf/\x1b[2J\u202e{i}/scan{'x' * 5000}: \x00 {'y' * 5000}")
    assert len(list(refusals)) <= KEYS_MOST
    assert len(told) == TOLD_MOST
    assert all(is_text(line) and len(line) < 5 * LENGTH for line in told)
    health = Health(refusals=together([refusals]))
    assert len(health.refusals) == SHOWN
    assert error_in(health) == ""
    assert health.ByteSize() < 20 * 16 * LENGTH


def test_gaps_on_any_number_of_keys_of_any_name_leave_a_sound_report() -> None:
    gaps = {f"uvf/v{i}/scan": 1 for i in range(16_000)} | {"uvf/\x1b[2J/scan": 50, "uvf/a/scan": 7, "x" * 5000: 60}
    told = told_gaps(gaps)
    assert error_in(Health(gaps=gaps)) != ""
    assert error_in(Health(gaps=told)) == ""
    assert told["uvf/a/scan"] == 7
    assert sum(told.values()) == sum(gaps.values())
    assert told_gaps({"a": 1}) == {"a": 1}
