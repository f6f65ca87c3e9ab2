"""Cursor: the one point all views look at."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QObject, Signal

from processing.project.feature import PointReference, Position


@dataclass(frozen=True)
class Place:
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
        self._place: Place | None = None
        self._hover: Place | None = None

    @property
    def place(self) -> Place | None:
        """Where the cursor is; None before anything was clicked."""
        return self._place

    @property
    def hover(self) -> Place | None:
        """What the mouse is over; None outside the views and over empty pixels."""
        return self._hover

    def move_to(self, place: Place) -> None:
        """Put the cursor somewhere; every view follows."""
        if place != self._place:
            self._place = place
            self.moved.emit(place)

    def hover_over(self, place: Place | None) -> None:
        """Tell what the mouse is over."""
        if place != self._hover:
            self._hover = place
            self.hovered.emit(place)

    def clear(self) -> None:
        """Forget both places, when a project is closed."""
        self._place = None
        self.hover_over(None)
