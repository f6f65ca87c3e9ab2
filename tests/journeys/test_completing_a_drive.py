"""A street comes in without its trajectory, gets it, and a drive is taken out again."""

from __future__ import annotations

import shutil
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QCheckBox, QDialogButtonBox, QMenu, QToolButton, QTreeWidget

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.labels.label_column import labels_of
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, PointReference, Vertex
from processing.map.label_change import label_changes
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.project.project import Project
from processing.recording.kinds import ImageKind
from processing.tools.running.runner import tool_of
from resources import path_of
from tests.journeys.conftest import WAIT_MS
from tests.processing.project.cells import order_by_cells
from widgets.dialogs.import_drive import ImportForm
from widgets.panels.project.project_drives import DRIVE

LABEL = Text.same("x")


@pytest.fixture
def delivery(tmp_path) -> Path:
    """A folder with the points of one head; the trajectory lies beside it."""
    folder = tmp_path / "納品"
    folder.mkdir()
    for name in ("left.laz", "trajectory.csv", "images.csv"):
        shutil.copy(path_of(f"sample_street/{name}"), folder)
    return folder


def _import(surveyor, *files: Path) -> None:
    document = surveyor.document
    if document.project is None:
        assert document.create(files[0].parent.parent / "通り.zuka", "")
    with surveyor.bot.waitSignal(document.drive_results.taken, timeout=WAIT_MS):
        surveyor.parts.window.files_dropped.emit(files)


def _button(parts, words: str) -> QToolButton:
    buttons = parts.message_bar.findChildren(QToolButton)
    return next(one for one in buttons if one.isVisible() and one.text() == words)


def _tree(parts) -> QTreeWidget:
    return parts.project_tree.findChild(QTreeWidget)


def _drive_item(parts, id_: str):
    drives = _tree(parts).topLevelItem(0)
    items = [drives.child(number) for number in range(drives.childCount())]
    return next((item for item in items if item.data(0, DRIVE) == id_), None)


def _menu_of(surveyor, id_: str) -> QMenu:
    tree = _tree(surveyor.parts)
    spot = tree.visualItemRect(_drive_item(surveyor.parts, id_)).center()
    tree.customContextMenuRequested.emit(QPoint(spot))
    menu = next(one for one in tree.findChildren(QMenu) if one.isVisible())
    assert isinstance(menu, QMenu)
    return menu


def test_without_a_trajectory_the_one_beside_is_offered_and_added_by_one_click(surveyor, delivery):
    document, parts = surveyor.document, surveyor.parts
    curbs = parts.window.actions_by_id["run-curbs"]
    _import(surveyor, delivery / "left.laz")
    assert "without a trajectory" in parts.message_bar.text
    assert "trajectory.csv" in parts.message_bar.text
    assert not curbs.isEnabled()
    with surveyor.bot.waitSignal(document.drive_results.taken, timeout=WAIT_MS):
        _button(parts, "Add trajectory.csv").click()
    assert parts.message_bar.text == ""
    (drive,) = document.drives()
    assert drive.info.rows_by == "trajectory"
    assert parts.image_view.picture.drive is drive
    assert curbs.isEnabled()


def test_a_trajectory_that_is_dropped_completes_the_drive_and_the_map_stays(surveyor, delivery):
    document = surveyor.document
    _import(surveyor, delivery / "left.laz")
    drive = surveyor.drive
    position = surveyor.position_of(1000)
    on_point = Vertex(position.xyz, PointReference(drive.id, 1000))
    vertices = (on_point, Vertex((0.0, 0.0, 0.0)))
    line = Feature("line", "curb", Geometry.LINE, vertices)
    labels = label_changes(drive.id, np.arange(200), np.zeros(200, np.uint8), 5)
    assert document.apply(LABEL, Change(added=(line,), labels=labels))
    _import(surveyor, delivery / "trajectory.csv")
    assert [one.id for one in document.drives()] == [drive.id]
    assert surveyor.drive is not drive
    assert surveyor.drive.trajectory is not None
    rests = document.feature("line").vertices[0].measured
    assert isinstance(rests, PointReference)
    assert surveyor.position_of(rests.point).xyz == position.xyz
    assert (labels_of(surveyor.drive, np.arange(400)) == 5).sum() == 200
    assert document.undo()
    assert surveyor.drive.trajectory is None
    assert document.feature("line") == line
    assert (labels_of(surveyor.drive, np.arange(400)) == 5).sum() == 200
    assert document.undo()
    assert document.feature("line") is None
    assert (labels_of(surveyor.drive, np.arange(400)) == 5).sum() == 0


def test_a_drive_that_was_shown_from_above_gets_rows_and_the_map_stays_on_its_points(
    surveyor, delivery
):
    document = surveyor.document
    with closing(Project.create(delivery.parent / "通り.zuka", "")) as project:
        request = ImportRequest((delivery / "left.laz",))
        folders = import_drives(request, project.temporary_folder(), SilentMonitor())
        order_by_cells(folders[0])
        project.adopt_drives(folders)
    assert document.open(project.folder)
    settings = document.shared.view_settings
    assert settings.image_kind is ImageKind.TOP_VIEW
    positions = [surveyor.position_of(point).xyz for point in (5, 70_000)]
    rests = [PointReference(surveyor.drive.id, point) for point in (5, 70_000)]
    vertices = tuple(Vertex(*one) for one in zip(positions, rests, strict=True))
    assert document.apply(LABEL, Change(added=(Feature("line", "curb", Geometry.LINE, vertices),)))
    _import(surveyor, delivery / "trajectory.csv")
    assert settings.image_kind in surveyor.drive.image_kinds
    assert surveyor.drive.revolutions is not None
    now = [vertex.measured for vertex in document.feature("line").vertices]
    assert now != rests
    assert [surveyor.position_of(one.point).xyz for one in now if one is not None] == positions
    moved = document.feature("line")
    assert document.apply(LABEL, Change(removed=(moved,)))
    assert document.undo()
    assert document.undo()
    assert settings.image_kind is ImageKind.TOP_VIEW
    assert [vertex.measured for vertex in document.feature("line").vertices] == rests
    assert [surveyor.position_of(one.point).xyz for one in rests] == positions
    assert document.redo()
    assert settings.image_kind in surveyor.drive.image_kinds
    assert document.feature("line") == moved


def test_what_a_tool_finds_on_a_drive_that_was_removed_meanwhile_is_dropped(surveyor, delivery):
    document, bot = surveyor.document, surveyor.bot
    _import(surveyor, delivery / "left.laz", delivery / "trajectory.csv")
    parameters = tool_of("noise").parameters()
    with bot.waitSignal(document.refused, timeout=WAIT_MS) as refused:
        document.start_run("noise", surveyor.drive.id, parameters)
        assert document.remove_drives((surveyor.drive.id,))
    assert refused.args[0].what.en == "The drive was changed or removed meanwhile."
    assert document.runs() == ()
    assert document.undo()
    assert labels_of(surveyor.drive, np.arange(surveyor.drive.count)).max() == 0
    assert not any((document.project.folder / "label_steps").glob("*"))


def test_a_file_that_is_there_already_makes_no_second_drive_and_is_told(surveyor, delivery):
    document = surveyor.document
    _import(surveyor, delivery / "left.laz", delivery / "trajectory.csv")
    reported = []
    document.reported.connect(lambda text: reported.append(text.en))
    _import(surveyor, delivery / "left.laz")
    assert len(document.drives()) == 1
    assert reported == ["In the project already, so not imported again: left.laz"]


def test_images_come_later_too(surveyor, delivery):
    document = surveyor.document
    _import(surveyor, delivery / "left.laz", delivery / "trajectory.csv")
    _import(surveyor, delivery / "images.csv")
    (drive,) = document.drives()
    assert drive.images is not None
    count = len(drive.images)
    _import(surveyor, delivery / "images.csv")
    assert len(document.drives()[0].images) == count
    assert document.undo()
    assert document.drives()[0].images is None
    assert document.redo()
    assert len(document.drives()[0].images) == count


def test_the_menu_of_a_drive_removes_it_and_undo_brings_it_back(surveyor, delivery):
    document, parts = surveyor.document, surveyor.parts
    _import(surveyor, delivery / "left.laz", delivery / "trajectory.csv")
    shutil.copy(path_of("sample_street/right.laz"), delivery)
    _import(surveyor, delivery / "right.laz", delivery / "trajectory.csv")
    left, right = (drive.id for drive in document.drives())
    assert document.shared.view_settings.drive_id == left
    menu = _menu_of(surveyor, left)
    words = [action.text() for action in menu.actions()]
    assert "Replace the trajectory…" in words
    assert "Add camera images…" in words
    menu.actions()[words.index("Remove from the project")].trigger()
    menu.close()
    assert [drive.id for drive in document.drives()] == [right]
    assert _drive_item(parts, left) is None
    assert document.shared.view_settings.drive_id == right
    assert document.undo()
    assert [drive.id for drive in document.drives()] == [left, right]
    assert _drive_item(parts, left) is not None
    assert document.redo()
    assert document.undo()


def test_the_delete_key_removes_the_last_drive_and_undo_shows_it_again(surveyor, delivery):
    document, parts = surveyor.document, surveyor.parts
    _import(surveyor, delivery / "left.laz", delivery / "trajectory.csv")
    (drive,) = document.drives()
    tree = _tree(parts)
    tree.setFocus()
    tree.setCurrentItem(_drive_item(parts, drive.id))
    surveyor.bot.keyClick(tree, Qt.Key.Key_Delete)
    assert document.drives() == ()
    assert document.shared.view_settings.drive_id == ""
    assert not parts.window.actions_by_id["run-curbs"].isEnabled()
    assert document.undo()
    assert document.shared.view_settings.drive_id == drive.id
    assert parts.image_view.picture is not None
    folder = document.project.folder
    document.close()
    assert document.open(folder)
    assert [one.id for one in document.drives()] == [drive.id]


def test_the_import_form_offers_the_trajectory_beside_the_points(surveyor, delivery):
    parts = surveyor.parts
    parts.window.actions_by_id["import"].trigger()
    form = next(one for one in parts.window.findChildren(ImportForm) if one.isVisible())
    box = next(one for one in form.findChildren(QCheckBox) if "labels" not in one.text())
    assert not box.isVisible()
    form.add_files((delivery / "left.laz",))
    surveyor.bot.waitUntil(box.isVisible, timeout=WAIT_MS)
    assert box.isChecked()
    assert "trajectory.csv" in box.text()
    requests = []
    form.import_requested.connect(requests.append)
    buttons = form.findChild(QDialogButtonBox)
    with surveyor.bot.waitSignal(surveyor.document.drive_results.taken, timeout=WAIT_MS):
        buttons.accepted.emit()
    names = ("left.laz", "trajectory.csv", "images.csv")
    assert requests[0].files == tuple(delivery / name for name in names)
    assert surveyor.drive.trajectory is not None
