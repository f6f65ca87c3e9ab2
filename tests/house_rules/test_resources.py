"""Bundled files are found through one door."""

from __future__ import annotations

import pytest

from resources import UnknownResource, path_of


def test_a_bundled_file_is_given_as_a_path() -> None:
    assert path_of("sample_street/left.laz").read_bytes()[:4] == b"LASF"
    assert path_of("sample_street").is_dir()


@pytest.mark.parametrize("name", ["", "sample_street/none.laz", "../pyproject.toml", "/etc"])
def test_a_name_that_no_bundled_file_has_is_a_clear_defect(name: str) -> None:
    with pytest.raises(UnknownResource, match="resources has no"):
        path_of(name)
