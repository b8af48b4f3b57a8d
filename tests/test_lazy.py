"""What the parts of the library offer: names that a prompt completes, hints for wrong ones, paths as text."""

import inspect
from importlib import import_module
from pathlib import Path

import pytest

import uvf.slam
from uvf.models import load_map, load_mission, load_scenario, load_vehicle, load_world
from uvf.models.scenario import ROOT
from uvf.slam import read_carmen

PARTS = ("control", "estimation", "guidance", "maths", "mavlink", "models", "planning", "sensors", "slam")
HOUSE = ROOT / "examples" / "library" / "house.yaml"


def callables(part):
    """What a part offers to call, methods included: (name, callable)."""
    package = import_module(f"uvf.{part}")
    for name in getattr(package, "__all__", ()):
        offered = getattr(package, name)
        yield name, offered
        if inspect.isclass(offered):
            yield from ((f"{name}.{n}", m) for n, m in inspect.getmembers(offered, callable) if not n.startswith("_"))


@pytest.mark.parametrize("part", ("control", "estimation", "guidance", "models", "planning", "sensors", "slam"))
def test_a_prompt_completes_what_a_part_offers(part):
    package = import_module(f"uvf.{part}")
    assert set(dir(package)) >= {*package.__all__, "__name__", "OFFERED"}


def test_a_wrong_name_is_answered_by_the_nearest_one():
    with pytest.raises(ImportError, match=r"^no 'Graphslam' in uvf\.slam; did you mean 'GraphSlam'\?$"):
        from uvf.slam import Graphslam  # noqa: F401
    with pytest.raises(AttributeError, match=r"^no 'Graphslam' in uvf\.slam; did you mean 'GraphSlam'\?$"):
        _ = uvf.slam.Graphslam


def test_a_name_like_no_other_is_answered_by_all_there_are():
    with pytest.raises(ImportError, match=r"^no 'zzz' in uvf\.control; there are: Altitude.*, AttitudeLoops, .*Surfaces$"):
        from uvf.control import zzz  # noqa: F401
    assert not hasattr(uvf.slam, "zzz")


def test_a_module_of_a_part_is_imported_as_ever():
    from uvf.slam import deskew

    assert deskew.__name__ == "uvf.slam.deskew"


@pytest.mark.parametrize("part", PARTS)
def test_whoever_takes_a_path_takes_text(part):
    strict = []
    for name, offered in callables(part):
        try:
            hints = [p.annotation for p in inspect.signature(offered).parameters.values()]
        except ValueError:  # of a type without a signature
            continue
        strict += [name for hint in hints if hint in (Path, "Path")]
    assert strict == []


def test_paths_may_be_text():
    assert (load_map(str(HOUSE)).cells == load_map(HOUSE).cells).all()
    assert len(read_carmen(str(HOUSE.with_name("house.carmen")))) == 200
    assert load_vehicle(str(ROOT / "vehicles"), "burger") == load_vehicle(ROOT / "vehicles", "burger")
    assert load_world(str(ROOT / "worlds"), "house") == load_world(ROOT / "worlds", "house")
    mission = sorted((ROOT / "missions").glob("*.yaml"))[0]
    assert load_mission(str(mission)) == load_mission(mission)
    assert load_scenario(str(mission), str(ROOT)) == load_scenario(mission)
