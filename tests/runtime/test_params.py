"""Files from people: what is wrong, where, and how to mend it, in one line."""

from typing import Annotated

import msgspec
import pytest

from uvf.runtime.params import BadInput, load_yaml, nearest

Positive = Annotated[float, msgspec.Meta(gt=0)]


class Part(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    size: tuple[Positive, Positive] = (1.0, 1.0)
    weight: Positive | None = None


class Whole(msgspec.Struct, forbid_unknown_fields=True):
    name: str = ""
    part: Part = Part()
    parts: list[Part] = []
    named: dict[str, Part] = {}


def load(tmp_path, text):
    path = tmp_path / "f.yaml"
    path.write_text(text)
    return load_yaml(path, Whole)


BAD = {
    "part: {wieght: 1}": "part: unknown key 'wieght'; did you mean 'weight'?",
    "parts: [{}, {sise: 1}]": "parts[1]: unknown key 'sise'; did you mean 'size'?",
    "named: {a: {x: 1}}": "named: a: unknown key 'x'; there are: size, weight",
    "part: {weight: -1}": "Expected `float` > 0.0 - at `$.part.weight`",
    "part: {weight: .nan}": "part: weight: nan is no number to work with",
    "part: {size: [1, .inf]}": "inf is no number to work with",
    "name: a\nname: b": "f.yaml:1: not valid YAML: key 'name' is given twice",
    "name: [": "f.yaml:1: not valid YAML",
    "[" * 3000: "nested too deeply",
}


@pytest.mark.parametrize("text", BAD, ids=range(len(BAD)))
def test_what_is_wrong_is_one_line_that_names_the_place(tmp_path, text):
    with pytest.raises(BadInput) as caught:
        load(tmp_path, text)
    assert BAD[text] in str(caught.value)
    assert str(tmp_path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_numbers_with_exponents_are_numbers(tmp_path):
    assert load(tmp_path, "part: {weight: 2.6e6, size: [1e3, 1.5E-2]}").part == Part((1e3, 1.5e-2), 2.6e6)


def test_the_nearest_name_is_offered_or_all_there_are():
    assert nearest("burgr", ["burger", "milvus"]) == "did you mean 'burger'?"
    assert nearest("xyz", ["burger", "milvus"]) == "there are: burger, milvus"
