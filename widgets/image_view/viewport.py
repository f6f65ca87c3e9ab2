"""Viewport: which part of the picture the window shows, and how large."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QTransform

from widgets.image_view.picture import Span

Floats = NDArray[np.float64]

_MOST_ZOOM = 64.0
_LEAST_SHARE = 0.3  # of the window's height that the picture keeps when zoomed out


@dataclass(frozen=True)
class Viewport:
    """Picture coordinates to screen pixels and back; every change gives a new one.

    Far out, the picture keeps a part of the window's height and is squeezed along the drive only,
    so that a road of kilometres stays a picture.

    Attributes
    ----------
    width, height : float
        Of the window, screen pixels.
    extent : tuple of float
        Of the picture, in u and v.
    stretch : float
        Screen pixels in u for one in v.
    zoom : float
        Screen pixels per pixel of the picture in v.
    centre : tuple of float
        What is in the middle of the window, picture coordinates.
    top : float
        Where the window begins below the widget's upper edge.
    """

    width: float = 1.0
    height: float = 1.0
    extent: tuple[float, float] = (1.0, 1.0)
    stretch: float = 1.0
    zoom: float = 1.0
    centre: tuple[float, float] = (0.5, 0.5)
    top: float = 0.0

    @property
    def zoom_u(self) -> float:
        """Screen pixels per pixel of the picture to the right."""
        return self.zoom * self.stretch

    @property
    def zoom_v(self) -> float:
        """Screen pixels per pixel of the picture downwards."""
        return max(self.zoom, min(1.0, _LEAST_SHARE * self.height / self.extent[1]))

    @property
    def bottom(self) -> float:
        """Where the window ends below the widget's upper edge."""
        return self.top + self.height

    @property
    def span(self) -> Span:
        """What is seen; may reach beyond the picture."""
        half_u, half_v = self.width / 2 / self.zoom_u, self.height / 2 / self.zoom_v
        u, v = self.centre
        return Span(u - half_u, v - half_v, u + half_u, v + half_v)

    def span_with(self, margin_px: float) -> Span:
        """What is seen, and so many screen pixels more on every side."""
        return self.span_of(
            -margin_px, self.top - margin_px, self.width + margin_px, self.bottom + margin_px
        )

    def span_of(self, left: float, top: float, right: float, bottom: float) -> Span:
        """The part of the picture in a rectangle of the widget."""
        return Span(*self.to_picture(left, top), *self.to_picture(right, bottom))

    def transform(self) -> QTransform:
        """The same as :meth:`to_screen` for Qt's shapes."""
        return QTransform(self.zoom_u, 0.0, 0.0, self.zoom_v, self.x_of(0.0), self.y_of(0.0))

    def to_screen(self, places: Floats) -> Floats:
        """(n, 2) picture coordinates to (n, 2) positions in the widget."""
        scale = np.array([self.zoom_u, self.zoom_v])
        middle = np.array([self.width / 2, self.top + self.height / 2])
        positions: Floats = (places - np.array(self.centre)) * scale + middle
        return positions

    def x_of(self, u: float) -> float:
        """Where a place in u is."""
        return (u - self.centre[0]) * self.zoom_u + self.width / 2

    def y_of(self, v: float) -> float:
        """Where a place in v is."""
        return (v - self.centre[1]) * self.zoom_v + self.top + self.height / 2

    def to_picture(self, x: float, y: float) -> tuple[float, float]:
        """Picture coordinates of a position in the widget."""
        return (
            (x - self.width / 2) / self.zoom_u + self.centre[0],
            (y - self.top - self.height / 2) / self.zoom_v + self.centre[1],
        )

    def zoomed(self, factor: float, x: float, y: float) -> Viewport:
        """Larger or smaller; what is at the position stays there."""
        before = self.to_picture(x, y)
        scaled = replace(self, zoom=self._limited(self.zoom * factor))
        after = scaled.to_picture(x, y)
        moved = (before[0] - after[0], before[1] - after[1])
        return scaled.centred_on(scaled.centre[0] + moved[0], scaled.centre[1] + moved[1])

    def panned(self, right_px: float, down_px: float) -> Viewport:
        """The picture pushed by so many screen pixels."""
        u, v = self.centre
        return self.centred_on(u - right_px / self.zoom_u, v - down_px / self.zoom_v)

    def centred_on(self, u: float, v: float) -> Viewport:
        """A place in the middle; the picture's edge never passes the window's middle."""
        inside = (min(max(u, 0.0), self.extent[0]), min(max(v, 0.0), self.extent[1]))
        return replace(self, centre=inside)

    def sized(self, width: float, height: float, top: float) -> Viewport:
        """The same middle in a window of another size."""
        return replace(self, width=max(width, 1.0), height=max(height, 1.0), top=top)

    def showing(self, extent: tuple[float, float], stretch: float) -> Viewport:
        """Another picture in the same window."""
        limited = (max(extent[0], 1.0), max(extent[1], 1.0))
        return replace(self, extent=limited, stretch=stretch).centred_on(*self.centre)

    def with_everything(self, stretch: float) -> Viewport:
        """The whole picture."""
        u, v = self.extent
        zoom = min(self.width / (u * stretch), self.height / v)
        return replace(self, zoom=zoom * 0.98, stretch=stretch).centred_on(u / 2, v / 2)

    def holding(self, left: float, top: float, right: float, bottom: float) -> Viewport:
        """A rectangle of the picture in the middle, smaller if it wouldn't fit otherwise."""
        wide, high = (right - left) * self.zoom_u, (bottom - top) * self.zoom_v
        shrunk = min(1.0, 0.8 * self.width / max(wide, 1.0), 0.8 * self.height / max(high, 1.0))
        scaled = replace(self, zoom=self._limited(self.zoom * shrunk))
        return scaled.centred_on((left + right) / 2, (top + bottom) / 2)

    def with_start(self) -> Viewport:
        """The beginning of the drive in the window's full height."""
        u, v = self.extent
        full = replace(self, zoom=self.height / v)
        seen = self.width / full.zoom_u
        return full.centred_on(u / 2 if seen >= u else seen / 2, v / 2)

    def one_to_one(self) -> Viewport:
        """One pixel of the picture on one of the screen, both ways."""
        return replace(self, zoom=1.0, stretch=1.0)

    def shows(self, u: float, v: float, margin_px: float) -> bool:
        """Whether a place is in the window, so far from its edge."""
        x, y = self.x_of(u), self.y_of(v) - self.top
        return (
            margin_px <= x <= self.width - margin_px and margin_px <= y <= self.height - margin_px
        )

    def _limited(self, zoom: float) -> float:
        u, v = self.extent
        least = 0.5 * min(self.width / (u * self.stretch), self.height / v)
        return min(max(zoom, min(least, 1.0)), max(_MOST_ZOOM / max(self.stretch, 1.0), 16.0))
