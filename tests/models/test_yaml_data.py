"""Files from people: what is wrong, where, and how to mend it, in one line."""

import itertools
import time
from typing import Annotated, Literal

import msgspec
import pytest

from schemas.limits import TEXT
from uvf.models.yaml_data import BadInput, convert, load_yaml, nearest, parse_yaml

Positive = Annotated[float, msgspec.Meta(gt=0)]


class Part(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    size: tuple[Positive, Positive] = (1.0, 1.0)
    weight: Positive | None = None


class Whole(msgspec.Struct, forbid_unknown_fields=True):
    name: str = ""
    part: Part = Part()
    parts: list[Part] = []
    named: dict[str, Part] = {}
    law: Literal["logarithmic", "power"] = "power"


def load(tmp_path, text):
    path = tmp_path / "f.yaml"
    path.write_text(text)
    return load_yaml(path, Whole)


BAD = {
    "part:\n  wieght: 1": "f.yaml:2: part: wieght: unknown key 'wieght'; did you mean 'weight'?",
    "parts: [{}, {sise: 1}]": "f.yaml:1: parts[1]: sise: unknown key 'sise'; did you mean 'size'?",
    "named: {a: {x: 1}}": "named: a: x: unknown key 'x'; there are: size, weight",
    "named:\n  a: {}\n  b:\n    weight: -1": "f.yaml:4: named: b: weight: -1 is not above 0",
    "law: log": "f.yaml:1: law: no 'log' here; there are: logarithmic, power",
    "law: 3": "f.yaml:1: law: 3 is not text; put it in quotes",
    "part: {weight: .nan}": "part: weight: nan is no number to work with",
    "part: {size: [1, .inf]}": "part: size[1]: inf is no number to work with",
    "part: {size: [1]}": "part: size: it has 1 entry; give 2 entries",
    "name: a\nname: b": "f.yaml:2: not valid YAML: key 'name' is given twice",
    "parts: [{size: [1, 1],\n size: [1, 1]}]": "f.yaml:2: not valid YAML: key 'size' is given twice",
    "name: [": "f.yaml:1: not valid YAML",
    "[" * 3000: "nested too deeply",
    "parts: &a [*a]": "f.yaml:1: not valid YAML: it contains itself",
    "name: a\n? [a]\n: b": "f.yaml:2: not valid YAML: a key is a list or a mapping; write a name or a number",
    "name: a\n? {a: 1}\n: b": "f.yaml:2: not valid YAML: a key is a list or a mapping",
    "": "f.yaml: the file is empty",
    "- name": "f.yaml: a list is not a mapping; write 'key: value' lines",
    "name: !!int x": "f.yaml: not valid YAML",
    "name: !!python/name:os.system": "f.yaml:1: not valid YAML",
    "!!map [name]": "f.yaml:1: not valid YAML",
    "name: \x01": "f.yaml: not valid YAML",
    "part: {weight: 1" + "0" * 400 + "}": "part: weight: the number is too large",
}


def ever_more(first, repeated):
    """Lines of which each repeats the one before nine times."""
    lines = [f"{b}: &{b} " + repeated.format(",".join([f"*{a}"] * 9)) for a, b in itertools.pairwise("abcdefgh")]
    return "\n".join([f"a: &a {first}", *lines])


BOMBS = {
    "lists": ever_more("[x]", "[{}]"),
    "a key": ever_more("[x]", "[{}]") + "\n? *h\n: 1",
    "merged lists": ever_more("{k: 1}", "{{<<: [{}]}}"),
    "merged twice": "\n".join(["a0: &a0 {k: 1}", *(f"a{i + 1}: &a{i + 1} {{<<: *a{i}, <<: *a{i}}}" for i in range(40))]),
}


@pytest.mark.parametrize("bomb", BOMBS)
def test_a_small_file_that_stands_for_a_huge_one_is_refused_at_once(tmp_path, bomb):
    before = time.process_time()
    with pytest.raises(BadInput, match=r"f\.yaml:\d+: not valid YAML: more than 100000 values, counting what is repeated"):
        load(tmp_path, BOMBS[bomb])
    assert time.process_time() - before < 1.0


def test_what_is_repeated_and_merged_in_measure_is_read(tmp_path):
    text = "part: &p {weight: 2.0}\nparts: [*p, *p]\nnamed: {a: {<<: [*p, {size: [3, 4]}]}}"
    assert load(tmp_path, text) == Whole(part=Part(weight=2.0), parts=[Part(weight=2.0)] * 2, named={"a": Part((3.0, 4.0), 2.0)})


@pytest.mark.parametrize("text", BAD, ids=range(len(BAD)))
def test_what_is_wrong_is_one_line_that_names_the_place(tmp_path, text):
    with pytest.raises(BadInput) as caught:
        load(tmp_path, text)
    assert BAD[text] in str(caught.value)
    assert str(tmp_path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_what_is_no_text_is_refused(tmp_path):
    binary, folder = tmp_path / "binary.yaml", tmp_path / "folder.yaml"
    binary.write_bytes(bytes(range(256)))
    folder.mkdir()
    for path, why in ((binary, "it is not text in UTF-8"), (folder, "Is a directory"), (tmp_path / "no.yaml", "No such file")):
        with pytest.raises(BadInput, match=f"{path}: cannot be read: {why}"):
            load_yaml(path, Whole)


def test_numbers_with_exponents_are_numbers(tmp_path):
    assert load(tmp_path, "part: {weight: 2.6e6, size: [1e3, 1.5E-2]}").part == Part((1e3, 1.5e-2), 2.6e6)


def test_what_looks_like_a_number_is_read_as_people_mean_it():
    text = "{ten: 010, minus: -07, hex: 0x1F, octal: 0o17, time: 1:30, date: 2026-11-28, thousand: 1_000, binary: 0b11, small: .5}"
    assert parse_yaml(text, "f.yaml") == {
        **{"ten": 10, "minus": -7, "hex": 31, "octal": 15, "small": 0.5},
        **{"time": "1:30", "date": "2026-11-28", "thousand": "1_000", "binary": "0b11"},
    }


def test_the_nearest_name_is_offered_or_all_there_are():
    assert nearest("burgr", ["burger", "milvus"]) == "did you mean 'burger'?"
    assert nearest("xyz", ["burger", "milvus"]) == "there are: burger, milvus"
    assert nearest("rays", ["beams", "bias", "range_max"]) == "there are: beams, bias, range_max"


def test_each_value_of_a_row_has_limits_of_its_own(tmp_path):
    low, high = (Annotated[float, msgspec.Meta(le=limit)] for limit in (1, 5))
    assert convert([1, 5], tuple[low, high], "f.yaml") == (1.0, 5.0)
    with pytest.raises(BadInput, match=r"f\.yaml: 1: 6 is above 5"):
        convert([1, 6], tuple[low, high], "f.yaml")
    with pytest.raises(BadInput, match=r"it has 3 entries; give 2 entries"):
        convert([1, 1, 1], tuple[low, high], "f.yaml")


def test_of_a_section_all_keys_are_listed():
    keys = msgspec.defstruct("Section", [(f"key_{letter}", int) for letter in "abcdefghijklmn"])
    with pytest.raises(BadInput) as caught:
        convert({"zzz": 1}, keys, "f.yaml")
    assert str(caught.value) == f"f.yaml: zzz: unknown key 'zzz'; there are: {', '.join(f'key_{letter}' for letter in 'abcdefghijklmn')}"


def test_of_many_names_or_long_ones_so_many_are_listed_that_a_message_can_hold_them():
    many = nearest("xyz", [f"crate{i:03}" for i in range(256)])
    assert many.startswith("there are: crate000, crate001, ") and many.endswith(", crate009 and 246 more")
    assert len(nearest("xyz", [f"{i}" * TEXT for i in range(10)])) < TEXT
    assert len(nearest("a" * TEXT, ["a" * TEXT])) < TEXT
