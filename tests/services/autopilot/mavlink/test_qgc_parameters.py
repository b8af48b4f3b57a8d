"""QGroundControl and the parameters: its cache, its metadata, its way to write; and each fault would be noticed."""

import json
import lzma

import pytest

from services.autopilot.mavlink.parameters.component_metadata import general_of, parameters_file_of
from tests.services.autopilot.mavlink.qgc_parameters import FOREIGN_TEXTS, WRITE
from tests.services.autopilot.mavlink.qgroundcontrol import QGroundControl
from tests.services.autopilot.mavlink.rig import PLANE, ROVER, Rig
from uvf.mavlink import dialect as mav

GENERAL, PARAMETERS = general_of(PLANE), parameters_file_of(PLANE)


def connected(system=PLANE, spoil=lambda message: message, rig=None):
    station = QGroundControl(rig or Rig(), system, spoil)
    station.connect()
    return station


def again(first, spoil=lambda message: message):
    """The same program connects once more, with what it has kept; (station, values it was sent)."""
    sent = []

    def counting(message):
        if message.get_type() == "PARAM_VALUE" and message.param_id != "_HASH_CHECK":
            sent.append(message.param_id)
        return spoil(message)

    second = QGroundControl(first.rig, first.system, counting)
    second.cache = first.cache
    second.connect()
    return second, sent


@pytest.mark.parametrize("system", [PLANE, ROVER])
def test_the_second_connection_needs_no_list(system):
    first = connected(system)
    second, sent = again(first)
    assert second.parameters == first.parameters and len(first.parameters) > 50
    assert sent == [] and second.complaints == []


def test_a_change_in_between_brings_the_whole_list_again():
    first = connected()
    first.rig.plane.set("hold_radius", 123.0)
    first.rig.run()
    second, sent = again(first)
    assert second.parameters["NAV_LOITER_RAD"] == 123.0 and set(sent) == set(first.parameters)


def test_a_wrong_hash_would_cost_the_list():
    def spoil(message):
        if message.get_type() == "PARAM_VALUE" and message.param_id == "_HASH_CHECK":
            message.param_value = 1.5
        return message

    first = connected()
    assert set(again(first, spoil)[1]) == set(first.parameters)


@pytest.mark.parametrize("system", [PLANE, ROVER])
def test_each_parameter_has_metadata_that_allows_its_value(system):
    station = connected(system)
    assert station.notes == []
    assert station.metadata.keys() == station.parameters.keys()
    for name, number in station.parameters.items():
        entry = station.metadata[name]
        assert entry.get("min", number) <= number + 1e-6 and number - 1e-6 <= entry.get("max", number), name


def test_a_parameter_is_written_or_refused_with_the_reason_at_once():
    station = connected()
    t = station.rig.t
    assert station.set("NAV_LOITER_RAD", 150.0) and station.set("NAV_DLL_ACT", 1)
    assert station.complaints == [] and station.rig.t - t < 0.4
    assert not station.set("NAV_LOITER_RAD", 1e6) and not station.set("SYS_AUTOSTART", 4001)
    assert station.complaints == [
        f"{WRITE}: param: NAV_LOITER_RAD - Parameter value out of range",
        f"{WRITE}: param: SYS_AUTOSTART - Parameter is read only",
    ]
    assert station.rig.t - t < 0.6


def corrupted(path, change):
    """A rig whose plane serves another content under a path."""
    rig = Rig()
    files = rig.service._vehicles["plane"]._ftp._tree._files
    key = tuple(path.strip("/").split("/"))
    files[key] = change(files[key])
    return rig


def without(kind):
    return lambda message: None if message.get_type() == kind else message


@pytest.mark.parametrize("kind", ["COMPONENT_METADATA", "FILE_TRANSFER_PROTOCOL"])
def test_metadata_that_does_not_come_would_be_noticed(kind):
    assert connected(spoil=without(kind)).notes == [FOREIGN_TEXTS]


@pytest.mark.parametrize(
    ("path", "change"),
    [
        (GENERAL, lambda content: content[:-1]),
        (GENERAL, lambda content: content.replace(b"UVF", b"UVX")),
        (PARAMETERS, lambda content: content[:-1] + b"x"),
        (PARAMETERS, lambda content: lzma.compress(json.dumps({"version": 3, "parameters": []}).encode())),
    ],
)
def test_files_other_than_promised_would_be_noticed(path, change):
    assert connected(rig=corrupted(path, change)).notes == [FOREIGN_TEXTS]


def test_a_vehicle_that_keeps_the_old_value_without_an_error_would_be_noticed():
    def spoil(message):
        if message.get_type() == "PARAM_VALUE" and message.param_id == "NAV_LOITER_RAD":
            message.param_value = 90.0
        return None if message.get_type() == "PARAM_ERROR" else message

    station = connected(spoil=spoil)
    t = station.rig.t
    assert not station.set("NAV_LOITER_RAD", 150.0)
    assert station.complaints == [f"{WRITE}: param: NAV_LOITER_RAD"] and station.rig.t - t > 2.9


def test_an_answer_of_the_wrong_type_would_be_noticed():
    def spoil(message):
        if message.get_type() == "PARAM_VALUE" and message.param_id == "NAV_LOITER_RAD" and message.param_value == 150.0:
            message.param_type = mav.MAV_PARAM_TYPE_INT32
        return message

    station = connected(spoil=spoil)
    assert not station.set("NAV_LOITER_RAD", 150.0)
