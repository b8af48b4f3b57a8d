"""Nothing that happens often pushes out what a person has done, and notices go by themselves."""

from schemas.messages import Event
from services.gcs.state.event_log import ALARMED_FOR, KEPT, TOLD_FOR, WARNED_FOR, EventHistory, EventLine


def test_many_routine_lines_push_out_neither_warnings_nor_the_operators_actions():
    journal = EventHistory()
    journal.write(EventLine(1.0, Event.WARNING, "ugv", "wheel slip"))
    journal.write(EventLine(2.0, Event.INFO, "ugv", "go there: accepted", of_operator=True))
    for i in range(10 * KEPT):
        journal.write(EventLine(3.0 + i, Event.INFO, "uav", f"mission item {i} reached"))
    texts = [line.text for line in journal]
    assert texts[:2] == ["wheel slip", "go there: accepted"]
    assert texts[-1] == f"mission item {10 * KEPT - 1} reached" and len(texts) == KEPT + 2


def test_the_order_is_that_of_writing_whatever_the_class():
    journal = EventHistory()
    for i, severity in enumerate((Event.INFO, Event.ERROR, Event.NOTICE, Event.INFO)):
        journal.write(EventLine(0.0, severity, "", str(i)))
    assert [line.text for line in journal] == ["0", "1", "2", "3"]


def test_a_notice_stands_the_longer_the_worse_it_is():
    journal = EventHistory()
    for severity, good, time in ((Event.INFO, True, TOLD_FOR), (Event.WARNING, False, WARNED_FOR), (Event.CRITICAL, False, ALARMED_FOR)):
        journal.tell(10.0, EventLine(0.0, severity, "", "x"), good)
        assert journal.notices(10.0 + time - 0.1)[0].line.severity == severity
        assert not [n for n in journal.notices(10.0 + time) if n.line.severity == severity]
