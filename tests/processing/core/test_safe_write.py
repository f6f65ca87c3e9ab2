"""A file is written whole or not at all."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from processing.core.errors import Cancelled, InUse, UserError
from processing.core.safe_write import write_safely


def test_the_result_appears_only_when_it_is_whole(tmp_path: Path) -> None:
    path = tmp_path / "新しい" / "結果.csv"
    with write_safely(path) as temporary:
        temporary.write_text("half")
        assert not path.exists()
        assert temporary.parent.parent == path.parent  # so that it is on the same disk
        assert temporary.suffix == ".csv"
    assert path.read_text() == "half"
    assert list(path.parent.iterdir()) == [path]


@pytest.mark.parametrize("error", [ValueError, Cancelled, KeyboardInterrupt, SystemExit])
def test_after_any_error_the_old_file_is_there_and_no_other(
    tmp_path: Path, error: type[BaseException]
) -> None:
    path = tmp_path / "a.csv"
    path.write_text("old")

    def write() -> None:
        with write_safely(path) as temporary:
            temporary.write_text("half")
            raise error

    with pytest.raises(error):
        write()
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


_WRITES_HALF = """
import sys
from pathlib import Path
from processing.core.safe_write import write_safely
with write_safely(Path(sys.argv[1])) as temporary:
    temporary.write_text("half")
    print(temporary, flush=True)
    sys.stdin.read()
"""


def write_half(path: Path) -> subprocess.Popen[str]:
    """A process in the middle of writing a file."""
    process = subprocess.Popen(
        [sys.executable, "-c", _WRITES_HALF, str(path)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert Path(process.stdout.readline().strip()).read_text() == "half"
    return process


def test_what_a_killed_process_left_goes_with_the_next_file(tmp_path: Path) -> None:
    process = write_half(tmp_path / "a.csv")
    with write_safely(tmp_path / "b.csv") as temporary:
        temporary.write_text("whole")
    assert len(list(tmp_path.iterdir())) == 2  # the other one is still being written
    process.kill()
    process.communicate()
    assert len(list(tmp_path.iterdir())) == 2
    with write_safely(tmp_path / "c.csv") as temporary:
        temporary.write_text("whole")
    assert sorted(one.name for one in tmp_path.iterdir()) == ["b.csv", "c.csv"]


def test_what_others_made_under_such_a_name_stays(tmp_path: Path) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "lock").write_text("somebody's")
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / ".zuka-writing-1").mkdir()
    (folder / ".zuka-writing-1" / "note.txt").write_text("no lock here")
    (folder / ".zuka-writing-2").symlink_to(outside, target_is_directory=True)
    (folder / ".zuka-writing-3").mkdir()
    (folder / ".zuka-writing-3" / "lock").symlink_to(outside / "lock")
    with write_safely(folder / "c.csv") as temporary:
        temporary.write_text("whole")
    assert (folder / ".zuka-writing-1" / "note.txt").read_text() == "no lock here"
    assert (folder / ".zuka-writing-3" / "lock").is_symlink()
    assert (outside / "lock").read_text() == "somebody's"
    assert len(list(folder.iterdir())) == 4
