"""STOP ALL holds while one engagement of anybody is not released by name, whatever order, stamps and epochs the words have."""

import itertools

import pytest

from schemas import topics
from schemas.messages import StopCommand, StopEngagement, StopState, VehicleStatus
from tests.runtime.toys import Pilot
from uvf.runtime.bus.interface import LocalBus, Sample
from uvf.runtime.contract.declaration import Reads, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.messages.validation import error_in
from uvf.runtime.state import stop_all
from uvf.runtime.state.stop_all import ENGAGEMENTS_MOST, StopBook, StopVoice, told

NS = 1_000_000_000
SOURCES = ("gcs", "client")
RUNNING, PAUSED, BACKWARDS = (1, 2, 3, 4), (5, 5, 5, 5), (4, 3, 2, 1)


def sample(command, source, stamp=0, epoch=1, boot=7, seq=1):
    key = topics.STOP.by(source).at("sys")
    return Sample(key, command.DESCRIPTOR.full_name, command.SerializeToString(), stamp, seq, boot, epoch)


def story(stamps, epochs):
    """gcs and client engage; each then releases one: gcs its own, client both (as it has heard them)."""
    gcs, client = StopVoice("gcs"), StopVoice("client")
    words = [("gcs", gcs.engage(0, "button")), ("client", client.engage(0, "program"))]
    first, second = (StopEngagement(source=source, id=command.id) for source, command in words)
    words += [("gcs", gcs.release(0, [first])), ("client", client.release(0, [first, second]))]
    return [
        sample(command, source, stamp, epoch, boot=SOURCES.index(source) + 1, seq=seq)
        for seq, ((source, command), stamp, epoch) in enumerate(zip(words, stamps, epochs, strict=True))
    ]


@pytest.mark.parametrize("stamps", (RUNNING, PAUSED, BACKWARDS), ids=("running", "paused", "backwards"))
@pytest.mark.parametrize("epochs", ((1, 1, 1, 1), (9, 1, 1, 1), (1, 1, 1, 9), (0, 3, 2, 1)), ids=str)
@pytest.mark.parametrize("order", list(itertools.permutations(range(4))), ids=lambda order: "".join("EeRr"[i] for i in order))
def test_two_sources_engage_and_release_in_any_order(stamps, epochs, order):
    """E, e: gcs and client engage; R: gcs releases its own; r: client releases both. Engaged is whose release has not been heard."""
    words, book, heard = story(stamps, epochs), StopBook(), set()
    for i in order:
        book.push(words[i])
        heard.add(i)
        engaged = {source for i, source in enumerate(SOURCES) if i in heard and not ({2, 3} if i == 0 else {3}) & heard}
        assert {one.source for one in book.now.engagements} == engaged, heard
    assert not book.now


@pytest.mark.parametrize("order", list(itertools.permutations(range(4))))
def test_words_said_twice_change_nothing(order):
    words, book = story(RUNNING, (1, 1, 1, 1)), StopBook()
    for i in (*order, *order):
        book.push(words[i])
    assert not book.now


def test_an_engagement_stamped_before_the_last_release_is_heard():
    voice, book = StopVoice("gcs"), StopBook()
    book.push(sample(voice.engage(0, ""), "gcs", 10 * NS))
    book.push(sample(voice.release(0, book.now.engagements), "gcs", 12 * NS))
    book.push(sample(StopVoice("launcher").engage(0, "slam died"), "launcher", 12 * NS - NS // 10))
    assert book.now.who == "launcher (slam died)"


def test_a_leftover_sender_with_a_larger_epoch_deafens_nobody():
    book, left = StopBook(), StopVoice("client")
    book.push(sample(left.engage(0, ""), "client", 99 * NS, epoch=4_000_000_000))
    book.push(sample(left.release(0, book.now.engagements), "client", 99 * NS, epoch=4_000_000_000))
    book.push(sample(StopVoice("gcs").engage(0, ""), "gcs", 1, epoch=1))
    assert book.now.who == "gcs"


def test_pressed_again_while_a_release_is_under_way_it_holds():
    gcs, client, book = StopVoice("gcs"), StopVoice("client"), StopBook()
    book.push(sample(gcs.engage(0, ""), "gcs", seq=1))
    release = client.release(0, book.now.engagements)
    book.push(sample(gcs.engage(0, ""), "gcs", seq=2))
    book.push(sample(release, "client"))
    assert book.now.who == "gcs"


def test_a_release_that_names_nothing_or_comes_from_a_service_does_not_count():
    book = StopBook()
    book.push(sample(StopVoice("gcs").engage(0, ""), "gcs"))
    book.push(sample(StopCommand(engaged=False), "client"))
    book.push(sample(StopCommand(releases=book.now.engagements), "planner"))
    assert book.now
    names_nothing, no_operator = book.refused()
    assert "names nothing" in names_nothing and "not by planner" in no_operator


@pytest.mark.parametrize("envelope", ({"boot": 7}, {"boot": 0, "seq": 0}), ids=("numbered", "bare"))
def test_an_engagement_without_a_name_engages_each_time_it_is_said(envelope):
    """As a program of ten lines says it: on a paused clock its bytes are the same each time."""
    book, operator = StopBook(), StopVoice("gcs")
    for n in range(1, 4):
        book.push(sample(StopCommand(engaged=True), "client", **({"seq": n} | envelope)))
        assert book.now.who == "client", n
        book.push(sample(operator.release(0, book.now.engagements), "gcs"))
        assert not book.now


def test_two_books_name_it_alike():
    one, other = StopBook(), StopBook()
    for book in (one, other):
        book.push(sample(StopCommand(engaged=True), "client", boot=0, seq=0))
    assert one.now == other.now


def test_a_flood_fills_no_memory_and_hides_nobody():
    book = StopBook()
    book.push(sample(StopVoice("gcs").engage(0, "button"), "gcs"))
    for n in range(2000):
        book.push(sample(StopVoice("client").engage(0, ""), "client", seq=n))
        book.push(sample(StopVoice("teleop").release(0, [StopEngagement(source="nobody", id=n)]), "teleop", seq=n))
    assert len(book.now.engagements) <= stop_all.ENGAGEMENTS_MOST
    assert len(book._released) <= stop_all.RELEASED_MOST
    assert book.now.engagements[-1].source == "gcs"


def test_broken_words_that_nobody_asks_about_fill_no_memory_either():
    book = StopBook()
    for n in range(2 * stop_all.REFUSED_MOST):
        book.push(sample(StopCommand(engaged=True), "gcs", seq=n)._replace(payload=b"\xff\xff"))
    assert len(book.refused()) == stop_all.REFUSED_MOST and book.refused() == []


def test_what_waits_for_a_step_that_does_not_come_is_bounded_and_nothing_is_lost():
    book = StopBook(at_once=False)
    book.push(sample(StopVoice("gcs").engage(0, "button"), "gcs", 5 * NS))
    for n in range(2 * stop_all.WAITING_MOST):
        book.push(sample(StopCommand(engaged=False), "planner", 5 * NS, seq=n))
    assert len(book._waiting) == stop_all.WAITING_MOST
    assert book.now.who == "gcs (button)"


def test_broken_bytes_are_refused_with_a_line():
    book = StopBook()
    book.push(sample(StopCommand(engaged=True), "gcs")._replace(payload=b"\xff\xff"))
    assert not book.now
    assert "broken uvf.v1.StopCommand" in book.refused()[0]


@pytest.mark.parametrize("stamp", (0, 5 * NS, 2**62), ids=("old", "now", "future"))
@pytest.mark.parametrize("epoch", (0, 1, 2, 99))
def test_a_service_hears_it_within_one_step_more(stamp, epoch):
    shell = ServiceRunner(ServiceInstance(Pilot, Pilot, "alpha"), LocalBus())
    shell.join(1)
    shell._stops.push(sample(StopVoice("gcs").engage(0, ""), "gcs", stamp, epoch))
    heard = [bool(shell._take(5 * NS + n)["stop"]) for n in range(2)]
    assert heard[1]
    assert heard[0] == (stamp < 5 * NS)


def test_it_outlives_a_new_epoch_and_a_new_process():
    shell = ServiceRunner(ServiceInstance(Pilot, Pilot, "alpha"), LocalBus())
    shell._stops.push(sample(StopVoice("gcs").engage(0, "button"), "gcs"))
    stops = shell._take(NS)["stop"]
    shell.restart(2)
    assert shell._take(NS)["stop"] == stops
    again = ServiceRunner(ServiceInstance(Recalling, Recalling, "alpha"), LocalBus())
    again.recall(lambda key: VehicleStatus(stopped=True, stops=stops.engagements).SerializeToString())
    assert again._take(NS)["stop"].who == "gcs (button)"


class Recalling(Pilot):
    class Recalls(Reads):
        status: None = topic(topics.STATUS)

    def recall(self, left: Recalls) -> None:
        pass


def test_people_are_told_who_and_why():
    named = [StopEngagement(source="gcs", reason="button"), StopEngagement(source="launcher", reason="slam died"), StopEngagement()]
    assert told(named) == "gcs (button); launcher (slam died); somebody unnamed"
    assert told([]) == ""


def heard(*commands, source="gcs"):
    book = StopBook()
    for seq, command in enumerate(commands, 1):
        book.push(sample(command, source, seq=seq))
    return book


@pytest.mark.parametrize("reason", ["\x1b[31mFATAL\x1b[0m", "a\rb", "\u202eback", "x" * 2001, "\u00a0"], ids=ascii)
def test_no_reason_makes_a_stop_unheard(reason):
    book = heard(StopCommand(engaged=True, id=3, reason=reason))
    assert book.now and book.refused()
    assert error_in(StopState(engagements=book.now.engagements)) == ""


def test_no_stamp_makes_a_stop_unheard():
    command = StopCommand(engaged=True, id=3)
    command.timestamp.seconds = -1
    assert heard(command).now


def test_what_a_source_says_is_always_fit_to_be_heard():
    """A process's last line is the launcher's reason, whatever it was."""
    assert error_in(StopVoice("launcher").engage(-5, "slam ended: \x1b[31mFATAL\x1b[0m" + "x" * 5000)) == ""


def test_a_released_name_that_is_used_again_is_told():
    release = StopCommand(releases=[StopEngagement(source="gcs", id=1)])
    book = heard(StopCommand(engaged=True, id=1), release, StopCommand(engaged=True, id=1))
    assert not book.now
    assert book.refused() == ["STOP ALL: engagement 1 of gcs has been released: a new one needs another id"]


def test_a_word_that_is_only_repeated_after_its_release_is_not():
    book = StopBook()
    word = sample(StopCommand(engaged=True, id=1), "gcs", seq=1)
    for each in (word, sample(StopCommand(releases=[StopEngagement(source="gcs", id=1)]), "client", seq=1), word):
        book.push(each)
    assert not book.now and book.refused() == []


def test_more_sources_than_can_be_held_are_held_together_and_push_out_nobody():
    book = StopBook()
    book.push(sample(StopCommand(engaged=True, id=7), "launcher"))
    for n in range(3 * ENGAGEMENTS_MOST):
        book.push(sample(StopCommand(engaged=True, id=n + 1), f"s{n}"))
    sources = [one.source for one in book.now.engagements]
    assert "launcher" in sources and "others" in sources and len(sources) == ENGAGEMENTS_MOST + 1
    book.push(sample(StopCommand(releases=[one for one in book.now.engagements if one.source.startswith("s")]), "gcs"))
    assert [one.source for one in book.now.engagements] == ["launcher", "others"]
