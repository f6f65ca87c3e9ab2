"""A surveyor's hand that draws a street by mouse and key events alone, and counts them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from PySide6.QtCore import QPoint, QPointF, Qt
from pytestqt.qtbot import QtBot

from app.window.window_parts import WindowParts
from processing.map.feature import PointReference
from processing.recording.drive import Drive
from tests.mouse_events import NO_KEYS, move_mouse, turn_wheel
from widgets.image_view.minimap import Minimap
from widgets.mouse_tools.drawing.draw_line import DrawLine
from widgets.shared.cursor import PickedPosition

LEFT = Qt.MouseButton.LeftButton
_MARGIN_PX = 60
_LEAST_ZOOM = 1.5
"""Screen pixels of a pixel of the image across the road: an edge can be aimed at."""

_TRACE_MS = 20_000
_MOST_STOPS = 6


@dataclass
class WindowUser:
    """Mouse and keyboard of a window; every click, turn of the wheel and key counts as one."""

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
        move_mouse(self.view, spot, keys=modifiers)
        self.bot.mouseClick(self.view, LEFT, modifiers, spot)

    def double_click(self, spot: QPoint) -> None:
        """Click and complete; a double click is one action of the hand."""
        self.actions += 1
        move_mouse(self.view, spot)
        self.bot.mouseClick(self.view, LEFT, NO_KEYS, spot)
        self.bot.mouseDClick(self.view, LEFT, NO_KEYS, spot)

    def wheel(self, notches: int, modifiers: Qt.KeyboardModifier = NO_KEYS) -> None:
        """Turn the wheel in the middle of the image."""
        self.actions += 1
        turn_wheel(self.view, self.view.rect().center(), notches, modifiers)

    def look_at(self, drive: Drive) -> None:
        """Choose a drive in the tree, and see all of it."""
        settings = self.parts.document.shared.view_settings
        if settings.drive_id != drive.id:
            self.actions += 1
            self.parts.project_tree.drive_chosen.emit(drive.id)
        while self.view.viewport.zoom_v < _LEAST_ZOOM:
            self.wheel(5)

    def spot(self, drive: Drive, point: int) -> QPoint:
        """Where a point's pixel is, brought into the window by the minimap and by dragging."""
        position = PickedPosition(
            tuple(drive.xyz(np.array([point]))[0].tolist()), PointReference(drive.id, point)
        )
        at = self._position(position)
        if not _MARGIN_PX <= at.x() <= self.view.width() - _MARGIN_PX:
            self._jump_along(drive, point)
            at = self._position(position)
        viewport = self.view.viewport
        if not viewport.top + _MARGIN_PX <= at.y() <= viewport.bottom - _MARGIN_PX:
            self._pull_down(viewport.top + viewport.height / 2 - at.y())
            at = self._position(position)
        assert self.view.rect().contains(at.toPoint())
        return at.toPoint()

    def _position(self, position: PickedPosition) -> QPointF:
        at = self.view.position_of(position)
        assert at is not None
        return at

    def _is_seen(self, drive: Drive, point: int) -> bool:
        positions = drive.xyz(np.array([point]))[0].tolist()
        at = self._position(PickedPosition(tuple(positions), PointReference(drive.id, point)))
        return bool(_MARGIN_PX <= at.x() <= self.view.width() - _MARGIN_PX)

    def _jump_along(self, drive: Drive, point: int) -> None:
        """Click in the strip that shows the whole drive."""
        image = self.view.picture.image
        row = int(image.pixel_of(np.array([point]))[0][0])
        minimap = self.view.findChild(Minimap)
        self.actions += 1
        spot = QPoint(round((row + 0.5) / image.rows * minimap.width()), minimap.height() // 2)
        self.bot.mouseClick(minimap, LEFT, NO_KEYS, spot)

    def _pull_down(self, pixels: float) -> None:
        """Drag the picture up or down with the middle button."""
        self.actions += 1
        start = self.view.rect().center()
        end = start + QPoint(0, round(pixels))
        middle = Qt.MouseButton.MiddleButton
        self.bot.mousePress(self.view, middle, NO_KEYS, start)
        move_mouse(self.view, end, middle)
        self.bot.mouseRelease(self.view, middle, NO_KEYS, end)

    def trace(self, drive: Drive, kind_key: str, start: int, end: int) -> None:
        """Follow an edge between two points; where it stops, click on beyond."""
        self.look_at(drive)
        if not self._is_seen(drive, start) and self._is_seen(drive, end):
            start, end = end, start  # nobody goes back to where the last line began
        toolbox = self.parts.toolbox
        if toolbox.kind is None or toolbox.kind.key != kind_key:
            self.letter(kind_key)
        if toolbox.name != "trace":
            self.letter("t")
        tool = self.parts.toolbox.tool
        assert isinstance(tool, DrawLine)
        self.click(self.spot(drive, start))
        for _ in range(_MOST_STOPS):
            self.double_click(self.spot(drive, end))
            self.bot.waitUntil(lambda: not tool.is_following, timeout=_TRACE_MS)
            if self.parts.document.shared.sketch.drawing is None:
                return
        message = f"the trace to point {end} doesn't arrive"
        raise AssertionError(message)

    def put_point(self, drive: Drive, kind_id: str, point: int) -> None:
        """Click a point as a feature of a kind that is chosen by name once."""
        self.look_at(drive)
        self._choose_kind(kind_id)
        self.click(self.spot(drive, point), Qt.KeyboardModifier.ControlModifier)

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
