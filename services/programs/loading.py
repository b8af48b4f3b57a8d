"""Programs of vehicles, from the Python files that missions name."""

import importlib.util
import inspect
import sys
import traceback
from pathlib import Path
from types import ModuleType

from uvf.models.yaml_data import BadInput, FileLocation
from uvf.runtime.contract.program import Program

BROKEN = (SyntaxError, ImportError, NameError, AttributeError, LookupError, TypeError, ValueError, ArithmeticError, OSError, AssertionError)
"""What goes wrong while a file is imported."""


def load_program(path: Path, place: FileLocation) -> type[Program]:
    """The program that a Python file defines. Raises BadInput for a file that cannot be imported, or defines none or several."""
    module = _imported(path, place)
    classes = [each for each in vars(module).values() if inspect.isclass(each) and each.__module__ == module.__name__]
    found = [each for each in classes if issubclass(each, Program)]
    if len(found) != 1:
        names = " and ".join(each.__name__ for each in found)
        raise BadInput(f"{place}: {path} defines {names or 'no class derived from Program'}; one file has one program")
    program = found[0]
    if fault := _fault(program):
        raise BadInput(f"{place}: {path}: {program.__name__} {fault}")
    return program


def _imported(path: Path, place: FileLocation) -> ModuleType:
    name = f"uvf_program_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise BadInput(f"{place}: {path} is no Python file (.py)")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses look their module up
    try:
        spec.loader.exec_module(module)
    except BROKEN as error:
        raise BadInput(f"{place}: {path}:{_line(error, path)}: {type(error).__name__}: {error}") from error
    return module


def _line(error: BaseException, path: Path) -> int:
    """The last line of the file on the way to the error."""
    if isinstance(error, SyntaxError):
        return error.lineno or 1
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)]
    return (lines and lines[-1]) or 1


def _fault(program: type[Program]) -> str:
    missing = [name for name in ("name", "hz", "step") if not hasattr(program, name)]
    if missing:
        return f"has no {' and no '.join(missing)}"
    if program.scope != "vehicle" or program.clock != "sim" or program.simulator:
        return "belongs to one vehicle and goes by simulation time: leave scope, clock and simulator out"
    needed = [each for each in inspect.signature(program).parameters.values() if each.default is each.empty]
    return "" if len(needed) == 1 else "is made from its vehicle: write 'def __init__(self, vehicle: MissionVehicle)'"
