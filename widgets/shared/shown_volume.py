"""ShownVolume: the map of change that all views show, and how they show it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

from PySide6.QtCore import QObject, Signal

from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.change_reading import ChangeReading, reading_at
from processing.methods.earthwork.maps.contours import LevelLine
from widgets.shared.cursor import PickedPosition

LEAST_LIMIT_M, MOST_LIMIT_M = 0.01, 100.0


class ContourOf(Enum):
    """What contours are drawn of."""

    NOTHING = "nothing"
    CHANGE = "change"
    BEFORE = "before"
    AFTER = "after"


@dataclass(frozen=True)
class VolumeStyle:
    """How the map of change is shown.

    Attributes
    ----------
    is_shown : bool
    limit_m : float
        Where the outermost classes of colour begin.
    opacity : float
        From 0 to 1, over the points.
    contours : ContourOf
    interval_m : float
        Between contours.
    """

    is_shown: bool = True
    limit_m: float = 1.0
    opacity: float = 0.85
    contours: ContourOf = ContourOf.NOTHING
    interval_m: float = 0.1


class ShownVolume(QObject):
    """One map, or none; setting what is already set emits nothing.

    Signals
    -------
    changed()
        Another map is shown, or none.
    look_changed(look: VolumeStyle)
    contours_changed()
        Other contours are there to be drawn.
    hovered(reading: ChangeReading | None)
        What the map says under the mouse.
    """

    changed = Signal()
    look_changed = Signal(object)
    contours_changed = Signal()
    hovered = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._change: ChangeGrid | None = None
        self._look = VolumeStyle()
        self._contours: tuple[LevelLine, ...] = ()
        self._reading: ChangeReading | None = None
        self._is_exact = False

    @property
    def change(self) -> ChangeGrid | None:
        """The map that is at hand; None without a volume."""
        return self._change

    @property
    def drawn(self) -> ChangeGrid | None:
        """The map that views draw; None where there is none, or it is hidden."""
        return self._change if self._look.is_shown else None

    @property
    def look(self) -> VolumeStyle:
        """How it is shown."""
        return self._look

    @property
    def contours(self) -> tuple[LevelLine, ...]:
        """The lines that are drawn over it; none while it is hidden."""
        return self._contours if self.drawn is not None else ()

    @property
    def reading(self) -> ChangeReading | None:
        """What the map says under the mouse."""
        return self._reading

    def show(self, change: ChangeGrid | None, limit_m: float | None = None) -> None:
        """Show this map from now on; None: none.

        Parameters
        ----------
        limit_m : float or None
            Where the outermost classes begin; None: as they are.
        """
        if change is self._change:
            return
        self._change = change
        self._contours = ()
        if limit_m is not None:
            self.use_look(replace(self._look, limit_m=limit_m))
        self.changed.emit()
        self.contours_changed.emit()
        self._read(None)

    def use_look(self, look: VolumeStyle) -> None:
        """Show it like this from now on."""
        limit_m = min(max(look.limit_m, LEAST_LIMIT_M), MOST_LIMIT_M)
        look = replace(look, limit_m=limit_m, opacity=min(max(look.opacity, 0.0), 1.0))
        if look != self._look:
            self._look = look
            self.look_changed.emit(look)

    def take_contours(self, change: ChangeGrid, contours: Sequence[LevelLine]) -> None:
        """Draw these, unless another map is shown by now."""
        if change is self._change:
            self._contours = tuple(contours)
            self.contours_changed.emit()

    def hover_over(self, spot: tuple[float, float] | None) -> None:
        """Read the map below the mouse of a view that shows it as such; None: it has left.

        Parameters
        ----------
        spot : (float, float) or None
            Easting and northing, m, project CRS.
        """
        self._is_exact = spot is not None
        self._read(spot)

    def hover_over_point(self, position: PickedPosition | None) -> None:
        """Read it where the mouse of any other view is over a measured point."""
        if not self._is_exact:
            self._read(None if position is None else position.xyz[:2])

    def _read(self, spot: tuple[float, float] | None) -> None:
        change = self.drawn
        reading = None if change is None or spot is None else reading_at(change, *spot)
        if reading != self._reading:
            self._reading = reading
            self.hovered.emit(reading)
