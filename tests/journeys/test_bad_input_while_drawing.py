"""Bad input while drawing: one sentence for each, and nothing that was drawn is lost."""

from __future__ import annotations

import json
import resource
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QApplication, QMessageBox

from app.application import build_window
from app.catalogue.catalogue_update import adopt_catalogue
from app.settings.settings import Settings
from processing.core.errors import InUse, MissingInput, NoSpace, OutOfRange, Unsuitable
from processing.core.text import Text
from processing.image.images_of_drives import image_of
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_writing import write_catalogue
from processing.map.change import Change, Replacement
from processing.project.project import Project
from tests.journeys.conftest import WAIT_MS, Surveyor
from widgets.mouse_tools.drawing.draw_line import CROSSES, RESTORED
from widgets.mouse_tools.drawing.drawing_tool import NO_POINT, TOO_FEW

LABEL = Text("Edit", "編集")
_ROOM = 4096


@pytest.fixture
def street(surveyor: Surveyor, tmp_path: Path) -> Surveyor:
    surveyor.open_sample_street(tmp_path / "通り.zuka")
    # What is clicked here are the pixels' own points.
    surveyor.document.shared.snap.choose_modes(frozenset())
    return surveyor


@pytest.fixture
def reported(street: Surveyor) -> list[Text]:
    """All sentences of the status line."""
    sentences: list[Text] = []
    street.parts.toolbox.reported.connect(sentences.append)
    street.document.reported.connect(sentences.append)
    return sentences


def choose(street: Surveyor, geometry: Geometry) -> None:
    kinds = street.document.catalogue().kinds
    street.parts.toolbox.choose_kind(next(kind for kind in kinds if kind.geometry is geometry))


def points_on_road(street: Surveyor, count: int) -> list[int]:
    image = image_of(street.drive, street.document.shared.view_settings.image_kind)
    return [street.shown_point(100 + 12 * number, image.width // 2) for number in range(count)]


def click_all(street: Surveyor, points: list[int]) -> None:
    for point in points:
        street.click(point)


def drawing(street: Surveyor) -> list[int]:
    """The points of what is being drawn."""
    shown = street.document.shared.sketch.drawing
    return [] if shown is None else [one.measured.point for one in shown.vertices]


def drawn_points(street: Surveyor) -> list[list[int]]:
    return [[one.measured.point for one in line.vertices] for line in street.document.features()]


def shown_error(street: Surveyor):
    return street.parts.message_bar.error


def sky(street: Surveyor) -> QPoint:
    """A pixel of the window with no point within reach."""
    view, picture = street.parts.image_view, street.parts.image_view.picture
    for x in range(20, view.width() - 20, 7):
        for y in range(30, view.height() - 20, 7):
            row, column = picture.pixel_at(*view.viewport.to_picture(x, y))
            inside = 0 <= row < picture.image.rows and 0 <= column < picture.image.width
            if inside and picture.image.nearest_filled(row, column, 8) < 0:
                return QPoint(x, y)
    message = "no empty pixel is in the window"
    raise AssertionError(message)


@contextmanager
def full_disk() -> Iterator[None]:
    """No file can be written beyond its first pages while this lasts."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (_ROOM, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_a_click_where_there_is_no_point_says_so_and_adds_nothing(street, reported):
    choose(street, Geometry.LINE)
    points = points_on_road(street, 2)
    click_all(street, points)
    street.parts.image_view.show_everything()
    street.bot.mouseClick(street.parts.image_view, Qt.MouseButton.LeftButton, pos=sky(street))
    assert reported[-1] == NO_POINT
    assert drawing(street) == points


def test_a_line_of_one_vertex_is_not_stored_and_goes_on(street, reported):
    choose(street, Geometry.LINE)
    first, second = points_on_road(street, 2)
    street.click(first)
    street.key(Qt.Key.Key_Return)
    assert reported[-1] == TOO_FEW[Geometry.LINE]
    assert drawing(street) == [first]
    street.click(second)
    street.key(Qt.Key.Key_Return)
    assert drawn_points(street) == [[first, second]]


def test_an_area_that_crosses_itself_says_where_and_is_stored_once_it_does_not(street, reported):
    choose(street, Geometry.AREA)
    image = image_of(street.drive, street.document.shared.view_settings.image_kind)
    middle = image.width // 2
    pixels = ((100, middle), (130, middle), (100, middle + 60), (130, middle + 60))
    a, b, c, d = (street.shown_point(*pixel) for pixel in pixels)
    click_all(street, [a, b, c, d])
    street.key(Qt.Key.Key_Return)
    assert reported[-1].en.startswith(CROSSES.en.split("{", maxsplit=1)[0])
    assert drawing(street) == [a, b, c, d]
    street.key(Qt.Key.Key_Backspace)
    street.key(Qt.Key.Key_Backspace)
    click_all(street, [d, c])
    street.key(Qt.Key.Key_Return)
    assert drawn_points(street) == [[a, b, d, c]]


def test_a_vertex_dragged_while_somebody_else_changed_its_line_leaves_the_change(street):
    choose(street, Geometry.LINE)
    points = points_on_road(street, 3)
    click_all(street, points)
    street.key(Qt.Key.Key_Return)
    (line,) = street.document.features()
    street.parts.toolbox.choose("edit")
    spot, view = street.pixel_of(points[1]), street.parts.image_view
    street.bot.mousePress(view, Qt.MouseButton.LeftButton, pos=spot)
    changed = replace(line, attributes={"height_m": 0.15})
    street.document.apply(LABEL, Change(replaced=(Replacement(line, changed),)))
    street.bot.mouseRelease(view, Qt.MouseButton.LeftButton, pos=spot + QPoint(30, 0))
    assert isinstance(shown_error(street), OutOfRange)
    assert "was changed while you edited it" in street.parts.message_bar.text
    assert list(street.document.features()) == [changed]


def test_what_is_drawn_on_a_line_that_was_changed_meanwhile_becomes_its_own(street):
    choose(street, Geometry.LINE)
    points = points_on_road(street, 5)
    click_all(street, points[:3])
    street.key(Qt.Key.Key_Return)
    (line,) = street.document.features()
    street.document.shared.selection.choose_features(frozenset({line.id}))
    street.parts.window.actions_by_id["continue-line"].trigger()
    click_all(street, points[3:])
    street.document.undo()
    street.key(Qt.Key.Key_Return)
    assert isinstance(shown_error(street), OutOfRange)
    street.key(Qt.Key.Key_Return)
    assert drawn_points(street) == [points[2:]]


def test_drawing_goes_on_while_a_tool_runs_and_both_are_there(street):
    street.bot.waitUntil(lambda: not street.parts.jobs.is_busy, timeout=WAIT_MS)
    choose(street, Geometry.LINE)
    points = points_on_road(street, 3)
    columns = []
    street.document.shared.map_changes.drive_columns_changed.connect(columns.append)
    street.click(points[0])
    tools = street.parts.processing_panel

    def start() -> str:
        tool = tools._tools["normals"]
        job = street.document.start_run(tool.id, street.drive.id, tool.parameters())
        click_all(street, points[1:])
        street.key(Qt.Key.Key_Return)
        return job

    street.wait_for_job(start)
    assert columns == [street.drive.id]
    assert drawn_points(street) == [points]


def test_on_a_full_disk_the_drawing_stays_in_the_hand_until_there_is_room(street):
    choose(street, Geometry.LINE)
    points = points_on_road(street, 8)
    click_all(street, points)
    with full_disk():
        street.key(Qt.Key.Key_Return)
        assert isinstance(shown_error(street), NoSpace)
        assert drawn_points(street) == []
        assert drawing(street) == points
    street.key(Qt.Key.Key_Return)
    assert drawn_points(street) == [points]
    assert shown_error(street) is None


def test_on_a_full_disk_a_continued_line_and_a_moved_vertex_stay_as_they_were(street, reported):
    choose(street, Geometry.LINE)
    points = points_on_road(street, 5)
    click_all(street, points[:3])
    street.key(Qt.Key.Key_Return)
    (line,) = street.document.features()
    street.document.shared.selection.choose_features(frozenset({line.id}))
    street.parts.window.actions_by_id["continue-line"].trigger()
    click_all(street, points[3:])
    with full_disk():
        # Another tool is taken: what was drawn would be kept, if there were room.
        street.parts.toolbox.choose("edit")
        assert isinstance(shown_error(street), NoSpace)
        spot = street.pixel_of(points[1])
        street.bot.mousePress(street.parts.image_view, Qt.MouseButton.LeftButton, pos=spot)
        end = spot + QPoint(30, 0)
        street.bot.mouseRelease(street.parts.image_view, Qt.MouseButton.LeftButton, pos=end)
        assert list(street.document.features()) == [line]
    assert street.document.shared.sketch.drawing is None
    street.parts.toolbox.choose("line")
    street.key(Qt.Key.Key_Backspace)
    assert reported[-1] == RESTORED
    street.key(Qt.Key.Key_Return)
    assert drawn_points(street) == [points]


def test_a_project_closed_in_the_middle_of_a_line_keeps_it_and_forgets_the_hand(street, tmp_path):
    choose(street, Geometry.LINE)
    points = points_on_road(street, 3)
    click_all(street, points)
    street.parts.window.actions_by_id["plane-level"].trigger()
    folder = street.document.project.folder
    assert street.document.create(tmp_path / "other.zuka", "EPSG:6677")
    assert street.document.shared.snap.plane is None
    street.key(Qt.Key.Key_Backspace)
    street.key(Qt.Key.Key_Return)
    assert list(street.document.features()) == []
    assert street.document.open(folder)
    assert drawn_points(street) == [points]


def test_a_second_window_on_the_project_is_told_who_has_it(street, tmp_path):
    folder = street.document.project.folder
    other = build_window(Settings(tmp_path / "other.ini"), tmp_path)
    try:
        other.window.show()
        assert not other.document.open(folder)
        assert isinstance(other.message_bar.error, InUse)
        assert "open in another window" in other.message_bar.text
        assert other.document.project is None
    finally:
        other.window.close()
        other.window.deleteLater()
    choose(street, Geometry.LINE)
    points = points_on_road(street, 2)
    click_all(street, points)
    street.key(Qt.Key.Key_Return)
    with closing(Project.open(folder, writing=False)) as project:
        assert len(project.features) == 1


@pytest.mark.parametrize("is_kept", [True, False])
def test_a_catalogue_without_a_kind_that_is_drawn_is_taken_only_with_that_kind(
    street, tmp_path, is_kept
):
    choose(street, Geometry.LINE)
    click_all(street, points_on_road(street, 2))
    street.key(Qt.Key.Key_Return)
    (line,) = street.document.features()
    kinds = street.document.catalogue().kinds
    write_catalogue(
        tmp_path / "office.toml", Catalogue(tuple(k for k in kinds if k.id != line.kind)[:20])
    )
    adopt_catalogue(street.parts, tmp_path / "office.toml")
    (box,) = street.parts.window.findChildren(QMessageBox)
    assert "Keep them" in box.text()
    role = QMessageBox.ButtonRole.AcceptRole if is_kept else QMessageBox.ButtonRole.RejectRole
    button = next(one for one in box.buttons() if box.buttonRole(one) is role)
    street.bot.mouseClick(button, Qt.MouseButton.LeftButton)
    assert list(street.document.features()) == [line]
    assert line.kind in street.document.catalogue()
    assert len(street.document.catalogue()) == (21 if is_kept else len(kinds))


def test_a_catalogue_that_gives_a_drawn_kind_another_shape_is_refused(street, tmp_path):
    choose(street, Geometry.LINE)
    click_all(street, points_on_road(street, 2))
    street.key(Qt.Key.Key_Return)
    (line,) = street.document.features()
    kinds = street.document.catalogue().kinds
    other = tuple(replace(k, geometry=Geometry.AREA) if k.id == line.kind else k for k in kinds)
    write_catalogue(tmp_path / "office.toml", Catalogue(other))
    adopt_catalogue(street.parts, tmp_path / "office.toml")
    assert isinstance(shown_error(street), Unsuitable)
    assert street.document.catalogue().kinds == kinds
    assert list(street.document.features()) == [line]


def test_features_of_another_plane_system_are_pasted_where_they_are_on_the_ground(
    street, reported, tmp_path
):
    assert street.document.crs() == "EPSG:6677"
    choose(street, Geometry.LINE)
    click_all(street, points_on_road(street, 3))
    street.key(Qt.Key.Key_Return)
    (line,) = street.document.features()
    actions = street.parts.window.actions_by_id
    street.document.shared.selection.choose_features(frozenset({line.id}))
    actions["copy"].trigger()
    folder = street.document.project.folder
    assert street.document.create(tmp_path / "other.zuka", "EPSG:6676")
    actions["paste"].trigger()
    (pasted,) = street.document.features()
    moved = np.array([a.xyz for a in pasted.vertices]) - [a.xyz for a in line.vertices]
    assert np.hypot(moved[:, 0], moved[:, 1]).min() > 1000.0
    assert any("6676" in sentence.en or "6677" in sentence.en for sentence in reported)
    street.document.shared.selection.choose_features(frozenset({pasted.id}))
    actions["copy"].trigger()
    assert street.document.open(folder)
    actions["paste"].trigger()
    back = next(one for one in street.document.features() if one.id != line.id)
    off = np.array([a.xyz for a in back.vertices]) - [a.xyz for a in line.vertices]
    assert np.abs(off).max() < 0.001


def test_features_of_an_unknown_system_are_refused_and_stay_on_the_clipboard(street):
    unknown = {
        "type": "FeatureCollection",
        "crs": None,
        "features": [
            {
                "type": "Feature",
                "properties": {},
                "geometry": {"type": "LineString", "coordinates": [[-100.0, 2e4, 1], [0, 1e4, 1]]},
            }
        ],
    }
    QApplication.clipboard().setText(json.dumps(unknown))
    street.parts.window.actions_by_id["paste"].trigger()
    assert isinstance(shown_error(street), MissingInput)
    assert "reference system" in street.parts.message_bar.text
    assert list(street.document.features()) == []
    assert json.loads(QApplication.clipboard().text()) == unknown
