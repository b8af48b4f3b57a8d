"""What ``uvf bench`` says while it measures, and what it writes down of where figures come from."""

import re
import types

import pytest

from launch.commands import bench, bench_page
from launch.commands.bench_page import BenchmarkGoal, facts_now, replace_section, verdicts
from uvf.models.scenario import ROOT
from uvf.models.yaml_data import BadInput

RESULTS = (ROOT / "benchmarks" / "results.md").read_text()


@pytest.fixture
def measured(monkeypatch):
    """The names of the cases that have run, of a group ``bus`` of two."""
    ran = []

    def case(name):
        return lambda data: ran.append(name) or {name: {"us": 1.5}}

    module = types.SimpleNamespace(CASES={name: case(name) for name in ("one", "two")})
    monkeypatch.setattr(bench.importlib, "import_module", lambda name: module)
    return ran


def test_each_step_is_a_plain_line_on_stderr_when_the_table_is_piped(measured, capsys):
    bench.run_groups(["bus"], None, None, False)
    told = capsys.readouterr()
    lines = told.err.splitlines()
    assert lines[0] == "uvf: bus one (1 of 2)" and lines[2] == "uvf: bus two (2 of 2)"
    assert re.fullmatch(r"uvf: bus two took \d+\.\d s", lines[3])
    assert "uvf:" not in told.out and "1.5" in told.out


def test_a_misspelt_case_of_a_later_group_is_refused_before_the_first_one_runs(measured):
    with pytest.raises(BadInput, match="no case 'thre' in sim"):
        bench.run_groups(["bus", "sim", "thre"], None, None, False)
    assert measured == []


def test_a_section_says_its_command_commit_date_machine_and_load(measured, monkeypatch, tmp_path):
    monkeypatch.setattr(bench, "RESULTS", tmp_path / "results.md")
    bench.run_groups(["bus", "one"], None, None, True)
    page = bench.RESULTS.read_text()
    assert re.search(
        r"^\* `\./uvf bench bus one --write`; commit [0-9a-f]{7,}.*, \d{4}-\d\d-\d\d; \d+ x .+, Python 3\.11.*, load before", page, re.M
    )
    assert "| one | 1.5 |" in page


def test_a_renewed_section_leaves_the_others_as_they_were():
    page = replace_section(replace_section("# Results\n", "a", {"x": {"m": 1.0}}, ["then"]), "b", {"y": {"m": 2.0}}, ["then"])
    again = replace_section(page, "a", {"x": {"m": 3.0}}, ["now"])
    assert again.count("## ") == 2
    assert "* now" in again and "| x | 3 |" in again and "| y | 2 |" in again and "| x | 1 |" not in again


def test_some_cases_of_a_group_leave_the_figures_of_the_others(measured, monkeypatch, tmp_path):
    monkeypatch.setattr(bench, "RESULTS", tmp_path / "results.md")
    for names in (["bus"], ["bus", "one"], ["bus", "two"], ["bus", "one"]):
        bench.run_groups(names, None, None, True)
    assert re.findall(r"(?m)^## .*", bench.RESULTS.read_text()) == ["## bus", "## bus one", "## bus two"]


def test_goals_are_met_or_not_met(monkeypatch):
    goal = BenchmarkGoal(["x", "y", "gone"], "m", "docs/x.md", at_most=2.0, at_least=0.5)
    monkeypatch.setattr(bench_page, "_stated", lambda group: bench_page.Stated([goal]))
    met, missed = verdicts("any", {"x": {"m": 2.0}, "y": {"m": 0.4}})
    assert met == "Goal of docs/x.md: x, m at least 0.5 and at most 2: 2, met"
    assert missed.endswith("y, m at least 0.5 and at most 2: 0.4, not met")


@pytest.mark.parametrize("section", re.split(r"(?m)^## ", RESULTS)[1:], ids=lambda section: section.split("\n")[0])
def test_every_section_of_the_results_says_where_it_comes_from(section):
    name, _, body = section.partition("\n")
    first = body.strip().splitlines()[0]
    assert first.startswith(f"* `./uvf bench {name}")
    assert re.search(r"commit [0-9a-f]{7}.*, 20\d\d-\d\d-\d\d", first)


def test_every_goal_is_of_rows_that_the_results_have():
    stated = bench_page.load_yaml(bench_page.GOALS, bench_page._Page).groups
    for group in stated.keys() - {"formation"}:  # has no section yet
        for goal in stated[group].goals:
            assert all(f"| {row} |" in RESULTS for row in goal.rows)
            assert goal.column in RESULTS and (ROOT / goal.source).is_file()


def test_facts_name_the_command_as_it_can_be_typed():
    assert facts_now(["accuracy", "milvus good"]).command == "./uvf bench accuracy 'milvus good' --write"
