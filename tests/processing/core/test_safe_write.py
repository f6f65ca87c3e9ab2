"""A file is written whole or not at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from processing.core.errors import Cancelled, InUse, UserError
from processing.core.safe_write import write_safely


def test_the_result_appears_only_when_it_is_whole(tmp_path: Path) -> None:
    path = tmp_path / "新しい" / "結果.csv"
    with write_safely(path) as temporary:
        temporary.write_text("half")
        assert not path.exists()
        assert temporary.parent == path.parent
        assert temporary.suffix == ".csv"
    assert path.read_text() == "half"
    assert list(path.parent.iterdir()) == [path]


@pytest.mark.parametrize("error", [ValueError, Cancelled, KeyboardInterrupt, SystemExit])
def test_after_any_error_the_old_file_is_there_and_no_other(
    tmp_path: Path, error: type[BaseException]
) -> None:
    path = tmp_path / "a.csv"
    path.write_text("old")

    def write_half() -> None:
        with write_safely(path) as temporary:
            temporary.write_text("half")
            raise error

    with pytest.raises(error):
        write_half()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_an_input_is_not_overwritten_by_whatever_name(tmp_path: Path) -> None:
    source, link = tmp_path / "a.las", tmp_path / "b.las"
    source.write_text("points")
    link.hardlink_to(source)
    for path in (source, tmp_path / "sub" / ".." / "a.las", link):
        with pytest.raises(InUse) as refusal, write_safely(path, never=[source]):
            pytest.fail("the body was entered")
        assert refusal.value.remedy.ja
    assert source.read_text() == "points"


def test_a_folder_that_is_a_file_is_told_in_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "folder").write_text("")
    with (
        pytest.raises(UserError, match="folder can't be made"),
        write_safely(tmp_path / "folder" / "a.csv") as temporary,
    ):
        temporary.write_text("x")
