"""An operator's mouse and keys in a real window, and where in its image there is what."""

from __future__ import annotations

import random
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from app.application import build_window, make_application
from app.settings.settings import Settings
from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.text import Text
from processing.map.feature import Feature
from widgets.image_view.view import ImageView
from widgets.shared.cursor import PickedPosition

LEFT, RIGHT = Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton
FREE = Qt.KeyboardModifier.NoModifier
SHIFT, CTRL = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.ControlModifier
_SOME_MODIFIERS = (FREE, FREE, FREE, FREE, SHIFT, CTRL)
_MARGIN_PX = 4
_PAUSE_MS = 5


@dataclass
class Operator:
    """Somebody in front of a window on a project, who remembers what was refused and told.

    ``settle`` after an action lets everything happen that it started.
    """

    home: Path
    project: Path
    refused: list[UserError] = field(default_factory=list)
    reported: list[Text] = field(default_factory=list)
    parts: WindowParts = field(init=False)

    def __post_init__(self) -> None:
        make_application()
        self.parts = build_window(Settings(self.home / "settings.ini"), self.home)
        self.parts.document.refused.connect(self.refused.append)
        self.parts.document.reported.connect(self.reported.append)
        self.parts.toolbox.reported.connect(self.reported.append)
        self.parts.window.resize(1100, 760)
        self.parts.window.show()
        self.parts.window.activateWindow()
        assert self.parts.document.open(self.project)
        self.wait(lambda: self.parts.image_view.viewport.width > 1)
        self.view.setFocus()

    def close(self) -> None:
        """Close the window and everything that belongs to it."""
        while (popup := QApplication.activePopupWidget()) is not None:
            popup.close()
        self.parts.window.close()
        self.parts.window.deleteLater()
        QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)

    # What there is.

    @property
    def view(self) -> ImageView:
        return self.parts.image_view

    def features(self) -> list[Feature]:
        return list(self.parts.document.features())

    def some_feature(self, choice: random.Random) -> Feature | None:
        """One of those in the window where there are any."""
        features = self.features()
        shown = [one for one in features if self.spot_on_vertex(one, 0) is not None]
        return choice.choice(shown or features) if features else None

    def some_spot(self, choice: random.Random) -> QPoint:
        """Any pixel of the image view: points, vertices, nothing at all."""
        return QPoint(
            choice.randint(_MARGIN_PX, self.view.width() - _MARGIN_PX),
            choice.randint(_MARGIN_PX, self.view.height() - _MARGIN_PX),
        )

    def spot_on_vertex(self, feature: Feature, index: int) -> QPoint | None:
        """Where a vertex is painted; None where it isn't in the window."""
        vertex = feature.vertices[index]
        position = self.view.position_of(
            PickedPosition(vertex.xyz, vertex.measured, vertex.is_occluded)
        )
        return None if position is None else self._if_inside(position)

    def spot_on_line(self, feature: Feature, choice: random.Random) -> QPoint | None:
        """Somewhere on a segment that is in the window."""
        placed = self.view._positions.get(feature.id)
        if placed is None or not placed.segments.size:
            return None
        segment = placed.segments[choice.randrange(len(placed.segments))]
        share = choice.choice((0.25, 0.5, 0.75))
        u, v = segment[:2] + share * (segment[2:4] - segment[:2])
        return self._if_inside(QPointF(*self.view.viewport.position_of(u, v)))

    def _if_inside(self, position: QPointF) -> QPoint | None:
        finite = np.isfinite([position.x(), position.y()]).all()
        if not finite or not self.view.rect().contains(position.toPoint()):
            return None
        return position.toPoint()

    def modifiers(self, choice: random.Random) -> Qt.KeyboardModifier:
        return choice.choice(_SOME_MODIFIERS)

    # Mouse and keys.

    def trigger(self, action: str) -> None:
        """Do what a menu entry or its key does, where it can be done."""
        self.parts.window.actions_by_id[action].trigger()

    def undo(self) -> None:
        """Take a step back, but not the import: without its street there is nothing to work on."""
        project = self.parts.document.project
        if project is not None and project.history.position > 1:
            self.trigger("undo")

    def key(self, key: Qt.Key, modifiers: Qt.KeyboardModifier = FREE) -> None:
        QTest.keyClick(self.view, key, modifiers)

    def click(
        self,
        spot: QPoint,
        modifiers: Qt.KeyboardModifier = FREE,
        button: Qt.MouseButton = LEFT,
        widget: QWidget | None = None,
    ) -> None:
        widget = widget or self.view
        self.move(spot, modifiers, Qt.MouseButton.NoButton, widget)
        QTest.mouseClick(widget, button, modifiers, spot)

    def drag(self, way: list[QPoint], modifiers: Qt.KeyboardModifier = FREE) -> None:
        self.press(way[0], modifiers)
        for spot in way[1:]:
            self.move(spot, modifiers, LEFT)
        self.release(way[-1], modifiers)

    def press(self, spot: QPoint, modifiers: Qt.KeyboardModifier = FREE) -> None:
        self.move(spot, modifiers)
        QTest.mousePress(self.view, LEFT, modifiers, spot)

    def release(self, spot: QPoint, modifiers: Qt.KeyboardModifier = FREE) -> None:
        QTest.mouseRelease(self.view, LEFT, modifiers, spot)

    def move(
        self,
        spot: QPoint,
        modifiers: Qt.KeyboardModifier = FREE,
        button: Qt.MouseButton = Qt.MouseButton.NoButton,
        widget: QWidget | None = None,
    ) -> None:
        widget = widget or self.view
        position = QPointF(spot)
        event = QMouseEvent(
            QEvent.Type.MouseMove,
            position,
            QPointF(widget.mapToGlobal(spot)),
            Qt.MouseButton.NoButton,
            button,
            modifiers,
        )
        QApplication.sendEvent(widget, event)

    def wheel(self, spot: QPoint, notches: int, modifiers: Qt.KeyboardModifier = FREE) -> None:
        event = QWheelEvent(
            QPointF(spot),
            QPointF(self.view.mapToGlobal(spot)),
            QPoint(),
            QPoint(0, 120 * notches),
            Qt.MouseButton.NoButton,
            modifiers,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        )
        QApplication.sendEvent(self.view, event)

    # Time.

    def settle(self) -> None:
        """Let everything happen that waits for nothing."""
        for _ in range(2):
            QApplication.processEvents()
            QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)

    def wait(self, has_come: Callable[[], bool], timeout_ms: int = 60_000) -> None:
        until = time.monotonic() + timeout_ms / 1000
        while not has_come():
            assert time.monotonic() < until, "it did not come"
            QTest.qWait(_PAUSE_MS)

    def wait_for_jobs(self) -> None:
        self.wait(lambda: not self.parts.jobs.is_busy)
