"""Mosaic: the tiles in the window as one picture, scaled as one, so that no seam shows."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QPoint, QRect, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QTransform

from processing.image.search.tile_choice import tiles_in_window
from processing.image.tiles.tiles import TileKey
from widgets.image_view.orientation.oriented_image import OrientedImage, Span
from widgets.image_view.orientation.viewport import Viewport
from widgets.image_view.tile_images import THINNINGS, TileImages
from widgets.shared.image_orientation import ImageOrientation

_UNKNOWN = QColor("#14161a")
_MARGIN = 2.0  # pixels beyond the window's edge, for the interpolation


@dataclass(frozen=True)
class _Grid:
    """Tiles of one level that form a rectangle.

    Attributes
    ----------
    rows, columns : range
        Of tiles.
    thinning : int
        So many columns of a tile are one pixel of the mosaic.
    """

    picture: OrientedImage
    level: int
    rows: range
    columns: range
    thinning: int

    @property
    def step(self) -> int:
        """Rows of the image per pixel of the mosaic."""
        return 1 << self.level

    @property
    def across_step(self) -> int:
        """Columns of the image per pixel of the mosaic."""
        return self.step * self.thinning

    def beside(self) -> list[TileKey]:
        """The tiles before and behind along the rows, where a drag leads next."""
        shape = self.picture.image.pyramid.shape(self.level)
        return [
            TileKey(self.level, row, column)
            for row in (self.rows[0] - 1, self.rows[-1] + 1)
            if 0 <= row < shape[0]
            for column in self.columns
        ]

    def area_of(self, key: TileKey) -> tuple[int, int, int, int]:
        """First row, first column, rows and columns of the image, rounded up to whole pixels."""
        rows, columns = self.picture.image.pyramid.rows_columns(key)
        return (
            rows.start,
            columns.start,
            -(-len(rows) // self.step) * self.step,
            -(-len(columns) // self.across_step) * self.across_step,
        )

    @property
    def span(self) -> Span:
        """What the mosaic covers, picture coordinates."""
        first = self.area_of(TileKey(self.level, self.rows[0], self.columns[0]))
        last = self.area_of(TileKey(self.level, self.rows[-1], self.columns[-1]))
        return self.picture.span_of(
            first[0], first[1], last[0] + last[2] - first[0], last[1] + last[3] - first[1]
        )

    def position(self, key: TileKey) -> QRect:
        """Where a tile is in the mosaic."""
        whole, part = self.span, self.picture.span_of(*self.area_of(key))
        along, across = self.step, self.across_step
        step_u, step_v = (along, across) if self.picture.rows_go_right else (across, along)
        return QRect(
            QPoint(
                round((part.left - whole.left) / step_u), round((part.top - whole.top) / step_v)
            ),
            QSize(
                round((part.right - part.left) / step_u), round((part.bottom - part.top) / step_v)
            ),
        )


class Mosaic:
    """Keeps the tiles of a window put together, and paints them.

    Parameters
    ----------
    images : TileImages
    """

    def __init__(self, images: TileImages) -> None:
        self._images = images
        self._made_for: tuple[_Grid, int] | None = None
        self._whole = QImage()
        self._turned = QImage()
        self._turned_for: tuple[tuple[_Grid, int], ImageOrientation] | None = None

    def paint(self, painter: QPainter, picture: OrientedImage, viewport: Viewport) -> bool:
        """Paint what the viewport shows; says whether all of it is as sharp as it will be."""
        rows, columns = picture.rows_columns(viewport.span)
        if not rows or not columns:
            return True
        zooms = viewport.zoom_u, viewport.zoom_v
        along, across = zooms if picture.rows_go_right else zooms[::-1]
        keys = tiles_in_window(picture.image.pyramid, rows, columns, along)
        grid = _Grid(
            picture,
            keys[0].level,
            range(min(key.row for key in keys), max(key.row for key in keys) + 1),
            range(min(key.column for key in keys), max(key.column for key in keys) + 1),
            _thinning(across * (1 << keys[0].level)),
        )
        found = self._images.images(keys, grid.thinning, grid.beside())
        made_for = grid, self._images.version
        if made_for != self._made_for:
            self._turned = QImage()  # else painting would copy what it shares
            self._compose(grid, keys, found)
            # Coarser tiles that stood in may have been made just now.
            made_for = self._made_for = grid, self._images.version
        if (made_for, viewport.orientation) != self._turned_for:
            self._turned = _turn_image(self._whole, viewport.orientation)
            self._turned_for = made_for, viewport.orientation
        self._paint_part(painter, grid.span, viewport)
        return self._images.is_complete

    def _compose(self, grid: _Grid, keys: list[TileKey], found: dict[TileKey, QImage]) -> None:
        corners = [
            grid.position(TileKey(grid.level, row, column))
            for row in (grid.rows[0], grid.rows[-1])
            for column in (grid.columns[0], grid.columns[-1])
        ]
        size = QSize(
            max(corner.right() for corner in corners) + 1,
            max(corner.bottom() for corner in corners) + 1,
        )
        if self._whole.size() != size:
            self._whole = QImage(size, QImage.Format.Format_RGB32)
        with QPainter(self._whole) as painter:
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, on=True)
            for key in keys:
                position = grid.position(key)
                if key in found:
                    painter.drawImage(position, found[key])
                else:
                    painter.fillRect(position, _UNKNOWN)
                    self._paint_coarser(painter, grid, key, position)

    def _paint_coarser(self, painter: QPainter, grid: _Grid, key: TileKey, position: QRect) -> None:
        """Paint the part of the next coarser tile that there is a picture of."""
        pyramid = grid.picture.image.pyramid
        part = grid.picture.span_of(*grid.area_of(key))
        ancestor = key
        for _ in range(key.level, pyramid.levels - 1):
            ancestor = pyramid.parent(ancestor)
            image = self._images.available(ancestor)
            if image is not None:
                whole = grid.picture.span_of(*_area_at_own_step(grid.picture, ancestor))
                painter.drawImage(QRectF(position), image, _source(part, whole, image))
                return

    def _paint_part(self, painter: QPainter, whole: Span, viewport: Viewport) -> None:
        """Paint only what is seen: far beyond the window coordinates would overflow."""
        seen = viewport.span
        shown = Span(
            max(whole.left, seen.left - _MARGIN),
            max(whole.top, seen.top - _MARGIN),
            min(whole.right, seen.right + _MARGIN),
            min(whole.bottom, seen.bottom + _MARGIN),
        )
        target, of_whole = viewport.rectangle_of(shown), viewport.rectangle_of(whole)
        scale_x = self._turned.width() / of_whole.width()
        scale_y = self._turned.height() / of_whole.height()
        source = QRectF(
            (target.left() - of_whole.left()) * scale_x,
            (target.top() - of_whole.top()) * scale_y,
            target.width() * scale_x,
            target.height() * scale_y,
        )
        is_smooth = min(viewport.zoom_u, viewport.zoom_v) < 1
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, is_smooth)
        painter.drawImage(target, self._turned, source)


def _turn_image(image: QImage, orientation: ImageOrientation) -> QImage:
    """A picture that goes to the right and down, as it lies on the screen."""
    if orientation.is_vertical:  # u goes up, v to the right
        image = image.transformed(QTransform().rotate(-90.0))
    flips_x = (
        orientation.is_mirrored_across if orientation.is_vertical else orientation.is_reversed_along
    )
    flips_y = (
        orientation.is_reversed_along if orientation.is_vertical else orientation.is_mirrored_across
    )
    sides = [
        side
        for side, flips in (
            (Qt.Orientation.Horizontal, flips_x),
            (Qt.Orientation.Vertical, flips_y),
        )
        if flips
    ]
    for side in sides:
        image = image.flipped(side)
    return image


def _thinning(across_px: float) -> int:
    """The most columns that share a screen pixel anyway."""
    return max(thinning for thinning in THINNINGS if thinning == 1 or thinning * across_px <= 1)


def _area_at_own_step(picture: OrientedImage, key: TileKey) -> tuple[int, int, int, int]:
    rows, columns = picture.image.pyramid.rows_columns(key)
    step = 1 << key.level
    return (
        rows.start,
        columns.start,
        -(-len(rows) // step) * step,
        -(-len(columns) // step) * step,
    )


def _source(part: Span, whole: Span, image: QImage) -> QRectF:
    """The part of a picture that covers the whole, in its pixels."""
    scale_u = image.width() / (whole.right - whole.left)
    scale_v = image.height() / (whole.bottom - whole.top)
    return QRectF(
        (part.left - whole.left) * scale_u,
        (part.top - whole.top) * scale_v,
        (part.right - part.left) * scale_u,
        (part.bottom - part.top) * scale_v,
    )
