"""What was set over MAVLink outlives the process, the autopilot and the system; a broken file costs the settings, nothing else."""

import stat

import msgspec
import pytest

from services.autopilot.mavlink.parameters.parameter_store import FileStore, UnreadableStore
from tests.services.autopilot.mavlink.parameters.test_parameters import ask_list, setting, value
from tests.services.autopilot.mavlink.rig import _PLANE_PARAMS, PLANE, Rig, Shelf, acks, long, of, texts
from uvf.mavlink import dialect as mav


def loiter(rig):
    """(what is told, what the autopilot has)."""
    return {m.param_id: value(m) for m in ask_list(rig)}["NAV_LOITER_RAD"], rig.plane.autopilot.params.hold_radius


def after_setting(radius=150.0):
    rig = Rig()
    rig.run()
    rig.say(setting("NAV_LOITER_RAD", radius))
    rig.run(0.2)
    return rig


def test_only_what_differs_from_the_vehicles_file_is_remembered():
    rig = after_setting()
    assert rig.shelf.settings == {"hold_radius": 150.0}
    rig.say(setting("NAV_LOITER_RAD", 90.0))
    rig.run(0.2)
    assert rig.shelf.settings == {}


def test_a_new_system_begins_with_what_was_set_and_tells_so_from_the_first_word():
    rig = Rig(shelf=after_setting().shelf)
    rig.reported.clear()
    assert loiter(rig) == (150.0, 90.0)  # the autopilot is not there yet
    rig.reported.add("plane")
    heard = rig.run(0.3)
    assert rig.plane.autopilot.params.hold_radius == 150.0
    assert of(heard, "PARAM_VALUE") == []  # nothing has changed for anybody


def test_a_new_link_takes_what_the_autopilot_has():
    rig = after_setting()
    rig.plane.set("hold_radius", 111.0)
    rig.restart()
    rig.run()
    assert loiter(rig) == (111.0, 111.0) and rig.shelf.settings == {"hold_radius": 111.0}


def test_an_autopilot_that_begins_anew_gets_it_again_also_after_a_pause():
    rig = after_setting()
    rig.plane.begin(_PLANE_PARAMS)
    rig.clock.state = rig.clock.PAUSED
    rig.run(0.5)
    assert rig.plane.autopilot.params.hold_radius == 90.0
    rig.clock.state = rig.clock.RUNNING
    rig.run(1.5)
    assert loiter(rig) == (150.0, 150.0) and rig.shelf.settings == {"hold_radius": 150.0}


def test_what_the_page_sets_is_remembered_too():
    rig = Rig()
    rig.run()
    rig.plane.set("low_action", "hold")
    rig.run()
    assert rig.shelf.settings == {"low_action": "hold"}


def test_reset_goes_back_to_the_vehicles_file_and_tells_everybody():
    rig = after_setting()
    rig.say(setting("FW_AIRSPD_TRIM", 30.0))
    rig.run(0.2)
    rig.say(long(245, 2.0))
    heard = rig.run(0.4)
    assert acks(heard) == [(245, mav.MAV_RESULT_ACCEPTED)]
    assert rig.plane.autopilot.params == _PLANE_PARAMS and rig.shelf.settings == {}
    told = {m.param_id: value(m) for m in of(heard, "PARAM_VALUE")}
    assert told == {"NAV_LOITER_RAD": 90.0, "HOLD_RADIUS": 90.0, "FW_AIRSPD_TRIM": 25.0, "TRIM_AIRSPEED": 25.0}


def test_all_of_them_are_reset_in_time():
    rig = Rig()
    rig.run()
    fields = [f for f in msgspec.structs.fields(_PLANE_PARAMS) if isinstance(f.default, float)]
    for field in fields:
        rig.plane.set(field.name, getattr(_PLANE_PARAMS, field.name) * 1.001)
    rig.run()
    assert len(rig.shelf.settings) > 50
    rig.say(long(245, 2.0))
    assert acks(rig.run(0.5)) == [(245, mav.MAV_RESULT_ACCEPTED)]
    assert rig.plane.autopilot.params == _PLANE_PARAMS


def test_load_takes_what_is_remembered_and_save_answers():
    rig = after_setting()
    rig.shelf.settings = {"hold_radius": 200.0}
    rig.say(long(245, 0.0))
    assert acks(rig.run(0.4)) == [(245, mav.MAV_RESULT_ACCEPTED)]
    assert loiter(rig) == (200.0, 200.0)
    rig.say(long(245, 1.0))
    assert acks(rig.run()) == [(245, mav.MAV_RESULT_ACCEPTED)]
    rig.shelf.trouble = OSError(28, "No space left on device")
    rig.say(long(245, 1.0, 0.0))
    heard = rig.run()
    assert acks(heard) == [(245, mav.MAV_RESULT_FAILED)]
    assert "Parameters cannot be kept on this machine: No space left on device" in texts(heard)


@pytest.mark.parametrize("p1", [3.0, 7.0, -1.0, float("nan")])
def test_nothing_else_is_done_with_the_storage(p1):
    rig = Rig()
    rig.say(long(245, p1))
    assert acks(rig.run()) == [(245, mav.MAV_RESULT_DENIED)]


def test_in_a_pause_they_are_not_reset():
    rig = after_setting()
    rig.clock.state = rig.clock.PAUSED
    rig.say(long(245, 2.0))
    assert acks(rig.run()) == [(245, mav.MAV_RESULT_TEMPORARILY_REJECTED)]
    assert loiter(rig) == (150.0, 150.0)


def test_a_broken_file_means_the_vehicles_own_values_and_everybody_hears_why():
    shelf = Shelf()
    shelf.trouble = UnreadableStore("plane.json is broken")
    rig = Rig(shelf=shelf)
    rig.say(mav.MAVLink_param_request_list_message(PLANE, 0))
    assert "Parameters: plane.json is broken; those of the vehicle's file count" in texts(rig.run(2.0))
    shelf.trouble = None
    rig.say(setting("NAV_LOITER_RAD", 150.0))
    rig.run(0.2)
    assert loiter(rig) == (150.0, 150.0) and shelf.settings == {"hold_radius": 150.0}


@pytest.mark.parametrize(
    "strange", [{"wings": 2}, {"hold_radius": 1e9}, {"hold_radius": "wide"}, {"link_action": "sing"}, {"estimator": "book"}]
)
def test_what_is_remembered_but_not_possible_is_left_out_and_told(strange):
    rig = Rig(shelf=Shelf(**strange, takeoff_alt=55.0))
    rig.say(mav.MAVLink_param_request_list_message(PLANE, 0))
    told = texts(rig.run(2.0))
    assert any(f"{next(iter(strange))} are remembered but not possible" in text for text in told)
    assert rig.plane.autopilot.params == msgspec.structs.replace(_PLANE_PARAMS, takeoff_alt=55.0)


def test_a_file_keeps_them_whole(tmp_path):
    path = tmp_path / "demo" / "milvus.json"
    store = FileStore(path)
    assert store.load() == {}
    store.save({"hold_radius": 150.0, "low_action": "hold"})
    assert FileStore(path).load() == {"hold_radius": 150.0, "low_action": "hold"}
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


@pytest.mark.parametrize("content", [b"", b"{", b"[1]", b"\xff\xfe", b"[" * 100_000])
def test_a_file_that_holds_no_settings_is_named(tmp_path, content):
    path = tmp_path / "milvus.json"
    path.write_bytes(content)
    with pytest.raises(UnreadableStore, match=r"milvus\.json"):
        FileStore(path).load()
