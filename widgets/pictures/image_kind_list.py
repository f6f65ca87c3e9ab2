"""ImageKindList: the kinds of image in a list that opens, each with a picture and a sentence."""

from __future__ import annotations

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QRect, QRectF, QSize, Qt
from PySide6.QtGui import QFont, QPainter, QPalette
from PySide6.QtWidgets import (
    QComboBox,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
)
from typing_extensions import override

from processing.core.text import Language
from processing.recording.kinds import ImageKind
from widgets.pictures.parameter_picture import picture_renderer

_PICTURE_PX, _ROOM_PX, _WORDS_PX = QSize(128, 56), 6, 250
_LINES = 4
"""A name, and its explanation in either language."""


Index = QModelIndex | QPersistentModelIndex


class ImageKindList(QStyledItemDelegate):
    """Paints the entries of a box whose data are values of :class:`ImageKind`.

    Parameters
    ----------
    box : QComboBox
        Shows names alone while it is closed.
    language : Language
    """

    def __init__(self, box: QComboBox, language: Language) -> None:
        super().__init__(box)
        self._language: Language = language
        box.setItemDelegate(self)
        wide = _PICTURE_PX.width() + _WORDS_PX + 3 * _ROOM_PX
        box.view().setMinimumWidth(wide)

    @override
    def sizeHint(self, option: QStyleOptionViewItem, index: Index) -> QSize:
        words_px = _LINES * option.fontMetrics.lineSpacing() + 2
        return QSize(0, max(_PICTURE_PX.height(), words_px) + 2 * _ROOM_PX)

    @override
    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        kind = ImageKind(str(index.data(Qt.ItemDataRole.UserRole)))
        is_chosen = bool(option.state & QStyle.StateFlag.State_Selected)
        palette = option.palette
        ground = QPalette.ColorRole.Highlight if is_chosen else QPalette.ColorRole.Base
        words = QPalette.ColorRole.HighlightedText if is_chosen else QPalette.ColorRole.Text
        painter.save()
        painter.fillRect(option.rect, palette.color(ground))
        inside = option.rect.adjusted(_ROOM_PX, _ROOM_PX, -_ROOM_PX, -_ROOM_PX)
        picture = QRect(inside.topLeft(), _PICTURE_PX)
        painter.fillRect(picture, palette.color(QPalette.ColorRole.Window))
        painter.setClipRect(picture)
        picture_renderer(f"image_kind/{kind.value}", palette).render(painter, QRectF(picture))
        painter.setClipping(False)
        painter.setPen(palette.color(words))
        beside = inside.adjusted(_PICTURE_PX.width() + _ROOM_PX, 0, 0, 0)
        font = QFont(option.font)
        font.setBold(True)
        painter.setFont(font)
        title = kind.title.in_language(self._language)
        painter.drawText(beside, Qt.AlignmentFlag.AlignTop, title)
        painter.setFont(option.font)
        below = beside.adjusted(0, option.fontMetrics.lineSpacing() + 2, 0, 0)
        flags = Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
        painter.drawText(below, flags, kind.explanation.in_language(self._language))
        painter.restore()
