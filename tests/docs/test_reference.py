"""The reference is made from the types, and the types say everything."""

import importlib
import pkgutil
import re
import subprocess
from collections.abc import Iterator

import pytest

import services
from launch.docs import api_pages, keys_page, pages, params_page, source_links
from launch.docs.tables import Key, keys_of
from uvf.models.keys import unit_of
from uvf.models.params import Params
from uvf.models.scenario import ROOT


def all_keys() -> Iterator[tuple[str, Key]]:
    for struct in [*keys_page.structs(), *(params for params, _ in params_page.SERVICES.values())]:
        yield from ((f"{struct.__name__}.{key.name}", key) for key in keys_of(struct))


def every(kind: type) -> Iterator[type]:
    for each in kind.__subclasses__():
        yield each
        yield from every(each)


def test_generated_pages_are_up_to_date():
    assert pages.outdated() == []


def test_every_key_has_a_meaning():
    assert [name for name, key in all_keys() if not key.meta.description] == []


def test_every_number_has_a_unit_or_says_that_it_has_none():
    assert [name for name, key in all_keys() if key.is_number and unit_of(key.meta) is None] == []


def test_every_measure_says_what_it_measures_in_which_unit_and_when():
    assert all(m.meaning and m.unit and m.counts.startswith("Counts ") for m in keys_page.measures())


def test_a_measure_without_a_unit_is_refused(monkeypatch):
    def odd(track):
        """Something."""

    monkeypatch.setitem(keys_page.MEASURES, "odd", odd)
    with pytest.raises(ValueError, match="odd"):
        keys_page.measures()


def test_every_set_of_parameters_is_on_the_page():
    for module in pkgutil.walk_packages(services.__path__, "services."):
        importlib.import_module(module.name)
    shown = {params for params, _ in params_page.SERVICES.values()}
    used = {each for each in every(Params) if not any(issubclass(other, each) for other in shown if other is not each)}
    assert {each.__name__ for each in used if each.__struct_fields__ and not each.__module__.startswith(("tests", "uvf_program"))} == {
        each.__name__ for each in shown if each.__struct_fields__
    }


def test_links_to_files_of_the_repository_become_their_paths():
    page = "[the table](../../schemas/topics.py), [topics.py](../../schemas/topics.py), [topics](topics.md), `[a](../../b)`"
    shown = source_links.shown(page, "reference/x.md", ROOT / "docs")
    assert shown == "the table (`schemas/topics.py`), `schemas/topics.py`, [topics](topics.md), `[a](../../b)`"


def test_a_link_to_nowhere_is_a_warning(caplog):
    source_links.shown("[gone](../../schemas/gone.py)", "reference/x.md", ROOT / "docs")
    assert "schemas/gone.py" in caplog.text


def test_paths_that_pages_name_are_there():
    named = re.compile(r"`((?:src|services|launch|schemas|tests|benchmarks|examples|worlds|vehicles|missions|docs)/[\w./-]+)`")
    written = re.compile(r"missions/(first|scout|yard|wander)|vehicles/(scout|NAME)|worlds/yard")  # by the reader
    texts = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    gone = [
        (p.name, path) for p in texts for path in named.findall(p.read_text()) if not written.match(path) and not (ROOT / path).exists()
    ]
    assert gone == []


def test_no_page_is_left_out_of_the_repository():
    kept = subprocess.run(["git", "check-ignore", *(str(p) for p in pages.PAGES)], cwd=ROOT, capture_output=True, text=True, check=False)
    assert kept.stdout == ""


def test_every_environment_variable_that_the_code_reads_is_on_the_page_and_the_other_way_round():
    """A name in quotes in the code, or expanded by the shell's and compose's files."""
    sources = [path for folder in ("src", "launch", "services") for path in (ROOT / folder).rglob("*.py")]
    read = {name for path in sources for name in re.findall(r"""["'](UVF_[A-Z_]+)["']""", path.read_text())}
    tests = (ROOT / "tests").rglob("*.py")
    others = [ROOT / "uvf", ROOT / "docker-compose.yml", *tests]
    expanded = {name for path in others for name in re.findall(r"""(?:\$\{|environ(?:\.get)?[(\[]["'])(UVF_[A-Z_]+)""", path.read_text())}
    page = (ROOT / "docs" / "reference" / "environment.md").read_text()
    assert set(re.findall(r"^\| `(UVF_[A-Z_]+)`", page, re.MULTILINE)) == read | expanded


@pytest.mark.parametrize("part", api_pages.PARTS)
def test_the_page_of_a_part_begins_with_what_one_imports_and_an_example(part):
    page = api_pages.render(part)
    sections = [line for line in page.splitlines() if line.startswith(("## ", ":::"))]
    assert sections[:3] == ["## What you import", "## Example", "## All modules"]
    offered = getattr(importlib.import_module(f"uvf.{part}"), "__all__", api_pages.modules(part))
    rows = dict(re.findall(r"^\| \[`([\w.]+)`\]\[[\w.]+\] \| (.+) \|$", page, re.MULTILINE))
    assert set(rows) == set(offered)
    assert f"uvf.{part}" in page.partition("```python")[2].partition("```")[0]
