"""SymbolPictures: the catalogue's survey symbols, drawn in a kind's colour with a dark halo."""

from __future__ import annotations

from PySide6.QtCore import QByteArray, QRectF, Qt
from PySide6.QtGui import QImage, QPainter
from PySide6.QtSvg import QSvgRenderer

from resources import UnknownResource, path_of

SYMBOL_PX = 36
"""Side of a symbol's picture; the symbol itself fills about a third to two thirds of it."""

_HALO = "#0b0d10"
_LINE_WIDTH = 'stroke-width="0.1"'
_LINE = 'stroke-width="0.15"'
_WIDE = 'stroke-width="0.38"'


class SymbolPictures:
    """Draws each symbol once in each colour."""

    def __init__(self) -> None:
        self._made: dict[tuple[str, str, float], QImage | None] = {}

    def picture(self, symbol: str, colour: str, ratio: float = 1.0) -> QImage | None:
        """A symbol whose middle is the middle of the picture; None when there is no such symbol.

        Parameters
        ----------
        symbol : str
            Name of ``resources/symbols/<symbol>.svg``, or empty.
        colour : str
            ``#rrggbb``.
        ratio : float
            Pixels of the screen per unit of the window.
        """
        key = symbol, colour, ratio
        if key not in self._made:
            self._made[key] = _draw_symbol(symbol, colour, ratio)
        return self._made[key]


def _draw_symbol(symbol: str, colour: str, ratio: float) -> QImage | None:
    if not symbol:
        return None
    try:
        source = path_of(f"symbols/{symbol}.svg").read_text(encoding="utf-8")
    except UnknownResource:
        return None  # an office's catalogue may name symbols of its own
    side = round(SYMBOL_PX * ratio)
    image = QImage(side, side, QImage.Format.Format_ARGB32_Premultiplied)
    image.fill(Qt.GlobalColor.transparent)
    with QPainter(image) as painter:
        for ink, width in ((_HALO, _WIDE), (colour, _LINE)):
            drawing = source.replace("currentColor", ink).replace(_LINE_WIDTH, width)
            renderer = QSvgRenderer(QByteArray(drawing.encode()))
            renderer.render(painter, QRectF(0, 0, side, side))
    image.setDevicePixelRatio(ratio)
    return image
