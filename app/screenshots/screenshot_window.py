"""ScreenshotWindow: a real window on the sample street, somebody's hand at it, and the camera."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from time import monotonic, sleep
from typing import TypeVar

import numpy as np
from PySide6.QtCore import QByteArray, QEventLoop, QPoint, QSize, Qt, QTimer
from PySide6.QtGui import QCursor, QGuiApplication, QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog, QDockWidget, QLineEdit, QWidget

from app.layout.view_area import AreaLayout
from app.review.review import Review
from app.screenshots.simulated_mouse import CONTROL, PLAIN, SimulatedMouse
from app.window.window_parts import WindowParts
from processing.image.search.nearest import nearest_point
from processing.map.feature import Feature, PointReference, Position
from processing.recording.drive import Drive
from widgets.parts.command_palette import CommandPalette
from widgets.scene_view.clipping import ClipChoice
from widgets.section_view.picture.settings import SectionSettings
from widgets.shared.cursor import PickedPosition
from widgets.shared.image_orientation import ImageOrientation

_LONGEST_MS = 60_000
_REST_MS = 15_000
_PULSE_MS = 60
_NEAR_M = 0.3
_SAME_TIMES = 3
_MOST_STEPS = 60

WidgetT = TypeVar("WidgetT", bound=QWidget)


@dataclass
class ScreenshotWindow:
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
    mouse: SimulatedMouse
    _docks: QByteArray = field(default_factory=QByteArray, init=False)
    _area: AreaLayout = field(default_factory=AreaLayout, init=False)
    _size: QSize = field(default_factory=QSize, init=False)
    _changes: int = field(default=0, init=False)

    @property
    def view(self) -> QWidget:
        """The image."""
        return self.parts.image_view

    # Where things are.

    def drive(self, name: str) -> Drive:
        """The drive of a scanner by its name."""
        return next(one for one in self.parts.document.drives() if one.info.name == name)

    def position(self, name: str, xyz: Position) -> PickedPosition:
        """The measured point of a drive nearest to a place."""
        drive = self.drive(name)
        point = nearest_point(drive, np.array(xyz), _NEAR_M)
        if point < 0:
            message = f"no point of {name} is near {xyz}"
            raise LookupError(message)
        east, north, up = drive.xyz(np.array([point]))[0].tolist()
        return PickedPosition((east, north, up), PointReference(drive.id, point))

    def spot(self, name: str, xyz: Position) -> QPoint:
        """Where a place is in the image."""
        at = self.parts.image_view.position_of(self.position(name, xyz))
        return QPoint() if at is None else at.toPoint()

    def spot_3d(self, name: str, xyz: Position) -> QPoint:
        """Where a place is in the 3D view's picture."""
        at = self.parts.scene_view.position_of(self.position(name, xyz))
        return QPoint() if at is None else at.toPoint()

    def features(self, kind: str, name: str) -> list[Feature]:
        """What was drawn of a kind on a drive."""
        drive = self.drive(name).id
        return [
            one
            for one in self.parts.document.features()
            if one.kind == kind and one.vertices[0].measured is not None
            if one.vertices[0].measured.drive == drive
        ]

    def feature(self, kind: str, name: str) -> Feature:
        """The one of a kind on a drive that has most vertices."""
        return max(self.features(kind, name), key=lambda one: len(one.vertices))

    def show_drive(self, name: str) -> None:
        """Choose a drive, as a click in the project's tree does."""
        if self.parts.document.shared.view_settings.drive_id != self.drive(name).id:
            self.parts.project_tree.drive_chosen.emit(self.drive(name).id)

    def look(self, name: str, xyz: Position, notches: int) -> None:
        """Show a drive with a place in the middle, so many notches of the wheel larger."""
        self.show_drive(name)
        self.key(Qt.Key.Key_Home)
        spot = self.spot(name, xyz)
        self.mouse.wheel(self.view, spot, notches)
        self.mouse.push(self.view, self.spot(name, xyz), self.view.rect().center())
        self.settle()

    # What the hand does in the image.

    def key(self, key: Qt.Key, modifiers: Qt.KeyboardModifier = PLAIN) -> None:
        """Press a key over the image."""
        self.mouse.key(self.view, key, modifiers)

    def letter(self, letter: str, modifiers: Qt.KeyboardModifier = PLAIN) -> None:
        """Press a letter over the image."""
        self.key(Qt.Key(ord(letter.upper())), modifiers)

    def draw(self, name: str, positions: list[Position]) -> None:
        """Click measured points exactly, one after the other."""
        for xyz in positions:
            self.mouse.click(self.view, self.spot(name, xyz), CONTROL)

    def hover(self, spot: QPoint, modifiers: Qt.KeyboardModifier = PLAIN) -> None:
        """Bring the mouse to a spot of the image, in steps, as it would come."""
        self.mouse.move(self.view, spot - QPoint(9, 5), modifiers)
        self.mouse.move(self.view, spot, modifiers)

    def key_in_focus(self, key: Qt.Key) -> None:
        """Press a key in the field that has the focus."""
        self.mouse.key(QApplication.focusWidget() or self.view, key)

    def point_at(self, widget: QWidget) -> None:
        """Put the system's mouse on a widget: menus open where it is."""
        QCursor.setPos(widget.mapToGlobal(widget.rect().bottomLeft()))

    def act(self, id_: str) -> None:
        """Choose a command."""
        self.parts.window.actions_by_id[id_].trigger()

    def bring(self, panel: str) -> None:
        """Bring a panel to the front of those that share its place."""
        dock = self.parts.window.findChild(QDockWidget, panel)
        if isinstance(dock, QDockWidget):
            dock.show()
            dock.raise_()

    def choose_kind(self, words: str) -> None:
        """Choose what is drawn by its name."""
        self.letter("K", CONTROL)
        field = self.dialog(CommandPalette).findChildren(QLineEdit)[0]
        self.mouse.type(field, words)
        self.mouse.key(field, Qt.Key.Key_Return)
        self.tidy()

    # Waiting and shooting.

    def remember(self) -> None:
        """Come back to how the window stands now after each scene."""
        self._changes = self._changes_made()
        self._docks = self.parts.window.saveState()
        self._area = self.parts.window.area.keep()
        self._size = self.parts.window.size()

    def restore(self) -> None:
        """Take back what a scene has done."""
        self.tidy()
        parts = self.parts
        for status in parts.jobs.statuses:
            parts.jobs.cancel(status.id)
        self.wait(lambda: not parts.jobs.is_busy)
        self.letter("S")
        for _ in range(2):
            self.key(Qt.Key.Key_Escape)
        self.letter("H", CONTROL)
        parts.of(Review).close()
        for _ in range(_MOST_STEPS):
            if self._changes_made() <= self._changes:
                break
            self.letter("Z", CONTROL)
        while parts.template_panel.list.current is not None:
            parts.template_panel.list.remove()
        parts.message_bar.hide()
        parts.status_line.clearMessage()
        for panel in (parts.layers_panel, parts.feature_table):
            for line in panel.findChildren(QLineEdit):
                line.clear()
        for switch in ("side-by-side", "show-rejected"):
            if parts.window.actions_by_id[switch].isChecked():
                self.act(switch)
        self._restore_views()
        parts.window.restoreState(self._docks)
        parts.window.resize(self._size)

    def _restore_views(self) -> None:
        """Let each view look at the street as it did at first."""
        parts = self.parts
        self.act("show-intensity")
        parts.document.shared.view_settings.orient_image(ImageOrientation())
        parts.section_view.set_pinned(False)
        parts.section_view.use_settings(SectionSettings())
        parts.camera_view.set_stereo(False)
        parts.camera_panel.show_calibration(False)  # noqa: FBT003 - a slot
        parts.image_views.arrange(())
        parts.scene_view.clipping.choose(ClipChoice.EVERYTHING)
        parts.window.area.restore(self._area)
        self.act("everything")

    def leave(self) -> None:
        """Close the window for good."""
        self.parts.window.close_at_once()
        self.parts.window.deleteLater()

    @staticmethod
    def pause() -> None:
        """Let some time go by in another thread."""
        sleep(_PULSE_MS / 1000)

    def wait(self, condition: Callable[[], bool], longest_ms: int = _LONGEST_MS) -> bool:
        """Let the window live until something is so; says whether it came to be."""
        end = monotonic() + longest_ms / 1000
        while not condition():
            if monotonic() > end:
                return False
            _live(_PULSE_MS)
        return True

    def settle(self) -> None:
        """Let the window live until its picture doesn't change any more."""
        shown: list[QImage] = []

        def rests() -> bool:
            shown.append(self._grab(self.parts.window))
            scene = self.parts.scene_view
            if scene.isVisible() and scene.cloud is not None and not scene.is_settled:
                return False
            return len(shown) > _SAME_TIMES and all(
                one == shown[-1] for one in shown[-1 - _SAME_TIMES :]
            )

        self.wait(rests, _REST_MS)

    def shoot(self, name: str) -> None:
        """Keep what the window shows, and what stands before it; its second window by itself."""
        self.settle()
        docks, window = self.parts.view_docks, self.parts.window
        if docks.is_apart:
            self._keep(self._grab(docks), f"{name}-beside")
            docks.hide()
            self.settle()
        self._keep(self._grab(window), name)
        if docks.is_apart:
            docks.show()

    def _keep(self, picture: QImage, name: str) -> None:
        path = self.out / f"{name}-{self.parts.language}.png"
        if not picture.save(str(path)):
            message = f"{path} can't be written"
            raise OSError(message)

    def dialog(self, kind: type[WidgetT]) -> WidgetT:
        """The form that is open, made active."""
        found = [
            one
            for one in QApplication.topLevelWidgets()
            if isinstance(one, kind) and one.isVisible()
        ]
        if not found:
            message = f"no {kind.__name__} is open"
            raise LookupError(message)
        found[-1].activateWindow()
        QTest.qWaitForWindowActive(found[-1])
        return found[-1]

    def tidy(self) -> None:
        """Close what a scene has opened, and let everything be as before it."""
        self.mouse.let_go()
        popup = QApplication.activePopupWidget()
        while popup is not None:
            popup.close()
            popup = QApplication.activePopupWidget()
        for one in QApplication.topLevelWidgets():
            if isinstance(one, QDialog) and one.isVisible():
                one.close()
        window = self.parts.window
        QCursor.setPos(window.geometry().bottomRight())
        window.activateWindow()
        QTest.qWaitForWindowActive(window)
        self.view.setFocus()

    def _changes_made(self) -> int:
        """How many changes of the map could be undone."""
        project = self.parts.document.project
        return 0 if project is None else project.history.position

    def _grab(self, window: QWidget) -> QImage:
        at = window.frameGeometry()
        screen = QGuiApplication.primaryScreen()
        picture = screen.grabWindow(0, at.x(), at.y(), at.width(), at.height())
        return picture.toImage()


def _live(milliseconds: int) -> None:
    """Let the window live for a while; other threads as well, which QTest's waiting holds up."""
    loop = QEventLoop()
    QTimer.singleShot(milliseconds, loop.quit)
    loop.exec()


def along(line: list[Position], share: float) -> Position:
    """The place at a share of a line's length."""
    legs = [math.dist(a, b) for a, b in itertools.pairwise(line)]
    left = share * sum(legs)
    for (begin, end), leg in zip(itertools.pairwise(line), legs, strict=True):
        if left <= leg:
            part = left / leg
            x, y, z = ((1 - part) * a + part * b for a, b in zip(begin, end, strict=True))
            return x, y, z
        left -= leg
    return line[-1]
