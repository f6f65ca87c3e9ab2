"""Sketch: geometry while it is being drawn or dragged, painted by every view."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QObject, Signal

from processing.map.catalogue import Geometry
from processing.map.feature import Position, Vertex


@dataclass(frozen=True)
class Note:
    """A short text at a place: a length, an angle."""

    xyz: Position
    text: str


@dataclass(frozen=True)
class Drawing:
    """What a mouse tool is about to make.

    Attributes
    ----------
    kind : str
        Feature kind, for the colour.
    vertices : tuple of Vertex
        Fixed so far.
    preview : tuple of Vertex
        What the next click would add behind the last vertex; several for curves.
    replaces : str
        Id of the feature that is being edited and therefore not painted itself; or empty.
    notes : tuple of Note
        What is written beside it.
    """

    kind: str
    geometry: Geometry
    vertices: tuple[Vertex, ...]
    preview: tuple[Vertex, ...] = ()
    replaces: str = ""
    notes: tuple[Note, ...] = ()


class Sketch(QObject):
    """The drawing in progress, or none."""

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._drawing: Drawing | None = None

    @property
    def drawing(self) -> Drawing | None:
        """What is being drawn; None when nothing is."""
        return self._drawing

    def show(self, drawing: Drawing | None) -> None:
        """Show a drawing in every view; None takes it away."""
        if drawing != self._drawing:
            self._drawing = drawing
            self.changed.emit()
