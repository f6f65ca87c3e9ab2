"""FeatureStyle: how a feature looks, the same in every view."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QPen

from processing.map.catalogue import Catalogue
from processing.map.feature import Feature, Status

ACCENT = QColor("#4da3ff")
"""What is chosen, and what the mouse is about to make."""

CURSOR_COLOUR = QColor("#ffd23f")

_UNKNOWN_KIND = "#d0d0d0"
_REJECTED = "#8a8a8a"
_PLAIN_PX = 1.75
_REJECTED_PX = 1.0
_CHOSEN_PX = 2.5
_HALO_PX = 1.25
_HALO = "#0b0d10"


@dataclass(frozen=True)
class FeatureStyle:
    """Colour, width and pattern of a feature.

    Attributes
    ----------
    colour : str
        ``#rrggbb``.
    width_px : float
        On the screen, at any zoom.
    is_dashed : bool
        Nobody has agreed to it yet.
    has_vertices : bool
        Whether vertices are marked by squares.
    halo_px : float
        Of the dark line on either side; wider for candidates with more confidence.
    symbol : str
        Of a point feature, as the catalogue names it.
    """

    colour: str
    width_px: float = _PLAIN_PX
    is_dashed: bool = False
    has_vertices: bool = False
    halo_px: float = _HALO_PX
    symbol: str = ""

    @property
    def rgb(self) -> tuple[float, float, float]:
        """The colour as three shares of 1."""
        colour = QColor(self.colour)
        return colour.redF(), colour.greenF(), colour.blueF()

    def pen(self) -> QPen:
        """The line itself, for shapes in pixels of the widget.

        Not a cosmetic one: that would count the screen's own pixels and be thin where these are
        finer.
        """
        pen = QPen(QColor(self.colour), self.width_px)
        pen.setJoinStyle(Qt.PenJoinStyle.BevelJoin)
        if self.is_dashed:
            pen.setDashPattern([5.0, 3.0])
        return pen

    def halo_pen(self) -> QPen:
        """The dark line below it, by which it reads on bright and on dark points.

        Opaque, with plain joins and ends: a see-through one takes five times as long to paint.
        """
        pen = QPen(QColor(_HALO), self.width_px + 2 * self.halo_px)
        pen.setJoinStyle(Qt.PenJoinStyle.BevelJoin)
        pen.setCapStyle(Qt.PenCapStyle.FlatCap)
        return pen


def colour_of_kind(catalogue: Catalogue, kind: str) -> str:
    """``#rrggbb`` of a kind; a neutral grey for one that the catalogue doesn't know."""
    return catalogue[kind].colour if kind in catalogue else _UNKNOWN_KIND


def style_of(catalogue: Catalogue, feature: Feature, *, is_selected: bool) -> FeatureStyle:
    """The look of a feature."""
    is_candidate = feature.status is Status.CANDIDATE
    is_rejected = feature.status is Status.REJECTED
    confidence = min(max(feature.provenance.confidence, 0.0), 1.0)
    plain_px = _REJECTED_PX if is_rejected else _PLAIN_PX
    return FeatureStyle(
        colour=_REJECTED if is_rejected else colour_of_kind(catalogue, feature.kind),
        width_px=_CHOSEN_PX if is_selected else plain_px,
        is_dashed=is_candidate,
        has_vertices=is_selected,
        halo_px=_HALO_PX * (0.4 + 1.2 * confidence) if is_candidate else _HALO_PX,
        symbol=catalogue[feature.kind].symbol if feature.kind in catalogue else "",
    )


def sketch_style(catalogue: Catalogue, kind: str) -> FeatureStyle:
    """The look of what is being drawn."""
    return FeatureStyle(colour_of_kind(catalogue, kind), width_px=_CHOSEN_PX, has_vertices=True)
