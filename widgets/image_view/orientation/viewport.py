"""Viewport: which part of the picture the window shows, and how large."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from PySide6.QtCore import QRectF
from PySide6.QtGui import QTransform

from processing.core.arrays import Floats
from widgets.image_view.orientation.oriented_image import Span
from widgets.shared.image_orientation import ImageOrientation

_MOST_ZOOM = 64.0
_LEAST_SHARE = 0.3  # of the window's height that the picture keeps when zoomed out


@dataclass(frozen=True)
class Viewport:
    """Picture coordinates to screen pixels and back; every change gives a new one.

    It alone knows which way the street runs: all else works in picture coordinates or in pixels.

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
        Screen pixels per pixel of the picture in v, unless that part of the window is kept.
    centre : tuple of float
        What is in the middle of the window, picture coordinates.
    top, left : float
        Where the window begins below the widget's upper edge and right of its left one.
    orientation : ImageOrientation
        Which way u and v go on the screen.
    """

    width: float = 1.0
    height: float = 1.0
    extent: tuple[float, float] = (1.0, 1.0)
    stretch: float = 1.0
    zoom: float = 1.0
    centre: tuple[float, float] = (0.5, 0.5)
    top: float = 0.0
    left: float = 0.0
    orientation: ImageOrientation = field(default_factory=ImageOrientation)

    @property
    def zoom_u(self) -> float:
        """Screen pixels per pixel of the picture along u."""
        return self.zoom * self.stretch

    @property
    def zoom_v(self) -> float:
        """Screen pixels per pixel of the picture along v."""
        return max(self.zoom, min(1.0, _LEAST_SHARE * self.across_px / self.extent[1]))

    @property
    def along_px(self) -> float:
        """The window's size along the street."""
        return self.height if self.orientation.is_vertical else self.width

    @property
    def across_px(self) -> float:
        """The window's size across the street."""
        return self.width if self.orientation.is_vertical else self.height

    @property
    def bottom(self) -> float:
        """Where the window ends below the widget's upper edge."""
        return self.top + self.height

    @property
    def middle(self) -> tuple[float, float]:
        """Position of the window's middle in the widget."""
        return self.left + self.width / 2, self.top + self.height / 2

    @property
    def window(self) -> QRectF:
        """The window in the widget."""
        return QRectF(self.left, self.top, self.width, self.height)

    @property
    def span(self) -> Span:
        """What is seen; may reach beyond the picture."""
        half_u, half_v = self.along_px / 2 / self.zoom_u, self.across_px / 2 / self.zoom_v
        u, v = self.centre
        return Span(u - half_u, v - half_v, u + half_u, v + half_v)

    def span_with(self, margin_px: float) -> Span:
        """What is seen, and so many screen pixels more on every side."""
        more_u, more_v = margin_px / self.zoom_u, margin_px / self.zoom_v
        seen = self.span
        return Span(
            seen.left - more_u, seen.top - more_v, seen.right + more_u, seen.bottom + more_v
        )

    def span_of(self, left: float, top: float, right: float, bottom: float) -> Span:
        """The part of the picture in a rectangle of the widget."""
        (u, v), (other_u, other_v) = self.to_picture(left, top), self.to_picture(right, bottom)
        return Span(min(u, other_u), min(v, other_v), max(u, other_u), max(v, other_v))

    def rectangle_of(self, span: Span) -> QRectF:
        """Where a part of the picture is in the widget."""
        x, y = self.position_of(span.left, span.top)
        other_x, other_y = self.position_of(span.right, span.bottom)
        return QRectF(min(x, other_x), min(y, other_y), abs(other_x - x), abs(other_y - y))

    def transform(self) -> QTransform:
        """The same as :meth:`to_screen` for Qt's shapes."""
        (right_u, down_u), (right_v, down_v) = self._axes
        x, y = self.position_of(0.0, 0.0)
        return QTransform(right_u, down_u, right_v, down_v, x, y)

    def to_screen(self, positions: Floats) -> Floats:
        """(n, 2) picture coordinates to (n, 2) positions in the widget."""
        offsets = positions - np.array(self.centre)
        if self.orientation.is_vertical:
            offsets = offsets[:, ::-1]
        pixels: Floats = offsets * self._scales + np.array(self.middle)
        return pixels

    def position_of(self, u: float, v: float) -> tuple[float, float]:
        """Where a place is in the widget."""
        right, down = u - self.centre[0], v - self.centre[1]
        if self.orientation.is_vertical:
            right, down = down, right
        (x, y), (scale_x, scale_y) = self.middle, self._scales
        return x + right * scale_x, y + down * scale_y

    def to_picture(self, x: float, y: float) -> tuple[float, float]:
        """Picture coordinates of a position in the widget."""
        middle = self.middle
        du, dv = self._to_picture_step(x - middle[0], y - middle[1])
        return self.centre[0] + du, self.centre[1] + dv

    def zoomed(self, factor: float, x: float, y: float) -> Viewport:
        """Larger or smaller; what is at the position stays there."""
        before = self.to_picture(x, y)
        scaled = replace(self, zoom=self._limit_zoom(self.zoom * factor))
        after = scaled.to_picture(x, y)
        moved = (before[0] - after[0], before[1] - after[1])
        return scaled.centred_on(scaled.centre[0] + moved[0], scaled.centre[1] + moved[1])

    def panned(self, right_px: float, down_px: float) -> Viewport:
        """The picture pushed by so many screen pixels."""
        du, dv = self._to_picture_step(right_px, down_px)
        return self.centred_on(self.centre[0] - du, self.centre[1] - dv)

    def rolled(self, windows: float) -> Viewport:
        """The picture pushed along the street by a share of the window: right, or down."""
        moved_px = windows * self.along_px
        return (
            self.panned(0.0, moved_px)
            if self.orientation.is_vertical
            else self.panned(moved_px, 0.0)
        )

    def centred_on(self, u: float, v: float) -> Viewport:
        """A place in the middle; the picture's edge never passes the window's middle."""
        inside = (min(max(u, 0.0), self.extent[0]), min(max(v, 0.0), self.extent[1]))
        return replace(self, centre=inside)

    def sized(self, width: float, height: float, top: float, left: float = 0.0) -> Viewport:
        """The same middle in a window of another size."""
        return replace(self, width=max(width, 1.0), height=max(height, 1.0), top=top, left=left)

    def laid(self, orientation: ImageOrientation) -> Viewport:
        """The same middle with the street running another way."""
        return self if orientation == self.orientation else replace(self, orientation=orientation)

    def showing(self, extent: tuple[float, float], stretch: float) -> Viewport:
        """Another picture in the same window."""
        limited = (max(extent[0], 1.0), max(extent[1], 1.0))
        return replace(self, extent=limited, stretch=stretch).centred_on(*self.centre)

    def with_everything(self, stretch: float) -> Viewport:
        """The whole picture."""
        u, v = self.extent
        zoom = min(self.along_px / (u * stretch), self.across_px / v)
        return replace(self, zoom=zoom * 0.98, stretch=stretch).centred_on(u / 2, v / 2)

    def holding(self, span: Span) -> Viewport:
        """A part of the picture in the middle, smaller if it wouldn't fit otherwise."""
        wide = (span.right - span.left) * self.zoom_u
        high = (span.bottom - span.top) * self.zoom_v
        shrunk = min(
            1.0, 0.8 * self.along_px / max(wide, 1.0), 0.8 * self.across_px / max(high, 1.0)
        )
        scaled = replace(self, zoom=self._limit_zoom(self.zoom * shrunk))
        return scaled.centred_on((span.left + span.right) / 2, (span.top + span.bottom) / 2)

    def with_start(self) -> Viewport:
        """The beginning of the drive, as wide as the window."""
        u, v = self.extent
        full = replace(self, zoom=self.across_px / v)
        seen = self.along_px / full.zoom_u
        return full.centred_on(u / 2 if seen >= u else seen / 2, v / 2)

    def one_to_one(self) -> Viewport:
        """One pixel of the picture on one of the screen, both ways."""
        return replace(self, zoom=1.0, stretch=1.0)

    def shows(self, u: float, v: float, margin_px: float) -> bool:
        """Whether a place is in the window, so far from its edge."""
        x, y = self.position_of(u, v)
        middle_x, middle_y = self.middle
        return (
            abs(x - middle_x) <= self.width / 2 - margin_px
            and abs(y - middle_y) <= self.height / 2 - margin_px
        )

    @property
    def _scales(self) -> tuple[float, float]:
        """Screen pixels to the right and down for a pixel of the picture along that axis."""
        zoom_u = -self.zoom_u if self.orientation.is_reversed_along else self.zoom_u
        zoom_v = -self.zoom_v if self.orientation.is_mirrored_across else self.zoom_v
        return (zoom_v, -zoom_u) if self.orientation.is_vertical else (zoom_u, zoom_v)

    @property
    def _axes(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Screen pixels to the right and down for one in u, and for one in v."""
        scale_x, scale_y = self._scales
        if self.orientation.is_vertical:
            return (0.0, scale_y), (scale_x, 0.0)
        return (scale_x, 0.0), (0.0, scale_y)

    def _to_picture_step(self, right_px: float, down_px: float) -> tuple[float, float]:
        """How far in u and v a way on the screen leads."""
        scale_x, scale_y = self._scales
        right, down = right_px / scale_x, down_px / scale_y
        return (down, right) if self.orientation.is_vertical else (right, down)

    def _limit_zoom(self, zoom: float) -> float:
        u, v = self.extent
        least = 0.5 * min(self.along_px / (u * self.stretch), self.across_px / v)
        return min(max(zoom, min(least, 1.0)), max(_MOST_ZOOM / max(self.stretch, 1.0), 16.0))
