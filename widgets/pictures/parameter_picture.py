"""ParameterPicture: a drawing that shows what a parameter means, in the window's own colours."""

from __future__ import annotations

from xml.etree import ElementTree as ET

from PySide6.QtCore import QByteArray, QEvent, QRectF, QSize
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPalette
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QSizePolicy, QWidget
from typing_extensions import override

from resources import path_of
from widgets.feature_drawing.feature_style import ACCENT

PICTURE_PX = QSize(320, 140)
"""The size in which every picture is drawn; it is shown smaller where there is less room."""

_USUAL_PX, _LEAST_PX = QSize(240, 105), QSize(120, 0)
_LINES, _BESIDE, _BODIES, _MEANT = "#202020", "#9a9a9a", "#dcdcdc", "#0b6bcb"
_BODY_SHARE, _BESIDE_SHARE = 0.14, 0.45
_DARK = 0.5


class ParameterPicture(QWidget):
    """Shows one picture, or nothing.

    It becomes small, or gives way, where a low screen leaves little room.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._name = ""
        self._renderer: QSvgRenderer | None = None
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)

    @property
    def name(self) -> str:
        """What is shown, ``SCENE`` or ``SCENE/PART``; empty for nothing."""
        return self._name

    def show_picture(self, name: str) -> None:
        """Show this.

        Raises
        ------
        UnknownResource
            There is no such picture.
        """
        if name != self._name:
            self._name = name
            self._renderer = None if not name else picture_renderer(name, self.palette())
            self.update()

    @override
    def sizeHint(self) -> QSize:
        return _USUAL_PX

    @override
    def minimumSizeHint(self) -> QSize:
        return _LEAST_PX

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        if self._renderer is None:
            return
        shape = PICTURE_PX.width() / PICTURE_PX.height()
        high = min(self.height(), self.width() / shape)
        wide = high * shape
        frame = QRectF((self.width() - wide) / 2, (self.height() - high) / 2, wide, high)
        with QPainter(self) as painter:
            painter.setClipRect(frame)
            self._renderer.render(painter, frame)

    @override
    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() is QEvent.Type.PaletteChange and self._name:
            self._renderer = picture_renderer(self._name, self.palette())
            self.update()


def picture_source(name: str) -> str:
    """The SVG of a picture with the one part that is meant.

    Parameters
    ----------
    name : str
        ``SCENE``, or ``SCENE/PART``.

    Raises
    ------
    UnknownResource
        There is no such file.
    KeyError
        The file has no such part.
    """
    scene, _, part = name.partition("/")
    # The file comes with the program.
    root = ET.parse(path_of(f"pictures/parameters/{scene}.svg")).getroot()  # noqa: S314
    parts = {group.attrib["id"]: group for group in root if "id" in group.attrib}
    if part and part not in parts:
        raise KeyError(name)
    for id_, group in parts.items():
        if part not in ("", id_):
            root.remove(group)
    return ET.tostring(root, encoding="unicode")


def picture_renderer(name: str, palette: QPalette) -> QSvgRenderer:
    """What paints a picture in the colours of a palette; raises as :func:`picture_source`."""
    ground = palette.color(QPalette.ColorRole.Window)
    ink = palette.color(QPalette.ColorRole.WindowText)
    meant = ACCENT if ground.lightnessF() < _DARK else QColor(_MEANT)
    source = picture_source(name)
    for drawn, colour in (
        (_LINES, ink),
        (_BESIDE, _mix_colours(ground, ink, _BESIDE_SHARE)),
        (_BODIES, _mix_colours(ground, ink, _BODY_SHARE)),
        (_MEANT, meant),
    ):
        source = source.replace(drawn, colour.name())
    return QSvgRenderer(QByteArray(source.encode()))


def _mix_colours(first: QColor, second: QColor, share: float) -> QColor:
    def part(one: float, other: float) -> float:
        return one * (1 - share) + other * share

    return QColor.fromRgbF(
        part(first.redF(), second.redF()),
        part(first.greenF(), second.greenF()),
        part(first.blueF(), second.blueF()),
    )
