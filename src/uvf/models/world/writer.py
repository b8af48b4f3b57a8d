"""A world.yaml that a person reads and edits: one thing a line, nothing written that goes without saying."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import msgspec
import yaml

from uvf.models.world.file import Origin, Terrain, WorldFile
from uvf.models.world.wind import Wind

DECIMALS = {"latitude": 8, "longitude": 8, "magnetic_field": 9, "rpy": 6, "scale": 6}
GROUPS = ("walls", "boxes", "ramps", "cylinders", "spheres", "meshes", "looks", "strips", "windsocks", "fields")


def write_world(world: WorldFile, folder: Path, remarks: Sequence[str] = ()) -> Path:
    """Writes ``folder``/world.yaml, with ``remarks`` as comments at its head; returns its path."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "world.yaml"
    path.write_text("\n".join(_lines(world, remarks)) + "\n", encoding="utf-8")
    return path


def _lines(world: WorldFile, remarks: Sequence[str]) -> Iterator[str]:
    yield from (f"# {remark}" for remark in remarks)
    yield f"about: {_flow(world.about)}"
    yield f"origin: {_flow(_plain(world.origin, Origin))}"
    yield f"floor: {_flow(_rounded(world.floor, 3))}"
    if world.wind != Wind():
        yield f"wind: {_flow(_plain(world.wind, Wind))}"
    yield f"magnetic_field: {_flow(_rounded(world.magnetic_field, 9))}  # T, ENU"
    yield f"ground_colour: {_flow(_rounded(world.ground_colour, 3))}"
    if world.terrain is not None:
        yield ""
        yield f"terrain: {_flow(_plain(world.terrain, Terrain))}"
    for group in GROUPS:
        things = getattr(world, group)
        if things:
            yield ""
            yield f"{group}:"
            yield from (f"  - {_flow(_plain(thing, type(thing)))}" for thing in things)


def _plain(thing: Any, type_: type) -> dict[str, Any]:
    """The fields that are not as they are by default."""
    fields = {f.name: f for f in msgspec.structs.fields(type_)}
    values = {name: getattr(thing, name) for name in fields}
    written = {n: v for n, v in values.items() if fields[n].required or v != _default(fields[n])}
    return {n: _rounded(v, DECIMALS.get(n, 4)) for n, v in written.items()}


def _default(field: msgspec.structs.FieldInfo) -> Any:
    return field.default if field.default is not msgspec.NODEFAULT else field.default_factory()


def _rounded(value: Any, decimals: int) -> Any:
    if isinstance(value, msgspec.Struct):
        return _plain(value, type(value))
    if isinstance(value, float):
        return round(value, decimals) + 0.0  # no -0.0
    if isinstance(value, list | tuple):
        return [_rounded(v, decimals) for v in value]
    return value


def _flow(value: Any) -> str:
    text: str = yaml.safe_dump(value, default_flow_style=True, sort_keys=False, width=10_000, allow_unicode=True)
    return text.removesuffix("\n").removesuffix("\n...")
