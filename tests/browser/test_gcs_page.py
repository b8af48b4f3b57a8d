"""The ground station in a real browser: two vehicles move, a click is a goal, STOP is STOP."""

import numpy as np
import pytest

from schemas.messages import ArmRequest, Event, GoalRequest
from tests.browser.canvas import CAMERA_TO, POSITION, TRACK, TRACK_BLUE, on_screen, pixels, until
from tests.browser.conftest import opened
from tests.services.gcs.scripted import UAV, UGV

pytestmark = pytest.mark.timeout(240)


def position(page, vehicle):
    return np.array(page.evaluate(POSITION, f"/vehicles/{vehicle}"))


def goals(station):
    return [m for _, m in station.script.asked if isinstance(m, GoalRequest)]


def test_both_vehicles_move(page):
    before = {name: position(page, name) for name in (UGV, UAV)}
    for name in (UGV, UAV):
        assert until(page, lambda name=name: np.linalg.norm(position(page, name) - before[name]) > 0.2), name
    assert "LIVE" in page.locator("#gcs-bar").inner_text()


def test_tracks_grow_in_the_scene_and_on_the_screen(page):
    points = page.evaluate(TRACK, UGV)
    assert until(page, lambda: page.evaluate(TRACK, UGV) > points)
    seen = pixels(page, TRACK_BLUE)
    assert until(page, lambda: pixels(page, TRACK_BLUE) > max(1.2 * seen, 30)), (seen, pixels(page, TRACK_BLUE))


def track_drawn(page):
    """Pixels of the track once it is a long one: the first frames of a page are of another blue, and little of it is the vehicle's own."""
    assert until(page, lambda: page.evaluate(TRACK, UGV) > 120)
    assert until(page, lambda: 45 < pixels(page, TRACK_BLUE) < 5000), pixels(page, TRACK_BLUE)
    return pixels(page, TRACK_BLUE)


def test_a_hidden_track_leaves_the_screen(page, station):
    seen = track_drawn(page)
    page.get_by_text("Layers", exact=True).click()
    page.get_by_label("Tracks").uncheck()
    assert until(page, lambda: pixels(page, TRACK_BLUE) < 0.5 * seen)
    page.get_by_label("Tracks").check()
    assert until(page, lambda: pixels(page, TRACK_BLUE) > 0.8 * seen)
    page.get_by_text("Layers", exact=True).click()


def test_a_click_on_the_floor_is_a_goal_there(page, station):
    wanted = (3.9, 4.55)
    view_at_rest(page)
    page.mouse.click(*on_screen(page, (*wanted, 0.0)))
    page.get_by_text("4.2 m, 9 s, 0.30 m clear").wait_for(timeout=20_000)
    assert goals(station) == []
    page.get_by_role("button", name="Go here: burger").click()
    assert until(page, lambda: goals(station))
    goal = goals(station)[-1]
    assert (goal.position.x, goal.position.y) == pytest.approx(wanted, abs=0.1)
    page.get_by_text("– accepted").wait_for(timeout=20_000)


def test_a_click_on_a_vehicle_chooses_it_and_sends_nobody(page, station):
    page.get_by_role("button", name="Select milvus").click()
    page.locator("#gcs-pfd").wait_for(timeout=20_000)
    station.moving = False
    sent = len(goals(station))
    page.wait_for_timeout(1500)
    page.mouse.click(*on_screen(page, position(page, UGV) + np.array((0.0, 0.0, 0.1))))
    page.locator("#gcs-drive").wait_for(timeout=20_000)
    station.moving = True
    assert len(goals(station)) == sent


LATE_FIT = """async () => {
  window.__viserMutable.cameraControl.setLookAt(0, 300, 300, 0, 0, 0, false);
  for (let i = 0; i < 3; i++) await new Promise(requestAnimationFrame);
}"""


def test_follow_takes_the_view_along(page, station):
    def away():
        return page.evaluate(CAMERA_TO, f"/vehicles/{UAV}")

    page.get_by_role("button", name="Select milvus").click()
    page.get_by_role("button", name="Follow").click()
    assert until(page, lambda: away() < 60)
    before = position(page, UAV)
    assert until(page, lambda: np.linalg.norm(position(page, UAV) - before) > 60)
    # Read between two frames the aircraft has flown on, at 25 m/s for up to half a second on a slow machine.
    assert [away() for _ in range(20)] == pytest.approx([40.0] * 20, abs=12.0)
    page.evaluate(LATE_FIT)
    assert until(page, lambda: away() < 60), "a view fitted late takes the vehicle out of sight"
    page.get_by_role("button", name="Scene", exact=True).click()
    assert until(page, lambda: away() > 100)
    page.get_by_role("button", name="Select burger").click()
    page.locator("#gcs-drive").wait_for(timeout=20_000)


CAMERA = "() => window.__viserMutable.camera.position.toArray()"


def view_at_rest(page):
    """The camera's place once it has held still for half a second: a key without the wheel moves it, and it glides on."""

    def rests():
        before = page.evaluate(CAMERA)
        page.wait_for_timeout(500)
        return page.evaluate(CAMERA) == before

    assert until(page, rests)
    return page.evaluate(CAMERA)


def last(drives):
    return drives[-1] if drives else None


def take_the_wheel(page):
    """Whatever was chosen before, and whoever has the wheel, this page too."""
    page.get_by_role("button", name="Select burger").click()
    if page.locator("#gcs-wheel .g-keys").is_visible():
        return
    page.get_by_role("button", name="Drive by hand").click()
    page.locator("#gcs-wheel .g-keys").wait_for(state="visible", timeout=20_000)


def test_keys_drive_only_while_they_are_held_and_leave_the_view_alone(page, station):
    drives = station.script.drives
    page.keyboard.press("w")
    page.wait_for_timeout(500)
    assert drives == []
    take_the_wheel(page)
    view = view_at_rest(page)
    page.keyboard.down("w")
    page.keyboard.down("ArrowLeft")
    assert until(page, lambda: last(drives) == pytest.approx((0.5, 0.5)))
    page.wait_for_timeout(1500)  # longer than a direction counts: the page repeats it
    assert last(drives) == pytest.approx((0.5, 0.5))
    page.keyboard.up("w")
    assert until(page, lambda: last(drives) == pytest.approx((0.0, 0.5)))
    page.keyboard.up("ArrowLeft")
    assert until(page, lambda: last(drives) == (0.0, 0.0))
    assert page.evaluate(CAMERA) == pytest.approx(view)


@pytest.mark.parametrize("event", ["window.dispatchEvent(new Event('blur'))", "window.dispatchEvent(new Event('pagehide'))"])
def test_a_held_button_is_let_go_by_a_page_that_is_left(page, station, event):
    drives = station.script.drives
    take_the_wheel(page)
    page.get_by_role("button", name="backward", exact=True).hover()
    page.mouse.down()
    assert until(page, lambda: last(drives) == pytest.approx((-0.5, 0.0)))
    page.evaluate(f"() => {event}")
    assert until(page, lambda: last(drives) == (0.0, 0.0), 5.0)
    page.mouse.up()


def test_another_page_takes_the_wheel_and_its_end_is_the_end_of_driving(page, browser, station):
    drives = station.script.drives
    take_the_wheel(page)
    with opened(browser, station.port, "/vehicles/milvus/0", (1000, 600)) as other:
        other.get_by_role("button", name="Select burger").click()
        other.get_by_role("button", name="Ask for control").click()
        page.get_by_role("button", name="Hand over").click()
        take_the_wheel(other)
        assert until(page, lambda: not page.locator("#gcs-wheel .g-keys").is_visible())
        other.keyboard.down("s")
        assert until(other, lambda: last(drives) == pytest.approx((-0.5, 0.0)))
    assert until(page, lambda: last(drives) == (0.0, 0.0), 5.0)
    sent = len(drives)
    assert not until(page, lambda: len(drives) > sent + 15, 2.0), "it falls not silent"


def test_arming_wants_a_second_click(page, station):
    page.get_by_role("button", name="Disarm burger", exact=True).click()
    assert not [m for _, m in station.script.asked if isinstance(m, ArmRequest)]
    page.get_by_role("button", name="Confirm: disarm burger").click()
    assert until(page, lambda: [m for n, m in station.script.asked if isinstance(m, ArmRequest) and n == UGV and not m.arm])


def test_stop_all_stops_until_released(page, station):
    page.get_by_role("button", name="■ STOP ALL").click()
    assert until(page, lambda: station.script.stops and station.script.stops[-1].engaged)
    page.locator(".g-alert", has_text="STOP ALL ENGAGED").wait_for(timeout=20_000)
    page.get_by_role("button", name="Release STOP").click()
    assert until(page, lambda: not station.script.stops[-1].engaged)


BOXES = """() => {
  const box = e => { const r = e.getBoundingClientRect(); return [r.left, r.top, r.right, r.bottom]; };
  const over = [...document.querySelectorAll('.g-note, .g-alert, .g-menu')].map(box);
  return [box(document.querySelector('#gcs-bar .g-status')), over, box(window.__viserMutable.canvas)];
}"""


def is_uncovered(page, width):
    """Whether the status is in the window with nothing over it, and all that stands over the scene is within the scene."""
    (left, top, right, bottom), others, canvas = page.evaluate(BOXES)
    aside = [o[0] >= right or o[2] <= left or o[1] >= bottom or o[3] <= top for o in others]
    within = [canvas[0] <= o[0] and o[2] <= canvas[2] for o in others]
    return left >= 0 and right <= width and top >= 0 and others and all((*aside, *within))


@pytest.mark.parametrize("width", [1024, 1440, 1920])
def test_nothing_covers_the_status_at_any_common_width(page, station, width):
    page.set_viewport_size({"width": width, "height": 700})
    for i in range(5):
        station.script.say(UGV, f"a warning of many words, and then some more of them {i}", Event.WARNING, t=station.t)
    page.locator(".g-note", has_text="more of them 4").wait_for(timeout=20_000)
    assert until(page, lambda: is_uncovered(page, width)), page.evaluate(BOXES)
    page.set_viewport_size({"width": 1200, "height": 700})


def holds_the_house(page):
    left, top, right, bottom = page.evaluate(BOXES)[2]
    corners = [on_screen(page, (x, y, 0.0)) for x in (0.0, 12.0) for y in (0.0, 9.0)]
    return all(left < x < right and top < y < bottom for x, y in corners)


def test_the_opening_view_holds_the_whole_house(page, browser, station):
    station.moving = False
    with opened(browser, station.port, "/vehicles/milvus/0", (1100, 700)) as other:
        assert until(other, lambda: holds_the_house(other))
    station.moving = True


@pytest.mark.parametrize(("view", "width"), [("Scene", 1440), ("Top", 1000), ("Top", 1440)])
def test_a_view_holds_the_whole_house_in_a_window_that_changes_its_shape(page, station, view, width):
    page.get_by_role("button", name=view, exact=True).click()
    page.set_viewport_size({"width": width, "height": 700})
    assert until(page, lambda: holds_the_house(page))
    page.set_viewport_size({"width": 1200, "height": 700})
    page.get_by_role("button", name="Scene", exact=True).click()


def test_routine_events_are_shown_when_they_are_asked_for(page, station):
    station.script.say(UAV, "mission item 3 reached", Event.INFO, t=station.t)
    page.get_by_role("tab", name="Log").click()
    event = page.locator(".g-events tr", has_text="mission item 3 reached")
    event.wait_for(state="attached", timeout=20_000)
    assert not event.is_visible()
    page.get_by_role("button", name="All", exact=True).last.click()
    assert event.is_visible()
    page.get_by_role("tab", name="Drive").click()


def test_text_from_the_bus_is_shown_not_run(page, station):
    station.script.say(UGV, "<img src=x onerror='window.hacked=1'>", Event.WARNING, t=station.t)
    page.get_by_role("tab", name="Log").click()
    page.locator(".g-events", has_text="<img src=x").wait_for(timeout=20_000)
    assert page.evaluate("() => window.hacked") is None
    page.get_by_role("tab", name="Drive").click()


def test_a_page_that_joins_late_sees_the_same(page, browser, station):
    assert until(page, lambda: page.evaluate(TRACK, UGV) > 30)
    station.moving = False  # the first page need not draw meanwhile: software rendering is slow
    with opened(browser, station.port, f"/vehicles/{UGV}/0", (700, 400)) as late:
        assert until(late, lambda: late.evaluate(TRACK, UGV) == page.evaluate(TRACK, UGV) > 30), late.evaluate(TRACK, UGV)
    station.moving = True


def test_a_silent_station_is_told_by_the_page_itself(page, station):
    station.living = False
    page.locator("#gcs-dead", has_text="LINK LOST").wait_for(timeout=20_000)
    assert "LIVE" not in page.locator("#gcs-bar").inner_text()
    station.living = True
    page.locator("#gcs-dead").wait_for(state="hidden", timeout=20_000)
    assert "LIVE" in page.locator("#gcs-bar").inner_text()
