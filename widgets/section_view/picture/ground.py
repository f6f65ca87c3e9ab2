"""GroundPainter: the points of a section as a picture, made again only when something changed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF
from PySide6.QtGui import QImage, QPainter

from processing.section.raster import paint_points
from widgets.plane_view.viewport import PlaneViewport
from widgets.section_view.picture.feed import SectionPicture
from widgets.section_view.picture.projection import SectionProjection

BACKGROUND = (16, 19, 24)

_LEAST_PX, _MOST_PX = 1.0, 8.0
_GROUND_WITHIN_M = 4.0
_GROUND_PERCENT = 25


@dataclass(frozen=True)
class _Made:
    picture: SectionPicture
    viewport: PlaneViewport
    side_px: int
    ratio: float


class GroundPainter:
    """Paints points as squares, those nearest to the plane in front."""

    def __init__(self) -> None:
        self._made: _Made | None = None
        self._image = QImage()

    def paint(
        self, painter: QPainter, picture: SectionPicture, viewport: PlaneViewport, size_px: float
    ) -> None:
        """Paint the points of a picture.

        Parameters
        ----------
        size_px : float
            Side of a point's square in pixels of the window.
        """
        ratio = painter.device().devicePixelRatioF()
        side_px = round(min(max(size_px, _LEAST_PX), _MOST_PX) * ratio)
        wanted = _Made(picture, viewport, max(side_px, 1), ratio)
        made = self._made
        is_same = (
            made is not None
            and made.picture is picture
            and ((made.viewport, made.side_px, made.ratio) == (viewport, wanted.side_px, ratio))
        )
        if not is_same:
            self._image = _image_of(wanted)
            self._made = wanted
        painter.drawImage(QPointF(0.0, 0.0), self._image)


def _image_of(wanted: _Made) -> QImage:
    viewport, ratio = wanted.viewport, wanted.ratio
    width, height = max(round(viewport.width * ratio), 1), max(round(viewport.height * ratio), 1)
    out = np.empty((height, width, 3), np.uint8)
    out[:] = BACKGROUND
    section = wanted.picture.section
    positions = SectionProjection(wanted.picture.request.cut).on_plane(section)
    pixels = np.ascontiguousarray(viewport.to_screen(positions) * ratio)
    distances = np.ascontiguousarray(section[:, 2])
    paint_points(pixels, distances, wanted.picture.colours, wanted.side_px, out)
    image = QImage(out.data, width, height, 3 * width, QImage.Format.Format_RGB888).copy()
    image.setDevicePixelRatio(ratio)
    return image


def ground_y(projection: SectionProjection, picture: SectionPicture) -> float:
    """Where the ground about the middle is on the plane; the middle where no points are."""
    section = picture.section
    near = section[np.abs(section[:, 0]) <= _GROUND_WITHIN_M, 1]
    if not near.size:
        return 0.0
    return projection.cut.middle[2] - float(np.percentile(near, _GROUND_PERCENT))
