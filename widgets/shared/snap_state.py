"""SnapState: what clicks snap to, where the next one would land, and the working plane."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np
from PySide6.QtCore import QObject, Signal

from processing.core.text import Text
from processing.map.feature import Position


class SnapMode(Enum):
    """What a click can be drawn to."""

    VERTEX = "vertex"
    CROSSING = "crossing"
    LINE = "line"
    EXTENSION = "extension"
    LOWEST = "lowest"
    HIGHEST = "highest"
    EDGE = "edge"


SNAP_NAMES: Mapping[SnapMode, Text] = {
    SnapMode.VERTEX: Text("vertex", "頂点"),
    SnapMode.CROSSING: Text("crossing", "交点"),
    SnapMode.LINE: Text("line", "線上"),
    SnapMode.EXTENSION: Text("extension", "延長線"),
    SnapMode.LOWEST: Text("lowest point", "最低点"),
    SnapMode.HIGHEST: Text("highest point", "最高点"),
    SnapMode.EDGE: Text("edge", "段差の縁"),
}

USUAL_MODES = frozenset(
    {SnapMode.VERTEX, SnapMode.CROSSING, SnapMode.LINE, SnapMode.EXTENSION, SnapMode.EDGE}
)


@dataclass(frozen=True)
class SnapMark:
    """Where a click would land that is not simply the point under the mouse."""

    xyz: Position
    mode: SnapMode


@dataclass(frozen=True)
class WorkingPlane:
    """A plane on which vertices are put where measured points mislead.

    Attributes
    ----------
    through : Position
        A place on it.
    normal : tuple of float
        Unit vector, upwards.
    """

    through: Position
    normal: Position = (0.0, 0.0, 1.0)

    def height_at(self, easting: float, northing: float) -> float:
        """Height of the plane above or below a place."""
        east, north, up = self.normal
        x, y, z = self.through
        return z - (east * (easting - x) + north * (northing - y)) / up

    def meets(self, origin: Position, direction: Position) -> Position | None:
        """Where a ray meets it; None where it runs along or away from the plane."""
        normal, start, way = np.array(self.normal), np.array(origin), np.array(direction)
        steepness = float(normal @ way)
        if abs(steepness) < 1e-3 * float(np.linalg.norm(way)):
            return None
        share = float(normal @ (np.array(self.through) - start)) / steepness
        if share <= 0:
            return None
        east, north, up = (start + share * way).tolist()
        return east, north, up


class SnapState(QObject):
    """Which snaps are on, and what is shown before the click; setting the same emits nothing."""

    modes_changed = Signal()
    mark_changed = Signal()
    plane_changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._modes = USUAL_MODES
        self._mark: SnapMark | None = None
        self._plane: WorkingPlane | None = None

    @property
    def modes(self) -> frozenset[SnapMode]:
        """What clicks snap to."""
        return self._modes

    @property
    def mark(self) -> SnapMark | None:
        """Where a click would land; None when it is the point under the mouse."""
        return self._mark

    @property
    def plane(self) -> WorkingPlane | None:
        """The plane that clicks land on; None when they land on measured points."""
        return self._plane

    def turn(self, mode: SnapMode, *, is_on: bool) -> None:
        """Switch one mode."""
        self.choose_modes(self._modes | {mode} if is_on else self._modes - {mode})

    def choose_modes(self, modes: frozenset[SnapMode]) -> None:
        """Snap to exactly these."""
        if modes != self._modes:
            self._modes = modes
            self.modes_changed.emit()

    def show_mark(self, mark: SnapMark | None) -> None:
        """Show in every view where a click would land."""
        if mark != self._mark:
            self._mark = mark
            self.mark_changed.emit()

    def work_on(self, plane: WorkingPlane | None) -> None:
        """Put vertices on a plane from now on; None: on measured points."""
        if plane != self._plane:
            self._plane = plane
            self.plane_changed.emit()
