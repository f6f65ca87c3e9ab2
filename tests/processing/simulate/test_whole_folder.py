"""A folder that is whole or not there."""

from __future__ import annotations

from pathlib import Path

import pytest

from processing.errors import Cancelled, InUse
from processing.simulate.whole_folder import made_whole


def test_it_takes_its_name_when_it_is_whole(tmp_path: Path) -> None:
    folder = tmp_path / "道路" / "one"
    with made_whole(folder) as hidden:
        (hidden / "file").write_text("x")
        assert not folder.exists()
    assert (folder / "file").read_text() == "x"
    assert [one.name for one in folder.parent.iterdir()] == ["one"]


def test_nothing_is_left_of_what_was_stopped(tmp_path: Path) -> None:
    def stopped() -> None:
        with made_whole(tmp_path / "one") as hidden:
            (hidden / "file").write_text("x")
            raise Cancelled

    with pytest.raises(Cancelled):
        stopped()
    assert not list(tmp_path.iterdir())


def test_a_folder_with_something_in_it_is_refused(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("x")
    with pytest.raises(InUse), made_whole(tmp_path):
        pass
    assert (tmp_path / "mine").read_text() == "x"


def test_an_empty_folder_is_taken(tmp_path: Path) -> None:
    (tmp_path / "one").mkdir()
    with made_whole(tmp_path / "one") as hidden:
        (hidden / "file").write_text("x")
    assert (tmp_path / "one" / "file").exists()
