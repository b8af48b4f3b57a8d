"""After the warm-up no scan waits for a compiler: a first start once stood still for ten seconds in the middle of a room."""

import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import pytest
from numba.core.dispatcher import Dispatcher

from launch.commands.testing import data_folder
from launch.slam.opening import open_log
from services.slam.warm_up import warm_up, warm_up_localization
from uvf.slam.localization import known_map
from uvf.slam.localization.localizer import Localizer
from uvf.slam.localization.params import FilterParams
from uvf.slam.maps.tiles import TileMap
from uvf.slam.methods import METHODS, make_method, method_params

DATA = data_folder()
LOG = "slam/intel/intel.clf"
READINGS = {"rbpf": 300}
"""Of others 2000: the graph has looked for a lost place and for a loop by then."""

pytestmark = pytest.mark.skipif(DATA is None, reason="no data folder: what is compiled on a real drive left out (set UVF_DATA)")


def compiled_now():
    """Each kernel of ours with what it has been compiled for in this process."""
    ours = [m for name, m in sys.modules.items() if name.startswith(("services.", "uvf."))]
    kernels = {id(k): k for m in ours for k in vars(m).values() if isinstance(k, Dispatcher)}.values()
    return {(k.py_func.__module__, k.py_func.__qualname__, signature) for k in kernels for signature in k.signatures}


def compiled_late_by_mapping(name):
    warm_up(make_method(name, method_params(name, {}, "test")))
    before, method, drawn = compiled_now(), make_method(name, method_params(name, {}, "test")), TileMap()
    for reading in open_log(DATA / LOG).readings[: READINGS.get(name, 2000)]:
        method.add(reading)
    drawn.follow(method.keyframes())
    drawn.cells()
    return len(before), compiled_now() - before


def compiled_late_by_localization():
    readings, method = open_log(DATA / LOG).readings, make_method("graph", method_params("graph", {}, "test"))
    for reading in readings[:600]:
        method.add(reading)
    warm_up_localization()
    known = known_map.of_keyframes(tuple(method.keyframes()))
    before, localizer = compiled_now(), Localizer(known, FilterParams(), 1)
    for reading in readings[200:500]:
        localizer.add(reading)
    return len(before), compiled_now() - before


def alone(function, *arguments):
    """In a process of its own, in which no other test has compiled anything."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        return pool.submit(function, *arguments).result()


@pytest.mark.parametrize("name", METHODS)
def test_mapping_compiles_nothing_later(name):
    warm, late = alone(compiled_late_by_mapping, name)
    assert warm > 5 and late == set()


def test_localization_compiles_nothing_later():
    warm, late = alone(compiled_late_by_localization)
    assert warm > 20 and late == set()
