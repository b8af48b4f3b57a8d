"""The whole system in a real browser: tracks move, and a click sends the rover where it points."""

from contextlib import closing

import numpy as np
import pytest

from schemas import topics
from schemas.messages import Mode, SetPoseRequest
from tests.browser.canvas import TRACK, TRACK_BLUE, on_screen, pixels, until
from tests.browser.conftest import opened
from tests.distributed.system import System
from tests.second_try import Shared
from uvf.runtime.messages.convert import array, planar_pose

pytestmark = pytest.mark.timeout(240)

GOAL = (2.2, 2.6)  # m, world: free floor of the room where the rover starts, so that its map knows it soon
NEAR = 1.2  # m: a click here would choose the rover itself
HALL = (5.5, 4.3)  # m, world: its western end
UNDER_WAY = 0.1  # m driven from where it was put


@pytest.fixture(scope="module")
def systems(browser, tmp_path_factory):
    with closing(Shared(lambda: System(tmp_path_factory.mktemp("runs"), page=True))) as shared:
        yield shared


@pytest.fixture
def system(systems, request):
    return systems.for_test(request)


@pytest.fixture
def page(browser, system):
    with opened(browser, system.page, "/vehicles/burger/0", (1000, 640)) as page:
        yield page


def place(system):
    return array(system.client.read("burger", topics.TRUTH).position)[:2]


def test_the_tracks_of_both_vehicles_grow(page):
    for vehicle in ("burger", "milvus"):
        before = page.evaluate(TRACK, vehicle)
        assert until(page, lambda n=before, v=vehicle: page.evaluate(TRACK, v) > n), vehicle
    drawn = pixels(page, TRACK_BLUE)
    assert until(page, lambda: pixels(page, TRACK_BLUE) > drawn + 20), "no more pixels of the track are drawn"


def is_sent(page, system):
    """Whether a click on the goal's place is heeded."""
    page.mouse.click(*on_screen(page, (*GOAL, 0.0)))
    go = page.get_by_role("button", name="Go here: burger")
    if not until(page, go.is_visible, 5.0):
        return False
    go.click()
    return until(page, lambda: system.client.read("burger", topics.NAV_STATUS).job == "goal", 3.0)


def test_a_click_on_the_floor_sends_the_rover_there(page, system):
    assert until(page, lambda: np.linalg.norm(place(system) - GOAL) > NEAR, 60.0), "the rover stands where it shall go"
    assert until(page, lambda: is_sent(page, system), 20.0), "no click is a goal"
    goal = array(system.client.read("burger", topics.NAV_STATUS).goal)[:2]
    assert np.linalg.norm(goal - GOAL) < 0.2
    assert until(page, lambda: np.linalg.norm(place(system) - goal) < 0.3, 90.0), f"it is at {place(system)}"


def speed(system):
    velocity = array(system.client.read("burger", topics.TRUTH).velocity)
    return float(np.hypot(*velocity[:2]))


def to_the_hall(system):
    """Where there are 6 m of floor ahead, wherever it has driven before."""
    request = SetPoseRequest(name="burger", pose=planar_pose(*HALL, 0.0), source="test")
    assert system.client.ask("sys", topics.SET_POSE, request, 20.0).accepted


def is_under_way(page, system):
    """A held key is said again and again, as a keyboard says it."""
    page.keyboard.down("w")
    is_heard = system.client.read("burger", topics.STATUS).command_source == "gcs"
    return is_heard and speed(system) > 0.1 and place(system)[0] > HALL[0] + UNDER_WAY


def drive_forward(page, system):
    """Takes the wheel and holds the key until the rover is under way."""
    page.get_by_role("button", name="Drive by hand").click()
    page.locator("#gcs-wheel .g-keys").wait_for(state="visible", timeout=20_000)
    assert until(page, lambda: system.client.read("burger", topics.STATUS).mode == Mode.MODE_MANUAL)
    to_the_hall(system)
    assert until(page, lambda: is_under_way(page, system)), system.client.read("burger", topics.STATUS)


def is_let_go(system):
    """Whether the page asks for a stand: how soon it does is the browser's, and on a busy machine late."""
    return system.client.read("burger", topics.DRIVE.by("gcs")).linear == 0


def stands_within(system, seconds):
    """Whether the rover comes to a stand in that time of the simulation, and stays there."""
    end = system.client.time + seconds
    system.client.wait(lambda: system.client.time > end, 30.0, "time stands")
    at = place(system)
    system.client.wait(lambda: system.client.time > end + 1.0, 30.0, "time stands")
    return np.linalg.norm(place(system) - at) < 0.01


def test_it_goes_while_a_key_is_held_and_stands_within_a_second_of_its_release(page, system):
    drive_forward(page, system)
    page.keyboard.up("w")
    assert until(page, lambda: is_let_go(system)), "the release does not get through"
    assert stands_within(system, 1.0)


def test_it_stands_when_the_page_that_drives_is_closed(browser, system):
    with opened(browser, system.page, "/vehicles/burger/0", (700, 500)) as page:
        drive_forward(page, system)
    assert stands_within(system, 1.5)


def test_the_graph_hears_the_bus_and_names_who_writes_what(page):
    page.get_by_role("tab", name="Graph").click()
    page.get_by_text("services").first.wait_for(timeout=40_000)
    page.get_by_role("textbox", name="filter").or_(page.get_by_placeholder("filter")).first.fill("nav/pose")
    row = page.locator("[data-slot=topics] tr", has_text="burger/nav/pose").first
    row.wait_for(timeout=40_000)
    assert until(page, lambda: "nobody →" not in row.inner_text() and "/50" in row.inner_text()), row.inner_text()


def test_a_number_that_no_panel_shows_is_plotted(page):
    page.get_by_role("button", name="Select milvus").click()
    page.get_by_role("tab", name="Plot").click()
    page.get_by_label("Topic to plot from").select_option("uvf/milvus/sensor/imu")
    page.get_by_role("button", name="+ specific_force.z [m/s^2]").click()
    points = "() => (document.querySelector('.g-curve')?.getAttribute('d') || '').split('L').length"
    assert until(page, lambda: page.evaluate(points) > 20), page.locator(".g-legend").inner_text()
