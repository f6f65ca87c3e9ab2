"""A surveyor's hand that draws a street by mouse and key events alone, and counts them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.window_parts import WindowParts
from processing.points.drive import Drive
from processing.project.feature import PointReference
from widgets.mouse_tools.draw_path import DrawPath
from widgets.shared.cursor import Place

Floats = NDArray[np.float64]

LEFT = Qt.MouseButton.LeftButton
NO_KEYS = Qt.KeyboardModifier.NoModifier
_MARGIN_PX = 60
_LEAST_ZOOM = 1.5
"""Screen pixels of a pixel of the image across the road: an edge can be aimed at."""

_TRACE_MS = 20_000
_MOST_STOPS = 6


@dataclass(frozen=True)
class TrueStreet:
    """What stands on a street.

    Attributes
    ----------
    curbs : tuple of (drive name, kind, (n, 3) float64)
    signs : tuple of (drive name, centre, size in m, degrees clockwise from north it faces)
    trees : tuple of (drive name, foot, diameter in m)
    """

    curbs: tuple[tuple[str, str, Floats], ...]
    signs: tuple[tuple[str, Floats, float, float], ...]
    trees: tuple[tuple[str, Floats, float], ...]

    @staticmethod
    def read(path: Path) -> TrueStreet:
        stored = json.loads(path.read_text(encoding="utf-8"))
        return TrueStreet(
            tuple((one["drive"], one["kind"], np.array(one["line"])) for one in stored["curbs"]),
            tuple(
                (one["drive"], np.array(one["centre"]), one["size_m"], one["facing_deg"])
                for one in stored["signs"]
            ),
            tuple((one["drive"], np.array(one["foot"]), one["dbh_m"]) for one in stored["trees"]),
        )


@dataclass
class Hand:
    """Mouse and keyboard of a window; every press, turn of the wheel and key counts as one."""

    bot: QtBot
    parts: WindowParts
    actions: int = 0
    counted: dict[str, int] = field(default_factory=dict)

    @property
    def view(self):
        return self.parts.image_view

    def __post_init__(self) -> None:
        # Keys reach the menus of the active window only.
        with self.bot.waitActive(self.parts.window):
            self.parts.window.activateWindow()
        self.view.setFocus()

    def drive(self, name: str) -> Drive:
        return next(one for one in self.parts.document.drives() if one.info.name == name)

    def key(self, key: Qt.Key, modifiers: Qt.KeyboardModifier = NO_KEYS) -> None:
        self.actions += 1
        self.bot.keyClick(self.view, key, modifiers)

    def letter(self, letter: str) -> None:
        self.actions += 1
        self.bot.keyClick(self.view, letter)

    def click(self, spot: QPoint, modifiers: Qt.KeyboardModifier = NO_KEYS) -> None:
        """Bring the mouse to a pixel and click."""
        self.actions += 1
        event = QMouseEvent(
            QEvent.Type.MouseMove,
            QPointF(spot),
            QPointF(self.view.mapToGlobal(spot)),
            Qt.MouseButton.NoButton,
            Qt.MouseButton.NoButton,
            modifiers,
        )
        QApplication.sendEvent(self.view, event)
        self.bot.mouseClick(self.view, LEFT, modifiers, spot)

    def wheel(self, notches: int, modifiers: Qt.KeyboardModifier = NO_KEYS) -> None:
        """Turn the wheel in the middle of the image."""
        self.actions += 1
        spot = self.view.rect().center()
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

    def look_at(self, drive: Drive) -> None:
        """Choose a drive in the tree, and see all of it."""
        settings = self.parts.document.shared.view_settings
        if settings.drive_id != drive.id:
            self.actions += 1
            self.parts.project_tree.drive_chosen.emit(drive.id)
            self.key(Qt.Key.Key_Home)
        while self.view.viewport.zoom_v < _LEAST_ZOOM:
            self.wheel(3)

    def spot(self, drive: Drive, point: int) -> QPoint:
        """Where a point's pixel is; the wheel brings it into the window."""
        place = Place(
            tuple(drive.xyz(np.array([point]))[0].tolist()), PointReference(drive.id, point)
        )
        shift = Qt.KeyboardModifier.ShiftModifier
        for _ in range(100):
            at = self.view.position_of(place)
            assert at is not None
            if at.x() < _MARGIN_PX:
                self.wheel(1, shift)
            elif at.x() > self.view.width() - _MARGIN_PX:
                self.wheel(-1, shift)
            else:
                return at.toPoint()
        message = f"point {point} doesn't come into the window"
        raise AssertionError(message)

    def trace(self, drive: Drive, kind_key: str, start: int, end: int) -> None:
        """Follow an edge between two points; where it stops, click on beyond."""
        self.look_at(drive)
        self.letter(kind_key)
        self.letter("t")
        tool = self.parts.toolbox.tool
        assert isinstance(tool, DrawPath)
        self.click(self.spot(drive, start))
        for _ in range(_MOST_STOPS):
            self.click(self.spot(drive, end))
            self.bot.waitUntil(lambda: not tool.is_following, timeout=_TRACE_MS)
            drawing = self.parts.document.shared.sketch.drawing
            assert drawing is not None
            last = np.array(drawing.vertices[-1].xyz)
            if np.linalg.norm(last - drive.xyz(np.array([end]))[0]) < 0.1:
                break
        self.key(Qt.Key.Key_Return)

    def put_point(self, drive: Drive, kind_id: str, points: Sequence[int]) -> None:
        """Click points as features of a kind that is chosen by name once."""
        self.look_at(drive)
        self._choose_kind(kind_id)
        control = Qt.KeyboardModifier.ControlModifier
        for point in points:
            self.click(self.spot(drive, point), control)

    def _choose_kind(self, kind_id: str) -> None:
        kind = self.parts.document.catalogue()[kind_id]
        toolbox = self.parts.toolbox
        if toolbox.kind != kind and kind.key:
            self.letter(kind.key)
        elif toolbox.kind != kind:
            self.actions += 1 + len(kind.name.en)  # Ctrl+K, its name, Enter
            toolbox.choose_kind(kind)

    def note(self, what: str, since: int) -> None:
        """Remember how many actions something took."""
        self.counted[what] = self.counted.get(what, 0) + self.actions - since
