"""Frames of the 3D view: drawn when they can be seen, after what else the window paints."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtCore import QEvent, QObject, QSize, Qt
from PySide6.QtGui import QColor, QImage
from PySide6.QtWidgets import QHBoxLayout, QLabel, QWidget
from pytestqt.qtbot import QtBot
from typing_extensions import override

from widgets.scene_view.rendering.scene_picture import ScenePicture

WAIT_MS = 10_000


class Beside(QWidget):
    """A window with a picture and another view, and the order in which they were at work."""

    def __init__(self) -> None:
        super().__init__()
        self.order: list[str] = []
        self.other = QLabel("another view")
        self.picture = ScenePicture(self, self.draw)
        layout = QHBoxLayout(self)
        layout.addWidget(self.picture)
        layout.addWidget(self.other)
        self.resize(400, 200)
        self.other.installEventFilter(self)

    def draw(self, size_px: QSize) -> QImage:
        self.order.append("frame")
        frame = QImage(size_px, QImage.Format.Format_RGB32)
        frame.fill(Qt.GlobalColor.green)
        return frame

    @override
    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Paint:
            self.order.append("other view")
        return False


@pytest.fixture
def beside(qtbot: QtBot) -> Iterator[Beside]:
    window = Beside()
    qtbot.addWidget(window)
    with qtbot.waitSignal(window.picture.frame_painted, timeout=WAIT_MS):
        window.show()
    window.order.clear()
    yield window
    window.close()


def test_a_frame_is_drawn_after_the_other_views_were_painted(qtbot: QtBot, beside: Beside) -> None:
    with qtbot.waitSignal(beside.picture.frame_painted, timeout=WAIT_MS):
        beside.picture.redraw()
        beside.other.update()
    assert beside.order[:2] == ["other view", "frame"]
    assert beside.grab().toImage().pixelColor(20, 100) == QColor(Qt.GlobalColor.green)


def test_many_requests_give_one_frame(qtbot: QtBot, beside: Beside) -> None:
    with qtbot.waitSignal(beside.picture.frame_painted, timeout=WAIT_MS):
        for _ in range(20):
            beside.picture.redraw()
    assert beside.order.count("frame") == 1


def test_a_hidden_picture_is_drawn_once_it_can_be_seen_again(qtbot: QtBot, beside: Beside) -> None:
    beside.picture.hide()
    beside.picture.redraw()
    with qtbot.assertNotEmitted(beside.picture.frame_painted, wait=50):
        beside.other.update()
    assert "frame" not in beside.order
    with qtbot.waitSignal(beside.picture.frame_painted, timeout=WAIT_MS):
        beside.picture.show()
    assert beside.order.count("frame") >= 1


def test_a_picture_of_another_size_is_drawn_anew(qtbot: QtBot, beside: Beside) -> None:
    with qtbot.waitSignal(beside.picture.frame_painted, timeout=WAIT_MS):
        beside.resize(500, 260)
    image = beside.picture.grab().toImage()
    assert image.pixelColor(image.width() - 2, image.height() - 2) == QColor(Qt.GlobalColor.green)
