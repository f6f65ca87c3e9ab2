"""A window is never larger than its screen, nor outside it: its status bar can be seen."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QByteArray, QRect
from PySide6.QtGui import QGuiApplication

from app.application import build_window
from app.layout.view_area import AreaLayout
from app.settings.settings import Settings, WindowLayout
from app.window.main_window import MainWindow
from app.window.screen_room import fitted

WANTED = QRect(0, 0, 1600, 1000)


@pytest.mark.parametrize(
    ("room", "expected"),
    [
        (QRect(0, 0, 1366, 728), QRect(0, 0, 1366, 728)),  # a taskbar below
        (QRect(0, 40, 1280, 680), QRect(0, 40, 1280, 680)),  # one above
        (QRect(0, 0, 1920, 1040), WANTED),
        (QRect(0, 0, 1280, 693), QRect(0, 0, 1280, 693)),  # 1920 × 1080 at 150 %
        (QRect(1920, 0, 1920, 1080), QRect(1920, 0, 1600, 1000)),  # the other screen
    ],
)
def test_a_window_fits_what_is_free_of_a_screen(room: QRect, expected: QRect) -> None:
    assert fitted(WANTED, room) == expected


@pytest.mark.parametrize("at", [(5000, 3000), (-4000, -900), (1000, 600)])
def test_a_window_outside_is_brought_back(at: tuple[int, int]) -> None:
    room = QRect(0, 0, 1366, 728)
    found = fitted(QRect(*at, 1000, 700), room)
    assert room.contains(found)
    assert (found.width(), found.height()) == (1000, 700)


def _can_be_seen(window: MainWindow) -> bool:
    room = QGuiApplication.primaryScreen().availableGeometry()
    bar = window.statusBar()
    corners = (bar.rect().topLeft(), bar.rect().bottomRight())
    return room.contains(window.geometry()) and all(
        room.contains(bar.mapToGlobal(corner)) for corner in corners
    )


def test_the_first_start_shows_the_status_bar(qtbot, tmp_path: Path) -> None:
    window = build_window(Settings(tmp_path / "zuka.ini"), tmp_path).window
    qtbot.addWidget(window)
    with qtbot.waitExposed(window):
        window.show()
    assert _can_be_seen(window)


def test_a_place_on_a_larger_screen_is_brought_onto_this_one(qtbot, tmp_path: Path) -> None:
    room = QGuiApplication.primaryScreen().availableGeometry()
    window = build_window(Settings(tmp_path / "zuka.ini"), tmp_path).window
    qtbot.addWidget(window)
    window.setGeometry(room.right() - 200, room.bottom() - 100, room.width() + 900, 3000)
    left = WindowLayout(window.saveGeometry(), QByteArray(), AreaLayout(QByteArray()))
    window.restore_layout(left)
    with qtbot.waitExposed(window):
        window.show()
    assert _can_be_seen(window)
