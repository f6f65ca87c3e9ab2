"""Pictures of the program in use are made by a command."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtGui import QImage

from app.drawing.tool_entries import TOOL_ENTRIES
from app.screenshots.__main__ import NOTHING_OPEN, ON_STREET, main


def test_a_picture_shows_the_whole_window_in_the_language_asked_for(tmp_path: Path) -> None:
    out = tmp_path / "pictures"
    wanted = ["--language", "ja", "--size", "1000x700", "--only", "start-empty"]
    assert main([str(out), *wanted]) == 0
    (path,) = out.iterdir()
    assert path.name == "start-empty-ja.png"
    picture = QImage(str(path))
    assert (picture.width(), picture.height()) == (1000, 700)
    colours = {picture.pixel(x, y) for x in range(0, 1000, 5) for y in range(0, 700, 5)}
    assert len(colours) > 10


@pytest.mark.parametrize("wrong", [["--size", "large"], ["--only", "nothing"], ["--theme", "pink"]])
def test_what_can_not_be_made_is_refused(
    wrong: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as refusal:
        main([str(tmp_path / "pictures"), *wrong])
    assert refusal.value.code == 2
    assert wrong[1] in capsys.readouterr().err


def test_every_tool_has_a_picture() -> None:
    names = {**ON_STREET, **NOTHING_OPEN}
    shown = {*names, *(name.partition("-")[2] for name in names)}
    other_names = {
        "select": "box",
        "edit": "vertices",
        "measure": "line",
        "measure-area": "area",
    }
    missing = [
        entry.name for entry in TOOL_ENTRIES if other_names.get(entry.name, entry.name) not in shown
    ]
    assert missing == []
