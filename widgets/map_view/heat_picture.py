"""HeatPicture: the map of change as pictures, coloured again only where something changed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QImage, QPainter, QPixmap

from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.heat_map import change_colours
from widgets.plane_view.viewport import PlaneViewport

MOST_CELLS = 4_000_000
"""Of one picture: some more than a large screen has pixels."""

_MARGIN_SHARE = 0.25
UNMEASURED = QColor(20, 22, 26, 150)
"""Of the slanting lines over what was filled in."""


@dataclass(frozen=True)
class _Part:
    """Some of the cells, every so many of them.

    Attributes
    ----------
    rows, columns : (int, int)
        The first one and the one behind the last.
    step : int
    """

    rows: tuple[int, int]
    columns: tuple[int, int]
    step: int

    def holds(self, other: _Part) -> bool:
        """Whether the other's cells are among these, as many of them."""
        return (
            self.step == other.step
            and self.rows[0] <= other.rows[0]
            and self.rows[1] >= other.rows[1]
            and self.columns[0] <= other.columns[0]
            and self.columns[1] >= other.columns[1]
        )


@dataclass(frozen=True, eq=False)
class _Made:
    """A part as pictures; what was not measured is a mask of its own."""

    change: ChangeGrid
    limit_m: float
    part: _Part
    colours: QImage
    unmeasured: QImage | None


class HeatPicture:
    """Paints the map of change below features and over points."""

    def __init__(self) -> None:
        self._made: _Made | None = None

    def paint(
        self,
        painter: QPainter,
        viewport: PlaneViewport,
        change: ChangeGrid,
        *,
        limit_m: float,
        opacity: float,
    ) -> None:
        """Paint what is seen of a map.

        Parameters
        ----------
        limit_m : float
            Where the outermost classes of colour begin.
        opacity : float
        """
        part = _seen_part(change, viewport, painter.device().devicePixelRatioF())
        if part is None:
            return
        made = self._made
        is_same = made is not None and made.change is change and made.limit_m == limit_m
        if made is None or not is_same or not made.part.holds(part):
            made = self._made = _made_of(change, limit_m, _grow_part(part, change))
        target = _on_screen(change, made.part, viewport)
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, on=False)
        painter.setOpacity(opacity)
        painter.drawImage(target, made.colours)
        painter.restore()
        if made.unmeasured is not None:
            _paint_hatched(painter, target, made.unmeasured, viewport)


def _paint_hatched(
    painter: QPainter, target: QRectF, mask: QImage, viewport: PlaneViewport
) -> None:
    """Slanting lines of the screen's own width over the cells of a mask."""
    ratio = painter.device().devicePixelRatioF()
    lines = QPixmap(round(viewport.width * ratio), round(viewport.height * ratio))
    lines.setDevicePixelRatio(ratio)
    lines.fill(Qt.GlobalColor.transparent)
    with QPainter(lines) as drawn:
        drawn.fillRect(
            QRectF(0, 0, viewport.width, viewport.height),
            QBrush(UNMEASURED, Qt.BrushStyle.BDiagPattern),
        )
        # Nothing of the lines is left outside the picture either.
        drawn.setCompositionMode(QPainter.CompositionMode.CompositionMode_DestinationIn)
        with_nothing = QPixmap(lines.size())
        with_nothing.setDevicePixelRatio(ratio)
        with_nothing.fill(Qt.GlobalColor.transparent)
        with QPainter(with_nothing) as masked:
            masked.drawImage(target, mask)
        drawn.drawPixmap(0, 0, with_nothing)
    painter.drawPixmap(0, 0, lines)


def _seen_part(change: ChangeGrid, viewport: PlaneViewport, ratio: float) -> _Part | None:
    """The cells in the window, not many more than it has pixels; None: none is there."""
    grid, seen = change.grid, viewport.seen
    west, south = grid.origin[:2].tolist()
    columns = _between(seen.left() - west, seen.right() - west, grid.size_m, grid.columns)
    # The plane's y points south.
    rows = _between(-seen.bottom() - south, -seen.top() - south, grid.size_m, grid.rows)
    if columns is None or rows is None:
        return None
    step = max(1, int(1.0 / (viewport.scale * ratio * grid.size_m)))
    return _Part(rows, columns, step)


def _between(low_m: float, high_m: float, size_m: float, count: int) -> tuple[int, int] | None:
    first = max(int(np.floor(low_m / size_m)), 0)
    end = min(int(np.ceil(high_m / size_m)), count)
    return (first, end) if first < end else None


def _grow_part(part: _Part, change: ChangeGrid) -> _Part:
    """The whole map where that isn't too much; else some more on every side."""
    grid, step = change.grid, part.step
    if grid.rows * grid.columns <= MOST_CELLS * step * step:
        return _Part((0, grid.rows), (0, grid.columns), step)

    def wider(ends: tuple[int, int], count: int) -> tuple[int, int]:
        more = int((ends[1] - ends[0]) * _MARGIN_SHARE)
        # On the same cells, wherever the window is.
        return max(ends[0] - more, 0) // step * step, min(ends[1] + more, count)

    return _Part(wider(part.rows, grid.rows), wider(part.columns, grid.columns), step)


def _made_of(change: ChangeGrid, limit_m: float, part: _Part) -> _Made:
    cells = slice(*part.rows, part.step), slice(*part.columns, part.step)
    values = change.change_m[cells][::-1]  # a picture begins in the north
    colours = _image_of(change_colours(values, limit_m), QImage.Format.Format_RGBA8888)
    is_filled = ~change.is_measured[cells][::-1] & np.isfinite(values)
    unmeasured = None
    if is_filled.any():
        mask = np.where(is_filled, 255, 0).astype(np.uint8)
        unmeasured = _image_of(mask, QImage.Format.Format_Alpha8)
    return _Made(change, limit_m, part, colours, unmeasured)


def _image_of(pixels: NDArray[np.uint8], form: QImage.Format) -> QImage:
    pixels = np.ascontiguousarray(pixels)
    rows, columns = pixels.shape[:2]
    # Copied: the image only borrows the memory otherwise.
    return QImage(pixels.data, columns, rows, pixels.strides[0], form).copy()


def _on_screen(change: ChangeGrid, part: _Part, viewport: PlaneViewport) -> QRectF:
    """Where a part's picture lies in the window; its last pixel may reach over the map's edge."""
    size_m, step = change.grid.size_m, part.step
    west, south = change.grid.origin[:2].tolist()
    wide = -(-(part.columns[1] - part.columns[0]) // step) * step * size_m
    high = -(-(part.rows[1] - part.rows[0]) // step) * step * size_m
    left, bottom = west + part.columns[0] * size_m, -(south + part.rows[0] * size_m)
    return viewport.transform().mapRect(QRectF(left, bottom - high, wide, high))
