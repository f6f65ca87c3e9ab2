"""A folder that is whole or not there."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from processing.core.errors import Cancelled, InUse
from processing.core.owned_files import MARK
from processing.core.whole_folder import write_whole_folder

ROOT = Path(__file__).parents[4]


def test_it_takes_its_name_when_it_is_whole(tmp_path: Path) -> None:
    folder = tmp_path / "道路" / "one"
    with write_whole_folder(folder) as hidden:
        (hidden / "file").write_text("x")
        assert not folder.exists()
    assert (folder / "file").read_text() == "x"
    assert [one.name for one in folder.parent.iterdir()] == ["one"]


def test_nothing_is_left_of_what_was_stopped(tmp_path: Path) -> None:
    def stopped() -> None:
        with write_whole_folder(tmp_path / "one") as hidden:
            (hidden / "file").write_text("x")
            raise Cancelled

    with pytest.raises(Cancelled):
        stopped()
    assert not list(tmp_path.iterdir())


def test_a_folder_with_something_in_it_is_refused(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("x")
    with pytest.raises(InUse), write_whole_folder(tmp_path):
        pass
    assert (tmp_path / "mine").read_text() == "x"


def test_an_empty_folder_is_taken(tmp_path: Path) -> None:
    (tmp_path / "one").mkdir()
    with write_whole_folder(tmp_path / "one") as hidden:
        (hidden / "file").write_text("x")
    assert (tmp_path / "one" / "file").exists()


def test_what_a_killed_program_left_is_removed_by_the_next_one(tmp_path: Path) -> None:
    script = (
        "import os, signal, sys\n"
        "from pathlib import Path\n"
        "from processing.core.whole_folder import write_whole_folder\n"
        "with write_whole_folder(Path(sys.argv[1])) as hidden:\n"
        "    (hidden / 'half').write_text('x')\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    folder = tmp_path / "通り"
    killed = subprocess.run([sys.executable, "-c", script, str(folder)], cwd=ROOT, check=False)
    assert killed.returncode == -signal.SIGKILL
    assert len(list(tmp_path.iterdir())) == 2  # what it had written, and its lock
    with write_whole_folder(folder) as hidden:
        assert [one.name for one in hidden.iterdir()] == [MARK]
    assert [one.name for one in tmp_path.iterdir()] == ["通り"]


def test_a_folder_that_is_being_made_is_refused_and_made_all_the_same(tmp_path: Path) -> None:
    with write_whole_folder(tmp_path / "one") as hidden:
        (hidden / "file").write_text("x")
        with pytest.raises(InUse, match="Another program"), write_whole_folder(tmp_path / "one"):
            pass
        with write_whole_folder(tmp_path / "other"):
            pass
    assert (tmp_path / "one" / "file").read_text() == "x"
    assert sorted(one.name for one in tmp_path.iterdir()) == ["one", "other"]


@pytest.mark.parametrize("name", ["字" * 85, "x" * 255, ".hidden", "a b's $c"])
def test_any_name_that_a_disk_takes_will_do(tmp_path: Path, name: str) -> None:
    with write_whole_folder(tmp_path / name):
        pass
    assert [one.name for one in tmp_path.iterdir()] == [name]


def test_the_folder_a_user_is_in_and_links_to_empty_ones_are_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to("real")
    with write_whole_folder(tmp_path / "link") as hidden:
        (hidden / "file").write_text("x")
    assert (tmp_path / "real" / "file").exists()
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    with write_whole_folder(Path()) as hidden:
        (hidden / "file").write_text("x")
    assert (tmp_path / "here" / "file").exists()


def test_a_disk_itself_is_refused_before_anything_is_made() -> None:
    with pytest.raises(InUse), write_whole_folder(Path("/")):
        pass
