"""A line of ten thousand vertices: drawn, dragged, undone, exported and read again."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt

from processing.image.images_of_drives import image_of
from processing.map.catalogue import Geometry
from processing.map.feature import PointReference
from processing.operations.export import ExportRequest
from tests.journeys.conftest import Surveyor
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.cursor import PickedPosition

COUNT = 10_000


@pytest.fixture
def street(surveyor: Surveyor, tmp_path: Path) -> Iterator[Surveyor]:
    surveyor.open_sample_street(tmp_path / "通り.zuka")
    surveyor.document.shared.snap.choose_modes(frozenset())
    return surveyor


def _positions(street: Surveyor) -> list[PickedPosition]:
    """Measured points along the street, in the order of their rows."""
    image = image_of(street.drive, street.document.shared.view_settings.image_kind)
    per_row = -(-COUNT // (image.rows - 40))
    points: list[int] = []
    for row in range(20, image.rows - 20):
        first, end = int(image.row_starts[row]), int(image.row_starts[row + 1])
        middle = (first + end) // 2
        points += range(middle, min(middle + per_row, end))
    chosen = points[:COUNT]
    xyz = street.drive.xyz(np.array(chosen)).tolist()
    return [
        PickedPosition((east, north, up), PointReference(street.drive.id, point))
        for (east, north, up), point in zip(xyz, chosen, strict=True)
    ]


def test_a_line_of_ten_thousand_vertices_is_drawn_edited_undone_and_exported(
    street: Surveyor, tmp_path: Path, record_property
) -> None:
    positions = _positions(street)
    assert len(positions) == COUNT
    kinds = street.document.catalogue().kinds
    street.parts.toolbox.choose_kind(next(k for k in kinds if k.geometry is Geometry.LINE))
    user = street.parts.toolbox.current_tool
    started = time.perf_counter()
    for number, position in enumerate(positions):
        if number % 100 == 0:
            user.move(Hit(position))
        user.press(Hit(position))
    record_property("drawn_s", time.perf_counter() - started)
    street.key(Qt.Key.Key_Return)
    (line,) = street.document.features()
    assert [vertex.xyz for vertex in line.vertices] == [position.xyz for position in positions]

    street.parts.toolbox.choose("edit")
    middle, view = positions[COUNT // 2], street.parts.image_view
    spot = street.pixel_of(middle.measured.point)
    street.bot.mousePress(view, Qt.MouseButton.LeftButton, pos=spot)
    moves = []
    for step in range(1, 6):
        started = time.perf_counter()
        street.bot.mouseMove(view, spot + QPoint(0, 8 * step))
        view.repaint()
        moves.append(time.perf_counter() - started)
    record_property("drag_and_repaint_s", max(moves))
    street.bot.mouseRelease(view, Qt.MouseButton.LeftButton, pos=spot + QPoint(0, 40))
    (moved,) = street.document.features()
    changed = [a != b for a, b in zip(moved.vertices, line.vertices, strict=True)]
    assert sum(changed) == 1

    street.document.undo()
    assert list(street.document.features()) == [line]
    street.document.redo()
    request = ExportRequest(("dxf",), tmp_path / "out", "ja")
    street.wait_for_job(lambda: street.document.export(request))
    (path,) = (tmp_path / "out").glob("*.dxf")
    (polyline,) = ezdxf.readfile(path).modelspace().query("POLYLINE")
    exported = np.array([tuple(vertex.dxf.location) for vertex in polyline.vertices])
    assert np.abs(exported - [vertex.xyz for vertex in moved.vertices]).max() < 0.0005
