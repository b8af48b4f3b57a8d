"""Commands to an autopilot: repeated while it is silent, ended by its own answer, refused in its own words."""

import math

import pytest

from services.mavlink_bridge.commands import TRIES, CommandSender, command
from services.mavlink_bridge.connection import Wire
from tests.services.mavlink_bridge.far_end import ack, text
from uvf.mavlink import dialect as mav

ARM, MODE = mav.MAV_CMD_COMPONENT_ARM_DISARM, mav.MAV_CMD_DO_SET_MODE
ACCEPTED, DENIED, BUSY = mav.MAV_RESULT_ACCEPTED, mav.MAV_RESULT_DENIED, mav.MAV_RESULT_IN_PROGRESS


class Desk:
    def __init__(self):
        self.wire = Wire(1, 1)
        self.commands = CommandSender(self.wire)
        self.sent, self.ended = [], []

    def ask(self, number=ARM, p=(1.0,), frame=None):
        self.commands.ask(command(number, p, lambda good, why: self.ended.append((good, why)), frame))
        self.sent += self.wire.take_out()

    def run(self, seconds):
        for _ in range(round(seconds / 0.02)):
            self.wire.t += 0.02
            self.commands.tick()
            self.sent += self.wire.take_out()

    def hear(self, message):
        if message.get_type() == "STATUSTEXT":
            self.wire.hear_text(message)
        else:
            self.commands.on_ack(message)
        self.sent += self.wire.take_out()


@pytest.fixture
def desk():
    return Desk()


def test_an_accepted_command_is_sent_once(desk):
    desk.ask()
    desk.hear(ack(ARM, ACCEPTED))
    desk.run(5.0)
    assert desk.ended == [(True, "")] and len(desk.sent) == 1
    assert (desk.sent[0].target_system, desk.sent[0].target_component, desk.sent[0].confirmation) == (1, 1, 0)


def test_while_nobody_answers_it_is_repeated_with_its_number_and_given_up(desk):
    desk.ask()
    desk.run(10.0)
    assert [m.confirmation for m in desk.sent] == list(range(TRIES))
    assert len(desk.ended) == 1 and desk.ended[0][1].startswith("no answer from the autopilot within 3.2")


def test_a_late_answer_of_a_repetition_ends_it_once(desk):
    desk.ask()
    desk.run(1.0)
    desk.hear(ack(ARM, ACCEPTED))
    desk.hear(ack(ARM, ACCEPTED))
    assert desk.ended == [(True, "")]


@pytest.mark.parametrize("before", [True, False], ids=["words first", "words behind"])
def test_a_refusal_bears_the_autopilots_words(desk, before):
    desk.ask()
    desk.run(0.1)
    words, refusal = text("Arming denied: no GNSS fix"), ack(ARM, DENIED)
    for message in (words, refusal) if before else (refusal, words):
        desk.hear(message)
    desk.run(0.5)
    assert desk.ended == [(False, "denied: Arming denied: no GNSS fix")]


def test_old_or_harmless_words_explain_nothing(desk):
    desk.hear(text("an old trouble"))
    desk.run(1.0)
    desk.ask()
    desk.hear(text("battery is fine", mav.MAV_SEVERITY_INFO))
    desk.hear(ack(ARM, DENIED))
    desk.run(0.5)
    assert desk.ended == [(False, "denied")]


def test_an_unknown_command_is_said_to_be_so(desk):
    desk.ask()
    desk.hear(ack(ARM, mav.MAV_RESULT_UNSUPPORTED))
    desk.run(0.5)
    assert desk.ended == [(False, "the autopilot does not know this command")]


def test_in_progress_extends_the_patience(desk):
    desk.ask()
    desk.hear(ack(ARM, BUSY))
    desk.run(2.5)
    assert len(desk.sent) == 1 and not desk.ended
    desk.hear(ack(ARM, ACCEPTED))
    assert desk.ended == [(True, "")]


def test_answers_to_others_and_of_other_commands_are_not_ours(desk):
    desk.ask()
    desk.hear(ack(ARM, DENIED, to=(255, 190)))
    desk.hear(ack(MODE, DENIED))
    desk.run(0.5)
    assert not desk.ended
    desk.hear(ack(ARM, ACCEPTED, to=(0, 0)))
    assert desk.ended == [(True, "")]


def test_two_of_a_number_go_one_after_the_other_and_two_numbers_together(desk):
    desk.ask(p=(1.0,))
    desk.ask(p=(0.0,))
    desk.ask(MODE, (1.0, 4.0, 3.0))
    assert [(m.command, m.param1) for m in desk.sent] == [(ARM, 1.0), (MODE, 1.0)]
    desk.hear(ack(ARM, ACCEPTED))
    desk.run(0.1)
    assert [(m.command, m.param1) for m in desk.sent][2:] == [(ARM, 0.0)]


def test_a_place_goes_out_as_integers_and_what_is_left_out_as_such(desk):
    desk.ask(mav.MAV_CMD_DO_REPOSITION, (-1.0, 1.0, 0.0, math.nan, 40.77, math.nan, 350.0), frame=0)
    (sent,) = desk.sent
    assert (sent.get_type(), sent.x, sent.y, sent.z) == ("COMMAND_INT", 407700000, 2**31 - 1, 350.0)


def test_when_the_link_is_lost_everything_ends(desk):
    desk.ask()
    desk.ask(MODE, (1.0, 4.0, 3.0))
    desk.commands.give_up("the link was lost")
    assert desk.ended == [(False, "the link was lost")] * 2


def test_a_long_text_is_put_together(desk):
    words = "Arming denied: the airspeed sensor reads 12 m/s at rest, look at the pitot tube"
    assert desk.wire.hear_text(text(words[:50], id=7, seq=0)) == []
    assert [said.text for said in desk.wire.hear_text(text(words[50:], id=7, seq=1))] == [words]


def test_a_text_whose_end_never_came_does_not_spoil_the_next(desk):
    desk.wire.hear_text(text("x" * 50, id=7, seq=0))
    desk.run(3.0)
    assert [said.text for said in desk.wire.hear_text(text("short", id=7, seq=0))] == ["x" * 50 + "…", "short"]


def test_a_text_is_said_as_far_as_it_has_come_where_its_end_is_lost(desk):
    desk.wire.hear_text(text("motor 1 has failed, landing at the nearest field. ", severity=0, id=7, seq=0))
    assert desk.wire.unfinished_texts() == []
    desk.run(3.0)
    (said,) = desk.wire.unfinished_texts()
    assert (said.severity, said.text) == (0, "motor 1 has failed, landing at the nearest field. …")
    assert desk.wire.unfinished_texts() == []


def test_a_chunk_that_is_lost_in_the_middle_leaves_a_mark(desk):
    desk.wire.hear_text(text("a" * 50, id=7, seq=0))
    (said,) = desk.wire.hear_text(text("end", id=7, seq=2))
    assert said.text == "a" * 50 + "…end"


def hold_first(desk):
    desk.commands.ask_first(command(MODE, (1.0, 4.0, 3.0), lambda good, why: desk.ended.append((good, why))))
    desk.sent += desk.wire.take_out()


def test_what_was_under_way_is_never_sent_after_a_command_to_hold(desk):
    desk.ask(MODE, (1.0, 4.0, 4.0))
    desk.run(0.2)
    hold_first(desk)
    desk.run(10.0)
    assert [m.param3 for m in desk.sent] == [4.0] + [3.0] * (1 + TRIES)
    assert desk.ended[0] == (False, "not sent again: a command to hold or to disarm came after it")
    assert desk.ended[1][1].startswith("no answer")


def test_an_answer_to_what_was_under_way_is_not_taken_for_that_to_the_hold(desk):
    desk.ask(MODE, (1.0, 4.0, 4.0))
    hold_first(desk)
    desk.hear(ack(MODE, ACCEPTED))
    desk.run(0.02)
    desk.hear(ack(MODE, DENIED))
    desk.run(1.0)
    assert desk.ended == [(True, ""), (False, "denied")]
