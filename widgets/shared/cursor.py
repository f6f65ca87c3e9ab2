"""Cursor: the one point all views look at."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QObject, Signal

from processing.map.feature import PointReference, Position


@dataclass(frozen=True)
class PickedPosition:
    """A place in the project's space, and the measured point that is there, if one is.

    Attributes
    ----------
    xyz : tuple of float
        Easting, northing, height in metres, project CRS.
    measured : PointReference or None
    is_occluded : bool
        It was put where no measured point is.
    """

    xyz: Position
    measured: PointReference | None = None
    is_occluded: bool = False


class Cursor(QObject):
    """The place all views show, and the place the mouse is over.

    Setting what is already set emits nothing.
    """

    moved = Signal(object)  # Place
    hovered = Signal(object)  # Place or None

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._position: PickedPosition | None = None
        self._hover: PickedPosition | None = None

    @property
    def position(self) -> PickedPosition | None:
        """Where the cursor is; None before anything was clicked."""
        return self._position

    @property
    def hover(self) -> PickedPosition | None:
        """What the mouse is over; None outside the views and over empty pixels."""
        return self._hover

    def move_to(self, position: PickedPosition) -> None:
        """Put the cursor somewhere; every view follows."""
        if position != self._position:
            self._position = position
            self.moved.emit(position)

    def hover_over(self, position: PickedPosition | None) -> None:
        """Tell what the mouse is over."""
        if position != self._hover:
            self._hover = position
            self.hovered.emit(position)

    def clear(self) -> None:
        """Forget both places, when a project is closed."""
        self._position = None
        self.hover_over(None)
