"""MouseTool: one gesture of the hand, the same in every view, because it works on hits.

A view turns pixels into hits and passes them to the current tool; the tool shows a sketch while it
is at work and emits a change when the gesture ends. It never knows which view was clicked.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Qt, Signal

from processing.map.feature import Position, Vertex
from processing.section.cut import Cut
from widgets.shared.cursor import PickedPosition


class DragShape(Enum):
    """What a drag with the left button draws in the view itself."""

    NONE = "none"
    BOX = "box"
    LASSO = "lasso"


@dataclass(frozen=True)
class Ray:
    """A line of sight, project CRS: of the eye in 3D, of the laser in the image.

    Attributes
    ----------
    slab : Cut or None
        The slab that it goes through at right angles, in a section.
    """

    origin: Position
    direction: Position
    slab: Cut | None = None


@dataclass(frozen=True)
class Hit:
    """What lies under the mouse in a view.

    Attributes
    ----------
    position : PickedPosition or None
        The measured point there; None over nothing.
    feature : str
        Id of the feature under the mouse, or empty.
    vertex : int
        Index of that feature's vertex under the mouse, or −1.
    segment : int
        Index of that feature's segment under the mouse (from vertex i to i + 1), or −1.
    modifiers : Qt.KeyboardModifier
    reach_m : float
        How far the circle about the mouse reaches on the ground; 0 where it isn't known.
    ray : Ray or None
        The line of sight through the pixel, whether a point is there or not.
    """

    position: PickedPosition | None
    feature: str = ""
    vertex: int = -1
    segment: int = -1
    modifiers: Qt.KeyboardModifier = field(default=Qt.KeyboardModifier.NoModifier)
    reach_m: float = 0.0
    ray: Ray | None = None

    def as_vertex(self) -> Vertex | None:
        """The vertex that a click here makes; None over nothing."""
        position = self.position
        return (
            None
            if position is None
            else Vertex(position.xyz, position.measured, position.is_occluded)
        )


@dataclass(frozen=True)
class EnclosedHits:
    """What a rectangle or a lasso that was drawn in a view holds.

    Attributes
    ----------
    features : frozenset of str
        Ids of the features that lie wholly inside.
    points : mapping of str to (n,) int64
        Drive id to measured points inside that are drawn.
    modifiers : Qt.KeyboardModifier
    find_every : callable or None
        Looks up what :meth:`every` gives; None where all points inside are drawn.
    """

    features: frozenset[str]
    points: Mapping[str, NDArray[np.int64]]
    modifiers: Qt.KeyboardModifier = field(default=Qt.KeyboardModifier.NoModifier)
    find_every: Callable[[], Mapping[str, NDArray[np.int64]]] | None = None

    def every(self) -> Mapping[str, NDArray[np.int64]]:
        """All measured points inside, drawn or not, but for those that a view clips off.

        Looked up when asked, with the picture as it was when the outline was drawn.

        Returns
        -------
        mapping of str to (n,) int64
            Drive id to rising indices; a drive without points inside is missing.
        """
        return self.points if self.find_every is None else self.find_every()


class MouseTool(QObject):
    """Base of all mouse tools; a subclass fills the hooks it needs.

    Signals
    -------
    change_requested(label: Text, change: Change)
        The gesture is complete.
    finished()
        The tool wants the pointer back (Escape with nothing being drawn).
    reported(text: Text)
        A line for the status bar.
    """

    change_requested = Signal(object, object)
    finished = Signal()
    reported = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._is_leaving = False

    def press(self, hit: Hit) -> None:
        """The left button went down."""

    def move(self, hit: Hit) -> None:
        """The mouse moved, button up or down."""

    def release(self, hit: Hit) -> None:
        """The left button went up."""

    @property
    def snaps(self) -> bool:
        """Whether a hit now is drawn to vertices, lines and points of note."""
        return False

    @property
    def snaps_to_edges(self) -> bool:
        """Whether edges of the cloud count among them; not for what stands by itself."""
        return False

    @property
    def ctrl_frees(self) -> bool:
        """Whether Ctrl means this very point; where it means something else, hits snap."""
        return True

    @property
    def last_vertex(self) -> Vertex | None:
        """From where the next segment starts; None when none does."""
        return None

    @property
    def is_busy(self) -> bool:
        """Whether a gesture is under way that the right button would end."""
        return False

    def drag_shape(self, hit: Hit) -> DragShape:  # noqa: ARG002 - asked by the view
        """What a drag that starts at this hit draws; asked after :meth:`press`."""
        return DragShape.NONE

    def choose_box(self, boxed: EnclosedHits) -> None:
        """A rectangle or a lasso was drawn; comes in place of :meth:`release`."""

    def complete(self) -> None:
        """Right button, Enter or double click: end the gesture and keep it."""

    def settle(self) -> None:
        """Another tool is taken: keep what is whole, drop what isn't."""
        self.put_down()

    def step_back(self) -> None:
        """Backspace: take back the last vertex."""

    def leave(self) -> None:
        """Escape: drop the gesture; with nothing being drawn, give the hand back."""
        if self.is_busy:
            self.put_down()
        elif not self._is_leaving:
            # Whoever takes the hand back may tell this tool to leave in turn.
            self._is_leaving = True
            self.finished.emit()
            self._is_leaving = False

    def put_down(self) -> None:
        """Drop the gesture and say nothing."""

    def take_back(self) -> None:
        """The change that was just asked for was refused: what was drawn is at hand again."""

    def forget(self) -> None:
        """The project is closed: nothing that was made in it comes back."""
        self.put_down()

    def delete(self) -> None:
        """Delete: remove what is chosen."""
