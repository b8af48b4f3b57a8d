"""The dialect that is generated from schemas/mavlink says what it has always said, wherever and however often it is made."""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pymavlink
import pytest
from pymavlink.dialects.v20 import common

from services.autopilot.mavlink.telemetry.identity import XML_COMMIT
from uvf.mavlink import dialect
from uvf.mavlink.generate import DEFINITIONS, NAME, dialect_folder
from uvf.models.scenario import ROOT

FIELDS = ("fieldnames", "fieldtypes", "ordered_fieldnames", "lengths", "array_lengths")
FACTS = "30d2abc42d78e66e"
"""Digest of all messages and enumerations: another one means that schemas/mavlink or the generator has changed what is said."""


def messages(module):
    """Number, checksum seed, fields and form on the wire of each message."""
    return {
        m.msgname: (number, m.crc_extra, *(getattr(m, of) for of in FIELDS), m.native_format.decode())
        for number, m in module.mavlink_map.items()
    }


def enumerations(module):
    return {name: {value: entry.name for value, entry in entries.items()} for name, entries in module.enums.items()}


def test_all_messages_and_enumerations_are_what_they_were():
    facts = json.dumps([messages(dialect), enumerations(dialect)], sort_keys=True)
    assert len(messages(dialect)) == 234
    assert hashlib.sha256(facts.encode()).hexdigest()[:16] == FACTS


def test_what_pymavlink_itself_knows_has_the_same_number_and_checksum_seed():
    ours, theirs = messages(dialect), messages(common)
    assert len(theirs) == 210
    assert {name: facts[:2] for name, facts in theirs.items()} == {name: ours[name][:2] for name in theirs}


def test_a_message_looks_on_the_wire_as_pymavlink_writes_it():
    packed = [m.MAVLink_heartbeat_message(2, 12, 0x81, 0, 4, 3).pack(m.MAVLink(None, 1, 1)) for m in (dialect, common)]
    assert packed[0] == packed[1] == bytes.fromhex("fd09000000010100000000000000020c810403638c")


def test_the_commit_that_vehicles_report_is_the_one_the_definitions_are_from():
    (commit,) = re.findall(r"\b[0-9a-f]{40}\b", (DEFINITIONS / "README.md").read_text())
    assert bytes.fromhex(commit)[:8] == XML_COMMIT


def copy_of_the_package(tmp_path):
    """A checkout with the generator and its definitions, but no dialect yet."""
    package = tmp_path / "src/uvf/mavlink"
    package.mkdir(parents=True)
    (package.parent / "__init__.py").touch()
    for name in ("__init__.py", "generate.py"):
        shutil.copy(ROOT / "src/uvf/mavlink" / name, package)
    shutil.copytree(DEFINITIONS, tmp_path / "schemas/mavlink")
    return package


def importing(tmp_path):
    """A process that imports the dialect of the copy, says where it lies and how many messages it has."""
    environment = {"PATH": os.environ["PATH"], "PYTHONPATH": str(tmp_path / "src"), "XDG_CACHE_HOME": str(tmp_path / "cache")}
    script = "from uvf.mavlink import dialect as mav; print(mav.__name__, mav.__file__, len(mav.mavlink_map))"
    # Without site: the checkout of the test is not found there. What pymavlink needs is handed over.
    packages = str(Path(pymavlink.__file__).parents[1])
    start = f"import sys; sys.path.append({packages!r}); {script}"
    return subprocess.Popen([sys.executable, "-S", "-c", start], env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def said(process):
    output, errors = process.communicate(timeout=60)
    assert process.returncode == 0, errors
    return output.split()


def test_processes_that_start_at_once_without_a_dialect_all_get_one(tmp_path):
    package = copy_of_the_package(tmp_path)
    for process in [importing(tmp_path) for _ in range(4)]:
        assert said(process) == ["uvf.mavlink.dialect", str(package / NAME), "234"]
    assert {p.name for p in package.iterdir()} == {"__init__.py", "generate.py", NAME, "__pycache__"}
    assert (package / NAME).read_text() == Path(dialect.__file__).read_text()


def test_where_the_package_cannot_be_written_the_users_cache_serves(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    package = tmp_path / "no folder"
    package.write_text("neither root nor anybody else can write into a file")
    folder = dialect_folder(package)
    assert folder.parent == tmp_path / "cache/uvf"
    made = (folder / NAME).stat().st_mtime_ns
    assert dialect_folder(package) == folder
    assert (folder / NAME).stat().st_mtime_ns == made


def test_a_dialect_from_the_cache_is_imported_under_its_own_name(tmp_path):
    package = copy_of_the_package(tmp_path)
    (package / NAME).mkdir()  # takes the place that the file would be written to
    name, file, count = said(importing(tmp_path))
    assert (name, count) == ("uvf.mavlink.dialect", "234")
    assert Path(file).is_relative_to(tmp_path / "cache")


def test_where_nothing_can_be_written_it_lies_in_a_folder_of_the_process(tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert (dialect_folder(tmp_path / "file") / NAME).is_file()


def test_changed_definitions_are_noticed_and_an_unchanged_dialect_is_kept(tmp_path):
    definitions = tmp_path / "definitions"
    shutil.copytree(DEFINITIONS, definitions)
    made = []
    for added in ("", "", "<!-- changed -->\n"):
        with (definitions / "minimal.xml").open("a") as file:
            file.write(added)
        assert dialect_folder(tmp_path, definitions) == tmp_path
        made.append((tmp_path / NAME).stat().st_mtime_ns)
    assert made[0] == made[1] != made[2]


def test_an_installed_package_brings_its_dialect_along(tmp_path):
    assert dialect_folder(tmp_path, tmp_path / "no definitions") == tmp_path
    assert not (tmp_path / NAME).exists()


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("<mavlink><messages>", "Premature end"),
        ("<mavlink><include>nowhere.xml</include><messages/></mavlink>", "nowhere.xml"),
        ('<mavlink><messages><message id="1" name="A"><field type="float"/></message></messages></mavlink>', "Element 'field'"),
    ],
)
def test_definitions_that_make_no_dialect_are_an_import_error_that_names_the_file(tmp_path, text, reason):
    (tmp_path / "common.xml").write_text(text)
    with pytest.raises(ImportError, match=rf"common\.xml: no dialect can be made of it: .*{reason}"):
        dialect_folder(tmp_path, tmp_path)
