"""PlaneViewport: which part of the plane a view shows, and how large."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from PySide6.QtCore import QRectF
from PySide6.QtGui import QTransform

from processing.core.arrays import Floats

_LEAST_SCALE, _MOST_SCALE = 1e-4, 1e4
_FILLED = 0.9


@dataclass(frozen=True)
class PlaneViewport:
    """Places of a plane to pixels of the widget and back; every change gives a new one.

    Attributes
    ----------
    width, height : float
        Of the widget, pixels.
    scale : float
        Pixels per unit of the plane, to the right.
    centre : tuple of float
        What is in the middle of the widget, plane coordinates.
    exaggeration : float
        So many times larger downwards than to the right.
    """

    width: float = 1.0
    height: float = 1.0
    scale: float = 1.0
    centre: tuple[float, float] = (0.0, 0.0)
    exaggeration: float = 1.0

    @property
    def scale_y(self) -> float:
        """Pixels per unit of the plane, downwards."""
        return self.scale * self.exaggeration

    @property
    def seen(self) -> QRectF:
        """The part of the plane that is shown."""
        left, top = self.to_plane(0.0, 0.0)
        return QRectF(left, top, self.width / self.scale, self.height / self.scale_y)

    def transform(self) -> QTransform:
        """The same as :meth:`to_screen` for Qt's shapes."""
        x, y = self.centre
        return QTransform(
            self.scale,
            0.0,
            0.0,
            self.scale_y,
            self.width / 2 - x * self.scale,
            self.height / 2 - y * self.scale_y,
        )

    @property
    def middle(self) -> tuple[float, float]:
        """The middle of the widget, pixels."""
        return self.width / 2, self.height / 2

    def to_screen(self, positions: Floats) -> Floats:
        """(..., 2) plane coordinates to (..., 2) pixels; NaN stays NaN."""
        scales = np.array([self.scale, self.scale_y])
        middle = np.array([self.width / 2, self.height / 2])
        pixels: Floats = (positions - np.array(self.centre)) * scales + middle
        return pixels

    def to_plane(self, x: float, y: float) -> tuple[float, float]:
        """Plane coordinates of a pixel."""
        return (
            (x - self.width / 2) / self.scale + self.centre[0],
            (y - self.height / 2) / self.scale_y + self.centre[1],
        )

    def zoomed(self, factor: float, x: float, y: float) -> PlaneViewport:
        """Larger or smaller; what is at the pixel stays there."""
        before = self.to_plane(x, y)
        scaled = replace(self, scale=_limit_scale(self.scale * factor))
        after = scaled.to_plane(x, y)
        return scaled.centred_on(
            scaled.centre[0] + before[0] - after[0], scaled.centre[1] + before[1] - after[1]
        )

    def panned(self, dx: float, dy: float) -> PlaneViewport:
        """The picture pushed by so many pixels to the right and down."""
        x, y = self.centre
        return self.centred_on(x - dx / self.scale, y - dy / self.scale_y)

    def centred_on(self, x: float, y: float) -> PlaneViewport:
        """With a place of the plane in the middle."""
        return replace(self, centre=(float(x), float(y)))

    def sized(self, width: float, height: float) -> PlaneViewport:
        """The same middle in a widget of another size."""
        return replace(self, width=max(float(width), 1.0), height=max(float(height), 1.0))

    def holding(self, left: float, top: float, right: float, bottom: float) -> PlaneViewport:
        """A rectangle of the plane in the middle; made smaller only if it wouldn't fit."""
        fitted = self._fitting(right - left, bottom - top)
        scaled = replace(self, scale=min(self.scale, fitted))
        return scaled.centred_on((left + right) / 2, (top + bottom) / 2)

    def fitted(self, left: float, top: float, right: float, bottom: float) -> PlaneViewport:
        """A rectangle of the plane in the middle, as large as it fits with a margin."""
        scaled = replace(self, scale=self._fitting(right - left, bottom - top))
        return scaled.centred_on((left + right) / 2, (top + bottom) / 2)

    def filled_by(self, extent: QRectF, share: float) -> PlaneViewport:
        """A rectangle of the plane in the middle, as large as it fits into a share of the sides."""
        scaled = replace(self, scale=self._fitting(extent.width(), extent.height(), share))
        return scaled.centred_on(extent.center().x(), extent.center().y())

    def shows(self, x: float, y: float, share: float = 1.0) -> bool:
        """Whether a place of the plane is in the widget, or in its middle part of this share."""
        ((right, down),) = self.to_screen(np.array([[x, y]])).tolist()
        is_across = bool(abs(right / self.width - 0.5) <= share / 2)
        return is_across and bool(abs(down / self.height - 0.5) <= share / 2)

    def _fitting(self, wide: float, high: float, share: float = _FILLED) -> float:
        fits_x = share * self.width / max(wide, 1e-6)
        fits_y = share * self.height / max(high * self.exaggeration, 1e-6)
        return _limit_scale(min(fits_x, fits_y))


def _limit_scale(scale: float) -> float:
    return min(max(scale, _LEAST_SCALE), _MOST_SCALE)
