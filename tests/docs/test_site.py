"""``uvf docs --build`` keeps its hands off what is no site."""

import pytest

from launch.commands.docs import build_docs
from uvf.models.yaml_data import BadInput


def test_a_folder_that_holds_something_else_is_not_built_into(tmp_path):
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(BadInput, match="empty folder"):
        build_docs(tmp_path)
    assert (tmp_path / "thesis.tex").exists()


def test_a_file_is_not_built_into(tmp_path):
    (tmp_path / "site").write_text("")
    with pytest.raises(BadInput, match="is a file"):
        build_docs(tmp_path / "site")
