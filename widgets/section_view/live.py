"""LiveLine: the line that the mouse is over in any view, told now and then while it moves."""

from __future__ import annotations

from PySide6.QtCore import QObject, QTimer, Signal
from PySide6.QtWidgets import QWidget

from widgets.section_view.lines import SectionLines
from widgets.shared.cursor import Cursor, PickedPosition

_EVERY_MS = 25


class LiveLine(QObject):
    """Looks for the line under the mouse at most every 25 ms.

    Parameters
    ----------
    cursor : Cursor
    lines : SectionLines
    owner : QWidget
        While it is hidden nothing is looked for.

    Attributes
    ----------
    is_on : bool
        Whether anything is told.

    Signals
    -------
    found(standing: Standing)
        A section through what the mouse is over; nothing is told over no line.
    """

    found = Signal(object)

    def __init__(self, cursor: Cursor, lines: SectionLines, owner: QWidget) -> None:
        super().__init__(owner)
        self._lines = lines
        self._owner = owner
        self._position: PickedPosition | None = None
        self.is_on = True
        self._wait = QTimer(self, singleShot=True, interval=_EVERY_MS)
        self._wait.timeout.connect(self._on_wait_timeout)
        cursor.hovered.connect(self._on_cursor_hovered)

    def stop(self) -> None:
        """Forget where the mouse was."""
        self._position = None
        self._wait.stop()

    def _on_cursor_hovered(self, position: PickedPosition | None) -> None:
        if position is None or not self.is_on or not self._owner.isVisible():
            return
        self._position = position
        if not self._wait.isActive():
            self._wait.start()

    def _on_wait_timeout(self) -> None:
        position, self._position = self._position, None
        standing = None if position is None else self._lines.under(position)
        if standing is not None:
            self.found.emit(standing)
