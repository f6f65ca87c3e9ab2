"""The main job in the window: import, click, take back, export; judged by what is exported."""

import csv
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from PySide6.QtCore import Qt

from processing.image.images_of_drives import image_of
from processing.map.catalogue import Geometry
from processing.operations.export import ExportRequest


@pytest.fixture
def street(surveyor, tmp_path):
    surveyor.open_sample_street(tmp_path / "通り.zuka")
    # What is clicked here are the pixels' own points.
    surveyor.document.shared.snap.choose_modes(frozenset())
    return surveyor


def _kind(surveyor, geometry):
    return next(k for k in surveyor.document.catalogue().kinds if k.geometry is geometry)


def _points_down_the_road(surveyor, count):
    image = image_of(surveyor.drive, surveyor.document.shared.view_settings.image_kind)
    return [surveyor.shown_point(100 + 12 * n, image.width // 2) for n in range(count)]


def _draw_line(surveyor, points):
    surveyor.parts.toolbox.choose_kind(_kind(surveyor, Geometry.LINE))
    for point in points:
        surveyor.click(point)
    surveyor.key(Qt.Key.Key_Return)


def _export(surveyor, folder, version="R2018", encoding="utf-8"):
    request = ExportRequest(
        formats=("dxf", "csv"),
        folder=folder,
        language="ja",
        options={"dxf_version": version, "encoding": encoding},
        candidates=False,
    )
    surveyor.wait_for_job(lambda: surveyor.document.export(request))


def _dxf_vertices(folder: Path):
    (path,) = folder.glob("*.dxf")
    polylines = ezdxf.readfile(path).modelspace().query("POLYLINE")
    return [[tuple(v.dxf.location) for v in line.vertices] for line in polylines]


@pytest.mark.parametrize(("version", "encoding"), [("R2018", "utf-8"), ("R2000", "cp932")])
def test_clicked_pixels_are_the_measured_coordinates_in_dxf_and_csv(
    street, tmp_path, version, encoding
):
    points = _points_down_the_road(street, 4)
    _draw_line(street, points)
    _export(street, tmp_path / "out", version, encoding)
    expected = street.drive.xyz(np.array(points))
    (drawn,) = _dxf_vertices(tmp_path / "out")
    assert np.abs(np.array(drawn) - expected).max() < 0.0005
    with (tmp_path / "out" / "vertices.csv").open(
        encoding="utf-8-sig" if encoding == "utf-8" else "cp932", newline=""
    ) as file:
        rows = list(csv.reader(file))
    numbers = np.array([[float(cell) for cell in _coordinates(rows[0], row)] for row in rows[1:]])
    assert np.abs(numbers - expected).max() < 0.0005


def _coordinates(header, row):
    names = ("東", "北", "標高")
    positions = [next(i for i, h in enumerate(header) if name in h) for name in names]
    return [row[position] for position in positions]


def test_undo_goes_back_to_the_empty_drawing_and_redo_gives_it_back(street):
    for start in (0, 5):
        points = _points_down_the_road(street, start + 3)[start:]
        _draw_line(street, points)
    drawn = {feature.id: feature for feature in street.document.features()}
    assert len(drawn) == 2
    undo = street.parts.window.actions_by_id["undo"]
    redo = street.parts.window.actions_by_id["redo"]
    undo.trigger()
    undo.trigger()
    assert not list(street.document.features())
    assert undo.text().startswith("Undo: Import")
    redo.trigger()
    redo.trigger()
    assert {feature.id: feature for feature in street.document.features()} == drawn
    assert not redo.isEnabled()


def test_backspace_takes_back_the_last_vertex_and_escape_the_whole_line(street):
    first, second, third = _points_down_the_road(street, 3)
    street.parts.toolbox.choose_kind(_kind(street, Geometry.LINE))
    for point in (first, second, third):
        street.click(point)
    street.key(Qt.Key.Key_Backspace)
    street.key(Qt.Key.Key_Return)
    (line,) = street.document.features()
    assert [vertex.measured.point for vertex in line.vertices] == [first, second]
    street.parts.toolbox.choose_kind(_kind(street, Geometry.LINE))
    street.click(third)
    street.key(Qt.Key.Key_Escape)
    assert len(list(street.document.features())) == 1


def test_the_cursor_set_in_the_image_is_the_same_point_in_3d(street):
    point = _points_down_the_road(street, 1)[0]
    street.click(point)
    position = street.document.shared.cursor.position
    assert position.measured.point == point
    assert position == street.position_of(point)


def test_a_deleted_feature_is_gone_in_both_views_and_comes_back(street):
    _draw_line(street, _points_down_the_road(street, 3))
    (line,) = street.document.features()
    street.parts.toolbox.choose("select")
    street.document.shared.selection.choose_features(frozenset({line.id}))
    street.key(Qt.Key.Key_Delete)
    assert not list(street.document.features())
    assert street.document.shared.selection.features == frozenset()
    street.document.undo()
    assert list(street.document.features()) == [line]


def test_undo_takes_back_the_last_vertex_while_a_line_is_drawn(street):
    first, second, third = _points_down_the_road(street, 3)
    street.parts.toolbox.choose_kind(_kind(street, Geometry.LINE))
    undo = street.parts.window.actions_by_id["undo"]
    assert undo.text().startswith("Undo: Import")
    for point in (first, second, third):
        street.click(point)
    undo.trigger()
    street.key(Qt.Key.Key_Return)
    (line,) = street.document.features()
    assert [vertex.measured.point for vertex in line.vertices] == [first, second]
