"""Studio: a real window on the sample street, somebody's hand at it, and the camera."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import TypeVar

import numpy as np
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog, QWidget

from app.screenshots.hand import CONTROL, PLAIN, Hand
from app.window_parts import WindowParts
from processing.points.drive import Drive
from processing.project.feature import PointReference, Position
from widgets.shared.cursor import Place

_LONGEST_MS = 60_000
_REST_MS = 4_000
_PULSE_MS = 60
_NEAR_M = 0.3
_SAME_TIMES = 3

Found = TypeVar("Found", bound=QWidget)


@dataclass
class Studio:
    """What a scene is made with.

    Parameters
    ----------
    parts : WindowParts
        Of a window that is shown.
    out : Path
        Folder of the pictures.
    scratch : Path
        Folder for files that scenes need; gone afterwards.
    """

    parts: WindowParts
    out: Path
    scratch: Path
    hand: Hand

    @property
    def view(self) -> QWidget:
        """The image."""
        return self.parts.image_view

    # Where things are.

    def drive(self, name: str) -> Drive:
        """The drive of a scanner by its name."""
        return next(one for one in self.parts.document.drives() if one.info.name == name)

    def place(self, name: str, xyz: Position) -> Place:
        """The measured point of a drive nearest to a place."""
        drive = self.drive(name)
        point = drive.nearest_point(np.array(xyz), _NEAR_M)
        east, north, up = drive.xyz(np.array([point]))[0].tolist()
        return Place((east, north, up), PointReference(drive.id, point))

    def spot(self, name: str, xyz: Position) -> QPoint:
        """Where a place is in the image."""
        at = self.parts.image_view.position_of(self.place(name, xyz))
        return QPoint() if at is None else at.toPoint()

    def spot_3d(self, name: str, xyz: Position) -> QPoint:
        """Where a place is in the 3D view's picture."""
        at = self.parts.scene_view.position_of(self.place(name, xyz))
        return QPoint() if at is None else at.toPoint()

    def look(self, name: str, xyz: Position, notches: int) -> None:
        """Show a drive with a place in the middle, so many notches of the wheel larger."""
        tree = self.parts.project_tree
        if self.parts.document.shared.view_settings.drive_id != self.drive(name).id:
            tree.drive_chosen.emit(self.drive(name).id)
        self.key(Qt.Key.Key_Home)
        spot = self.spot(name, xyz)
        self.hand.wheel(self.view, spot, notches)
        self.hand.push(self.view, self.spot(name, xyz), self.view.rect().center())
        self.settle()

    # What the hand does in the image.

    def key(self, key: Qt.Key, modifiers: Qt.KeyboardModifier = PLAIN) -> None:
        """Press a key over the image."""
        self.hand.key(self.view, key, modifiers)

    def letter(self, letter: str, modifiers: Qt.KeyboardModifier = PLAIN) -> None:
        """Press a letter over the image."""
        self.key(Qt.Key(ord(letter.upper())), modifiers)

    def draw(self, name: str, places: list[Position]) -> None:
        """Click measured points exactly, one after the other."""
        for xyz in places:
            self.hand.click(self.view, self.spot(name, xyz), CONTROL)

    def hover(self, spot: QPoint, modifiers: Qt.KeyboardModifier = PLAIN) -> None:
        """Bring the mouse to a spot of the image, in steps, as it would come."""
        self.hand.move(self.view, spot - QPoint(9, 5), modifiers)
        self.hand.move(self.view, spot, modifiers)

    # Waiting and shooting.

    def wait(self, condition: Callable[[], bool], longest_ms: int = _LONGEST_MS) -> bool:
        """Let the window live until something is so; says whether it came to be."""
        end = monotonic() + longest_ms / 1000
        while not condition():
            if monotonic() > end:
                return False
            QTest.qWait(_PULSE_MS)
        return True

    def settle(self) -> None:
        """Let the window live until its picture doesn't change any more."""
        shown: list[QImage] = []

        def rests() -> bool:
            shown.append(self._grab())
            return len(shown) > _SAME_TIMES and all(
                one == shown[-1] for one in shown[-1 - _SAME_TIMES :]
            )

        self.wait(rests, _REST_MS)

    def shoot(self, name: str) -> None:
        """Keep what the window shows, and what stands before it."""
        self.settle()
        path = self.out / f"{name}-{self.parts.language}.png"
        if not self._grab().save(str(path)):
            message = f"{path} can't be written"
            raise OSError(message)

    def dialog(self, kind: type[Found]) -> Found:
        """The form that is open, made active."""
        found = [
            one for one in QApplication.topLevelWidgets() if isinstance(one, kind) and one.isVisible()
        ]
        if not found:
            message = f"no {kind.__name__} is open"
            raise LookupError(message)
        found[-1].activateWindow()
        QTest.qWaitForWindowActive(found[-1])
        return found[-1]

    def tidy(self) -> None:
        """Close what a scene has opened, and let everything be as before it."""
        self.hand.let_go()
        popup = QApplication.activePopupWidget()
        while popup is not None:
            popup.close()
            popup = QApplication.activePopupWidget()
        for one in QApplication.topLevelWidgets():
            if isinstance(one, QDialog) and one.isVisible():
                one.close()
        window = self.parts.window
        window.activateWindow()
        QTest.qWaitForWindowActive(window)
        self.view.setFocus()

    def _grab(self) -> QImage:
        window = self.parts.window
        at = window.frameGeometry()
        picture = window.screen().grabWindow(0, at.x(), at.y(), at.width(), at.height())
        return picture.toImage()


def along(line: list[Position], share: float) -> Position:
    """The place at a share of a line's length."""
    legs = [math.dist(a, b) for a, b in zip(line, line[1:], strict=False)]
    left = share * sum(legs)
    for (begin, end), leg in zip(zip(line, line[1:], strict=False), legs, strict=True):
        if left <= leg:
            part = left / leg
            x, y, z = ((1 - part) * a + part * b for a, b in zip(begin, end, strict=True))
            return x, y, z
        left -= leg
    return line[-1]
