"""Every kind of point file comes in by every door, and unclear columns are asked about."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtWidgets import QComboBox, QDialogButtonBox, QFileDialog

from app.cli.opened import request_of
from app.cli.parser import read_arguments
from processing.core.errors import MissingInput
from processing.formats.format import DELIVERED, Content
from processing.formats.registry import FORMATS
from processing.project.importing.dropped_files import request_of_files
from widgets.dialogs.import_drive import ImportForm
from widgets.dialogs.point_columns import ColumnsForm

ENDINGS = FORMATS.endings_read(Content.POINTS)


def _delivered(folder: Path, ending: str) -> Path:
    """A folder with a file that is named so; every reader looks at the content."""
    folder.mkdir()
    path = folder / f"scan{ending}"
    path.write_text("1 2 3\n4 5 6\n")
    return path


@pytest.mark.parametrize("ending", [*ENDINGS, *(ending.upper() for ending in ENDINGS)])
def test_a_point_file_is_taken_dropped_and_in_a_folder(tmp_path: Path, ending: str) -> None:
    path = _delivered(tmp_path / "delivery", ending)
    assert request_of_files((path,), "").inputs == (path,)
    assert request_of_files((path.parent,), "").inputs == (path,)


@pytest.mark.parametrize("ending", ENDINGS)
def test_the_import_form_lists_a_point_file(
    qtbot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ending: str
) -> None:
    filters: list[str] = []

    def choose(_parent, _title, _folder, kinds):
        filters.append(kinds)
        return [], ""

    monkeypatch.setattr(QFileDialog, "getOpenFileNames", choose)
    form = ImportForm(tmp_path / "a.zuka", kinds=FORMATS.filter_read(*DELIVERED).en)
    qtbot.addWidget(form)
    form.ask_for_files()
    assert f"*{ending} " in filters[0].replace(")", " ")


@pytest.mark.parametrize("ending", ENDINGS)
def test_the_command_line_reads_a_point_file(tmp_path: Path, capsys, ending: str) -> None:
    path = _delivered(tmp_path / "delivery", ending)
    command, arguments = read_arguments(["info", str(path)])
    assert command(arguments) == 0
    assert "points: 2" in capsys.readouterr().out


def test_a_table_of_points_with_times_is_no_trajectory(tmp_path: Path) -> None:
    path = tmp_path / "points.csv"
    path.write_text("x,y,z,GpsTime\n1,2,3,4\n")
    assert request_of_files((path,), "").inputs == (path,)


def test_columns_are_named_on_the_command_line(tmp_path: Path, capsys) -> None:
    path = tmp_path / "a.txt"
    path.write_text("# x y z\n10 20 30 40\n11 21 31 41\n")
    words = ["--columns", "-, y,x,z"]
    command, arguments = read_arguments(["info", str(path), *words])
    command(arguments)
    reported = capsys.readouterr().out
    assert "lowest: 30.000, 20.000, 40.000" in reported
    _, arguments = read_arguments(["import", "p.zuka", str(path), *words])
    assert request_of(arguments).columns == ("-", "y", "x", "z")


def test_a_drop_with_an_unclear_header_is_asked_about_and_read_as_answered(
    qtbot, tmp_path: Path, parts
) -> None:
    path = tmp_path / "points.txt"
    values = np.random.default_rng(5).uniform(0, 50, (500, 4))
    np.savetxt(path, values, header="x y z", fmt="%.3f")
    parts.window.files_dropped.emit((path,))
    form = parts.window.findChild(ColumnsForm)
    assert parts.document.project is None
    boxes, buttons = form.findChildren(QComboBox), form.findChild(QDialogButtonBox)
    role = QDialogButtonBox.ButtonRole.AcceptRole
    (accept,) = (one for one in buttons.buttons() if buttons.buttonRole(one) is role)
    assert not accept.isEnabled()
    for box, column in zip(boxes, ("z", "-", "y", "x"), strict=True):
        box.setCurrentIndex(box.findData(column))
    assert accept.isEnabled()
    with qtbot.waitSignal(parts.document.reported, timeout=60_000) as reported:
        accept.click()
    assert "points.txt: columns taken as z - y x" in reported.args[0].en
    (drive,) = parts.document.drives()
    found = np.round(drive.xyz(np.arange(drive.count)), 3)
    expected = np.round(values[:, [3, 2, 0]], 3)
    for rows in (found, expected):
        rows[:] = rows[np.lexsort(rows.T)]  # heights of several points are the same
    np.testing.assert_allclose(found, expected, atol=1e-3)


def test_a_folder_without_points_says_what_to_choose(tmp_path: Path) -> None:
    (tmp_path / "notes.md").write_text("nothing")
    with pytest.raises(MissingInput, match="PTX"):
        request_of_files((tmp_path,), "")
