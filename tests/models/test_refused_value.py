"""Why a value is refused: no word of the library that finds it, and the way to write it."""

from typing import Annotated

import msgspec
import pytest
from msgspec import Meta

from uvf.models.keys import in_unit, key, name_like, plain
from uvf.models.refused_value import in_words

Angle = Annotated[float, Meta(ge=-7, le=7), key("rad", "Heading.")]
Time = Annotated[float, Meta(gt=0, le=1e6), key("s", "Time.")]
Rate = Annotated[float, Meta(ge=0.01), key("Hz", "Rate.")]
Name = Annotated[str, name_like("[a-z]+", 5, "lower-case letters only"), plain("A name.")]
Lean = Annotated[float, Meta(le=3), in_unit("rad")]


class Part(msgspec.Struct):
    hz: Annotated[float, key("Hz", "Scans per second; of simulation time.")]


class Whole(msgspec.Struct):
    world: Annotated[str, plain("Folder in `worlds/`; see [worlds](worlds.md).")]


class Other(msgspec.Struct):
    urdf: Annotated[str, plain("URDF or xacro file.")]


class Bare(msgspec.Struct):
    x: int


SAID = [
    (90, Angle, "90 is above 7: it is in radians (90 deg = 1.571)"),
    (-90.5, Annotated[Angle | None, key("rad", "")], "-90.5 is below -7: it is in radians (-90.5 deg = -1.58)"),
    (5, Lean, "5 is above 3: it is in radians (5 deg = 0.08727)"),
    (4000, Angle, "4000 is above 7 rad"),
    ("90 deg", Angle, "'90 deg' is not a number; give radians without a unit (90 deg = 1.571)"),
    ("90 s", Time, "'90 s' is not a number; give seconds without a unit"),
    ("soon", Annotated[float, Meta(gt=0)], "'soon' is not a number"),
    ("x", Annotated[float | None, key("N m", "")], "'x' is not a number; give it without a unit"),
    (0, Time, "0 is not above 0"),
    (2e6, Time, "2000000 is above 1000000 s"),
    (0, Rate, "0 is below 0.01 Hz"),
    (-1.0, Annotated[float, Meta(ge=1e-9)], "-1 is not above 0"),
    (10**400, Annotated[float, Meta(ge=0)], "the number is too large"),
    (True, float, "true is not a number"),
    (2.5, int, "2.5 is not a whole number"),
    ("maybe", bool, "'maybe' is neither true nor false"),
    (3, str, "3 is not text; put it in quotes"),
    (None, float, "nothing is given; write a value, or leave the key out"),
    ([1], Whole | None, "a list is not a mapping; write 'key: value' lines, or {key: value}"),
    (0.3, list[float], "0.3 is not a list; write [...]"),
    (0.3, tuple[float, float], "0.3 is not a list of 2; write [..., ...]"),
    ([1.0], tuple[float, float], "it has 1 entry; give 2 entries"),
    ([], Annotated[list[float], Meta(min_length=2)], "it has 0 entries; give at least 2 entries"),
    ("abcdef", Name, "it has 6 characters; give at most 5 characters"),
    ("Kart", Name, "'Kart' is not allowed here; lower-case letters only"),
    ("x" * 99, Annotated[str, Meta(pattern="^y")], f"'{'x' * 59}…' is not allowed here; give another name"),
    ({}, Whole, "key 'world' is missing: folder in worlds/"),
    ({}, Part, "key 'hz' is missing: scans per second [Hz]"),
    ({}, Other, "key 'urdf' is missing: URDF or xacro file"),
    ({}, Bare, "key 'x' is missing"),
]


@pytest.mark.parametrize(("data", "hint", "words"), SAID, ids=[words for *_, words in SAID])
def test_what_is_wrong_is_said_in_words(data, hint, words):
    with pytest.raises(msgspec.ValidationError) as caught:
        msgspec.convert(data, hint)
    assert in_words(data, hint, str(caught.value)) == words
