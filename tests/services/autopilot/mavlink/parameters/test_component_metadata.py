"""Component metadata: every parameter is explained, in the form that ground stations read."""

import json
import lzma
import re

import pytest

from services.autopilot.mavlink.parameters.component_metadata import files_of, general_of, parameters_file_of
from services.autopilot.mavlink.parameters.parameter_table import parameters_of
from services.autopilot.mavlink.parameters.parameter_values import crc32
from tests.services.autopilot.mavlink.rig import PLANE, PLANE_FACTS, ROVER_FACTS, Rig, acks, long, of
from uvf.mavlink import dialect as mav

NUMBER = (int, float)
VERSION = r"^\d+\.\d+\.\d+(\.\d+)?$"
PARAMETER_RULES = {
    "name": (str, r"^[.\-a-zA-Z0-9_{}]{1,16}$"),
    "type": (str, r"^(Uint8|Int8|Uint16|Int16|Uint32|Int32|Float)$"),
    "shortDesc": (str, r".+"),
    "longDesc": (str, r".+"),
    "units": (str, r".+"),
    "default": (NUMBER, None),
    "decimalPlaces": (int, None),
    "min": (NUMBER, None),
    "max": (NUMBER, None),
    "increment": (NUMBER, None),
    "rebootRequired": (bool, None),
    "group": (str, r".+"),
    "category": (str, r".+"),
    "volatile": (bool, None),
    "readOnly": (bool, None),
    "values": (list, None),
    "bitmask": (list, None),
}
TYPE_RULES = {"type": (int, None), "uri": (str, r"^mftp://"), "fileCrc": (int, None)}
GENERAL_RULES = {
    "version": (int, None),
    "vendorName": (str, r".+"),
    "modelName": (str, r".+"),
    "firmwareVersion": (str, VERSION),
    "hardwareVersion": (str, VERSION),
    "metadataTypes": (list, None),
}
"""What the schemas of mavlink/mavlink (component_metadata/general.schema.json, parameter.schema.json) allow and we use."""


def obeys(data, rules, required):
    """No other keys, types and patterns right, what is required there."""
    assert set(required) <= data.keys() <= rules.keys()
    for key, value in data.items():
        kind, pattern = rules[key]
        assert isinstance(value, kind) and (kind is bool or not isinstance(value, bool)), key
        assert pattern is None or re.search(pattern, value), key


def read(facts):
    files = files_of(facts, parameters_of(facts))
    general, parameters = general_of(facts.system_id), parameters_file_of(facts.system_id)
    return json.loads(files[general]), json.loads(lzma.decompress(files[parameters])), files


@pytest.mark.parametrize("facts", [PLANE_FACTS, ROVER_FACTS])
def test_both_files_have_the_form_of_their_schemas(facts):
    general, parameters, files = read(facts)
    obeys(general, GENERAL_RULES, ("version", "metadataTypes"))
    for entry in general["metadataTypes"]:
        obeys(entry, TYPE_RULES, ("type", "uri", "fileCrc"))
        assert entry["fileCrc"] == crc32(files[entry["uri"].removeprefix("mftp://")])
    assert parameters.keys() == {"version", "parameters"}
    assert general["version"] == parameters["version"] == 1  # QGroundControl reads no other
    for entry in parameters["parameters"]:
        obeys(entry, PARAMETER_RULES, ("name", "type", "shortDesc", "group", "default"))
        for choice in entry.get("values", ()):
            obeys(choice, {"value": (NUMBER, None), "description": (str, r".+")}, ("value", "description"))


@pytest.mark.parametrize("facts", [PLANE_FACTS, ROVER_FACTS])
def test_every_parameter_is_explained_and_its_default_is_possible(facts):
    table = parameters_of(facts)
    entries = {entry["name"]: entry for entry in read(facts)[1]["parameters"]}
    assert list(entries) == [p.name for p in table]
    for p in table:
        entry = entries[p.name]
        assert entry["type"] == ("Int32" if p.type == mav.MAV_PARAM_TYPE_INT32 else "Float")
        assert entry.get("min", entry["default"]) <= entry["default"] <= entry.get("max", entry["default"]), p.name
        assert entry["default"] in [choice["value"] for choice in entry.get("values", [{"value": entry["default"]}])], p.name
        assert entry.get("readOnly", False) == bool(p.fixed)
        assert not p.fixed or p.fixed in entry["longDesc"]


def test_the_stream_is_one_that_small_decoders_read():
    """xz magic, then the stream flags: 0 and 1 = CRC-32."""
    assert read(PLANE_FACTS)[2][parameters_file_of(PLANE)][:8] == b"\xfd7zXZ\0\0\x01"


def test_the_files_of_a_vehicle_are_always_the_same():
    assert read(PLANE_FACTS)[2] == read(PLANE_FACTS)[2] != read(ROVER_FACTS)[2]


def test_where_they_are_is_told_when_asked():
    rig = Rig()
    rig.say(long(512, 397.0))
    heard = rig.run()
    (told,) = of(heard, "COMPONENT_METADATA")
    assert acks(heard) == [(512, mav.MAV_RESULT_ACCEPTED)]
    assert told.uri == f"mftp://{general_of(PLANE)}"
    assert told.file_crc == crc32(rig.service._vehicles["plane"].line.files[general_of(PLANE)])
    assert told.get_srcSystem() == PLANE


def test_the_checksum_is_mavlinks():
    """CRC-32 of the nine digits, start 0 and not inverted: by the definition, bit by bit."""
    crc = 0
    for byte in b"123456789":
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xEDB88320 if crc & 1 else 0)
    assert crc32(b"123456789") == crc == 0x2DFD2D88
