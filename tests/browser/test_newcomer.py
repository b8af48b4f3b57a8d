"""Somebody new before the page: everything is found by the name that is written on it, and reached in few actions."""

import numpy as np
import pytest

from schemas import topics
from schemas.messages import Mode
from tests.browser.canvas import on_screen, until
from tests.browser.conftest import opened
from tests.distributed.system import System
from uvf.models.world.map_file import load_map
from uvf.runtime.messages.convert import array

pytestmark = pytest.mark.timeout(300)

FEW = 3
LEGS = ((150.0, 0.0), (400.0, 60.0), (400.0, 300.0))


class Newcomer:
    """Counts what somebody does who sees nothing but the names of things."""

    def __init__(self, page):
        self.page = page
        self.actions = 0

    def press(self, name, role="button", exact=False):
        self.actions += 1
        self.page.get_by_role(role, name=name, exact=exact).first.click(timeout=30_000)

    def click_map(self, x, y):
        self.actions += 1
        self.page.mouse.click(*on_screen(self.page, (x, y, 0.0)))

    def finds_a_way(self, x, y):
        """Clicks the map; what is not mapped yet, or hidden by something, is clicked again by and by: only the last time counts."""
        self.actions = 0
        self.click_map(x, y)
        if until(self.page, self.page.get_by_text(" m clear").first.is_visible, 8.0):
            return True
        self.page.keyboard.press("Escape")
        return False

    def is_sure(self, name, outcome):
        """Presses twice within five seconds, as is asked for; a browser that draws without a graphics card may need another try."""
        self.press(name, exact=True)
        confirm = self.page.get_by_role("button", name=f"Confirm: {name}")
        if until(self.page, confirm.is_visible, 5.0):
            self.press(f"Confirm: {name}")
        return self.sees(outcome, 5.0)

    def sees(self, text, seconds=30.0):
        return until(self.page, self.page.get_by_text(text).first.is_visible, seconds)


@pytest.fixture
def before(browser, tmp_path, request):
    """A mission runs, and somebody opens its page: (system, newcomer). A browser without a graphics card needs processor time too."""
    mission, node, rate = request.param
    with System(tmp_path, "--rate", rate, page=True, mission=mission) as system, opened(browser, system.page, node, (1000, 700)) as page:
        yield system, Newcomer(page)


@pytest.mark.parametrize("before", [("demo", "/vehicles/burger/0", "1")], indirect=True)
def test_a_rover_goes_where_it_is_sent_in_three_actions(before):
    system, somebody = before
    place = lambda: array(system.client.read("burger", topics.TRUTH).position)[:2]  # noqa: E731
    goal = np.array((2.2, 2.6))
    if np.linalg.norm(place() - goal) < 1.2:
        goal = np.array((3.4, 1.2))
    assert until(somebody.page, lambda: somebody.finds_a_way(*goal), 60.0), "no click finds a way"
    somebody.press("Go here: burger")
    assert somebody.actions <= FEW
    assert until(somebody.page, lambda: np.linalg.norm(place() - goal) < 0.4, 90.0), f"it is at {place()}"


@pytest.mark.parametrize("before", [("circuit", "/vehicles/milvus/0", "1")], indirect=True)
def test_an_aircraft_is_armed_takes_off_flies_a_drawn_mission_and_returns(before):
    """The circuit's aircraft stands on its strip; its own mission is replaced before it has taken off."""
    system, somebody = before
    client = system.client
    somebody.press("Hold")
    somebody.press("All", exact=True)
    somebody.press("Plan", role="tab")
    somebody.press("Clear", exact=True) if somebody.page.get_by_role("button", name="Clear", exact=True).is_visible() else None
    state = lambda: client.read("milvus", topics.STATUS)  # noqa: E731
    height = lambda: client.read("milvus", topics.TRUTH).position.z  # noqa: E731
    somebody.press("+ Take-off")
    for x, y in LEGS:
        somebody.click_map(x, y)
        somebody.press("Add waypoint")
    somebody.press("Upload to milvus")
    assert somebody.sees("✓ as it is on milvus")
    if not state().armed:
        somebody.press("Arm milvus")
        somebody.press("Confirm")
        assert until(somebody.page, lambda: state().armed, 20.0)
    somebody.press("Mission", exact=True)
    assert until(somebody.page, lambda: state().mode == Mode.MODE_MISSION, 20.0), f"{state()}"
    assert until(somebody.page, lambda: height() > 30.0, 90.0), f"it is at {height()} m"
    passed = lambda: client.read("milvus", topics.PROGRESS).current  # noqa: E731
    assert until(somebody.page, lambda: passed() >= 2, 90.0), f"it is at item {passed()}: {state()}"
    somebody.press("Return")
    assert until(somebody.page, lambda: state().mode == Mode.MODE_RETURN, 20.0)


@pytest.mark.parametrize("before", [("team", "/vehicles/anne/0", "0.3")], indirect=True)
def test_two_robots_are_driven_one_after_the_other(before):
    system, somebody = before
    for name in ("anne", "bert"):
        somebody.press(f"Select {name}")
        somebody.press("Drive by hand")
        assert until(somebody.page, lambda n=name: system.client.read(n, topics.STATUS).mode == Mode.MODE_MANUAL, 30.0)
        turned = lambda n=name: abs(system.client.read(n, topics.TRUTH).angular_velocity.z)  # noqa: E731
        somebody.page.wait_for_selector("#gcs-wheel[data-driver=mine]", timeout=30_000)
        somebody.page.keyboard.down("a")
        assert until(somebody.page, lambda t=turned: t() > 0.2, 30.0), f"{name} does not turn"
        somebody.page.keyboard.up("a")
        assert until(somebody.page, lambda t=turned: t() < 0.05, 15.0), f"{name} turns on"


@pytest.mark.parametrize("before", [("demo", "/vehicles/burger/0", "0.3")], indirect=True)
def test_another_map_is_begun_and_saved_by_name(before):
    """With the method that is pressed; what is saved is a map that can be named in a mission."""
    system, somebody = before
    somebody.press("Select burger")
    somebody.press("Drive", role="tab")
    assert until(somebody.page, lambda: somebody.is_sure("hector", "begin another map with hector – accepted"), 60.0)
    somebody.press("Log", role="tab")
    assert somebody.sees("another map is begun")
    somebody.press("Drive", role="tab")
    somebody.page.get_by_label("Name of the map").fill("my-house")
    somebody.press("Save map")
    assert somebody.sees("save the map as my-house – accepted")
    saved = load_map(system.maps / "my-house.yaml")
    assert np.count_nonzero(saved.cells == 100) > 50
