"""The diagnostic layer: the scanline of the section, and why places on it were taken or not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from threading import Event

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtCore import QPointF
from PySide6.QtGui import QImage, QPainter
from pytestqt.qtbot import QtBot

from processing.core.text import Text
from processing.methods.road.diagnostics import Diagnostic, DiagnosticTest
from processing.recording.passes import passes_of
from processing.tools.listed.registry import TOOLS
from tests.widgets.builders import OpenMap, imported_drive
from tests.widgets.section_view.conftest import SectionViewUser, on_road, shown
from widgets.section_view.picture.diagnostic_marks import DiagnosticMarks
from widgets.section_view.picture.projection import SectionProjection
from widgets.section_view.picture.section_diagnostics import (
    FoundDiagnostics,
    SectionDiagnostics,
    ShownDiagnostic,
)
from widgets.shared.cursor import PickedPosition

WAIT_MS = 30_000
BLUE = np.array([0x56, 0xB4, 0xE9])


def blue(user: SectionViewUser) -> NDArray[np.int64]:
    """Columns of the window's pixels, right of the legend, that are a scanline's."""
    image = user.pane.grab().toImage().convertToFormat(QImage.Format.Format_RGBA8888)
    pixels = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1, 4)
    is_line = np.abs(pixels[120:, :, :3] - BLUE).max(axis=2) < 24
    return np.flatnonzero(is_line.any(axis=0))


def _point(spot: NDArray[np.float64]) -> QPointF:
    return QPointF(*spot.tolist())


def test_points_of_the_next_section_do_not_wait_for_a_tool_that_looks_long(
    user: SectionViewUser, monkeypatch: pytest.MonkeyPatch
) -> None:
    began, may_end = Event(), Event()

    def look_long(_asked: object, _parameters: object) -> tuple[Diagnostic, ...]:
        began.set()
        may_end.wait(WAIT_MS / 1000)
        return ()

    slow = replace(TOOLS["curbs"], id="slow", diagnostics=look_long)
    monkeypatch.setitem(TOOLS, "slow", slow)
    view, pane = user.view, user.pane
    view.use_tool_parameters({"slow": slow.parameters()})
    view.use_settings(replace(view.settings, shows_diagnostics=True))
    user.qtbot.waitUntil(began.is_set, timeout=WAIT_MS)
    view.show_position(on_road(user, 7.0))
    asked = pane.standing

    def is_there() -> bool:
        return pane.picture is not None and pane.picture.request.standing == asked

    user.qtbot.waitUntil(is_there, timeout=WAIT_MS)
    assert not may_end.is_set()
    may_end.set()


def test_the_scanline_is_drawn_over_its_points_until_it_is_turned_off(
    qtbot: QtBot, tmp_path: Path
) -> None:
    user = shown(qtbot, OpenMap((imported_drive(tmp_path / "street"),)))
    (drive,) = user.map.drives()
    (way,) = passes_of(drive)
    middle = way.positions_at(way.station_at([np.median(drive.columns["time"])]))[0]
    user.do(lambda: user.view.show_position(PickedPosition(tuple(middle.tolist()))))
    assert not blue(user).size
    wanted = replace(user.view.settings, shows_diagnostics=True)
    user.do(lambda: user.view.use_settings(wanted))
    picture = user.pane.picture
    assert picture is not None
    assert picture.diagnostics is not None
    (found,) = picture.diagnostics.drives
    assert found.drive == drive.info.name
    line = np.concatenate(found.lines)
    assert line[:, 0].min() < -3.0 < 3.0 < line[:, 0].max()
    assert np.abs(line[:, 2]).max() < 0.2
    near = picture.section[np.abs(picture.section[:, 0]) < 2.0, 1]
    road = line[np.abs(line[:, 0]) < 2.0, 1]
    assert near.min() - 0.02 < road.min() <= road.max() < near.max() + 0.02
    assert blue(user).size > 100
    user.do(lambda: user.view.use_settings(replace(wanted, shows_diagnostics=False)))
    assert not blue(user).size
    user.view.close()


def test_the_mark_at_the_mouse_tells_its_tests(qtbot: QtBot, tmp_path: Path) -> None:
    user = shown(qtbot, OpenMap((imported_drive(tmp_path / "street"),)))
    picture, viewport = user.pane.picture, user.pane.viewport
    assert picture is not None
    cut = picture.request.cut
    outcome = DiagnosticTest(
        Text("Height of the step", "段差の高さ"), 0.021, 0.03, "m", is_met=False
    )
    positions = np.array([[2.0, cut.middle[2], 0.0], [-2.0, cut.middle[2], 0.0]])
    diagnostics = tuple(
        ShownDiagnostic(
            "curbs", Diagnostic(cut.to_space(position[None])[0], (outcome,), is_taken), position
        )
        for position, is_taken in zip(positions, (True, False), strict=True)
    )
    reported = replace(
        picture, diagnostics=FoundDiagnostics((SectionDiagnostics("street", (), diagnostics),))
    )
    marks = DiagnosticMarks("en")
    spots = viewport.to_screen(SectionProjection(cut).on_plane(positions))
    assert marks.hover(reported, viewport, _point(spots[1]))
    assert marks.hovered is diagnostics[1]
    assert not marks.hover(reported, viewport, _point(spots[1] + 2.0))
    assert marks.hover(reported, viewport, _point(spots[1] + 40.0))
    assert marks.hovered is None
    assert not marks.hover(None, viewport, _point(spots[1]))
    user.view.close()


def test_the_outline_that_was_laid_on_a_plate_is_drawn_about_its_mark(
    qtbot: QtBot, tmp_path: Path
) -> None:
    user = shown(qtbot, OpenMap((imported_drive(tmp_path / "street"),)))
    picture, viewport = user.pane.picture, user.pane.viewport
    assert picture is not None
    cut = picture.request.cut
    middle = np.array([2.0, cut.middle[2] + 2.0, 0.0])
    ring = middle + 0.5 * np.array([[-1.0, -1.0, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    looked_at = Diagnostic(cut.to_space(middle[None])[0], (), is_taken=True)
    shown_one = ShownDiagnostic("signs", looked_at, middle, ring)
    reported = replace(
        picture, diagnostics=FoundDiagnostics((SectionDiagnostics("street", (), (shown_one,)),))
    )
    image = QImage(int(viewport.width), int(viewport.height), QImage.Format.Format_RGBA8888)
    image.fill(0)
    with QPainter(image) as painter:
        DiagnosticMarks("en").paint(painter, reported, viewport)
    sides = np.vstack([ring[:1] / 2 + ring[1:2] / 2, ring[1:2] / 2 + ring[2:3] / 2])
    spots = viewport.to_screen(SectionProjection(cut).on_plane(sides)).round().astype(int)
    for x, y in spots.tolist():
        near = [image.pixelColor(x + i, y + j).green() for i in (-1, 0, 1) for j in (-1, 0, 1)]
        assert max(near) > 200
    user.view.close()


def test_the_points_that_a_trunk_stands_on_are_drawn_in_its_colour(
    qtbot: QtBot, tmp_path: Path
) -> None:
    user = shown(qtbot, OpenMap((imported_drive(tmp_path / "street"),)))
    picture, viewport = user.pane.picture, user.pane.viewport
    assert picture is not None
    cut = picture.request.cut
    middle = np.array([2.0, cut.middle[2] + 2.0, 0.0])
    points = middle + np.array([[-0.6, 0.3, 0.0], [0.6, 0.3, 0.1], [0.0, 0.7, -0.1]])
    looked_at = Diagnostic(
        cut.to_space(middle[None])[0], (), is_taken=True, points=cut.to_space(points)
    )
    one = ShownDiagnostic("trees", looked_at, middle, points=points)
    reported = replace(
        picture, diagnostics=FoundDiagnostics((SectionDiagnostics("street", (), (one,)),))
    )
    image = QImage(int(viewport.width), int(viewport.height), QImage.Format.Format_RGBA8888)
    image.fill(0)
    painter = QPainter(image)
    DiagnosticMarks("en").paint(painter, reported, viewport)
    painter.end()
    for spot in viewport.to_screen(SectionProjection(cut).on_plane(points)).round().astype(int):
        assert image.pixelColor(*spot.tolist()).name() == "#3ddc97"
    user.view.close()


def test_what_is_known_is_drawn_while_other_tools_are_asked(qtbot: QtBot, tmp_path: Path) -> None:
    user = shown(qtbot, OpenMap((imported_drive(tmp_path / "street"),)))
    picture, viewport = user.pane.picture, user.pane.viewport
    assert picture is not None
    line = np.array([[-3.0, picture.request.cut.middle[2], 0.0], [3.0, 0.0, 0.0]])
    line[1, 1] = line[0, 1]
    found = FoundDiagnostics((SectionDiagnostics("street", (line,)),), "trees")
    widths = []
    for known in (found, replace(found, awaited="")):
        image = QImage(int(viewport.width), int(viewport.height), QImage.Format.Format_RGBA8888)
        image.fill(0)
        marks, reported = DiagnosticMarks("ja"), replace(picture, diagnostics=known)
        with QPainter(image) as painter:
            marks.paint(painter, reported, viewport)
            marks.paint_words(painter, reported, viewport)
        pixels = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1, 4)
        widths.append(np.flatnonzero(pixels[:120, :, 3].any(axis=1)).size)
        assert pixels[..., 3].any(axis=0).sum() > viewport.scale * 5.9
    assert widths[0] > widths[1] + 10  # a line of the legend more: which tool is asked
    user.view.close()
