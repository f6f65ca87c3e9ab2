"""The diagnostic layer of a section: scanlines, marks where tools looked, and the tests there."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen, QPolygonF

from processing.core.text import Language, Text
from processing.methods.road.diagnostics import DiagnosticTest
from processing.tools.listed.registry import TOOLS
from widgets.plane_view.viewport import PlaneViewport
from widgets.section_view.picture.feed import SectionPicture
from widgets.section_view.picture.frame import BOTTOM_PX, LEFT_PX
from widgets.section_view.picture.projection import SectionProjection
from widgets.section_view.picture.section_diagnostics import ShownDiagnostic

_TAKEN = Text("taken", "採用")
_LEFT = Text("not taken", "不採用")
_SCANLINE = Text("Normalised scanline", "正規化スキャンライン")
_TAKEN_POSITION = Text("Place that was taken", "採用された箇所")
_LEFT_POSITION = Text("Place that was not taken", "採用されなかった箇所")
_NO_SCANLINE = Text("No scanline here", "ここにはスキャンラインがありません")
_AWAITED = Text("Still looking: {tool}", "確認中: {tool}")
_LIMIT = Text("limit {limit}", "基準 {limit}")

_LINE, _LINE_EDGE = QColor("#56b4e9"), QColor(16, 18, 22, 170)
_YES, _NO = QColor("#3ddc97"), QColor("#ff8c69")
_PLATE, _WORDS, _FAINT = QColor(16, 18, 22, 225), QColor("#eef2f6"), QColor("#b9c0c9")
_MARK_PX, _NEAR_PX, _POINT_PX = 6.0, 14.0, 3.0
_MARGIN_PX, _GAP_PX, _SAMPLE_PX = 8.0, 14.0, 26.0
_TOP_PX = 34.0


class DiagnosticMarks:
    """Paints the layer, and the tests of the mark that the mouse is at.

    Parameters
    ----------
    language : Language
    """

    def __init__(self, language: Language) -> None:
        self._language = language
        self._hovered: ShownDiagnostic | None = None

    @property
    def hovered(self) -> ShownDiagnostic | None:
        """The place whose tests are shown."""
        return self._hovered

    def hover(
        self,
        picture: SectionPicture | None,
        viewport: PlaneViewport,
        mouse: QPointF | None,
    ) -> bool:
        """Show the tests of the mark nearest to the mouse; says whether that is another one."""
        before, self._hovered = self._hovered, None
        diagnostics = _diagnostics_of(picture)
        if picture is not None and diagnostics and mouse is not None:
            projection = SectionProjection(picture.request.cut)
            spots = viewport.to_screen(
                projection.on_plane(np.array([one.section for one in diagnostics]))
            )
            away = np.hypot(*(spots - np.array([mouse.x(), mouse.y()])).T)
            nearest = int(away.argmin())
            if away[nearest] <= _NEAR_PX:
                self._hovered = diagnostics[nearest]
        return self._hovered is not before

    def paint(self, painter: QPainter, picture: SectionPicture, viewport: PlaneViewport) -> None:
        """Paint scanlines and marks, where the layer is shown."""
        if picture.diagnostics is None:
            return
        projection = SectionProjection(picture.request.cut)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
        for pen in (QPen(_LINE_EDGE, 3.5), QPen(_LINE, 1.5)):
            painter.setPen(pen)
            for line in (line for one in picture.diagnostics.drives for line in one.lines):
                spots = viewport.to_screen(projection.on_plane(line))
                painter.drawPolyline(QPolygonF([QPointF(x, y) for x, y in spots.tolist()]))
        for shown in sorted(_diagnostics_of(picture), key=lambda shown: shown.diagnostic.is_taken):
            x, y = viewport.to_screen(projection.on_plane(shown.section[None]))[0].tolist()
            if len(shown.points):
                painter.setPen(QPen(_YES if shown.diagnostic.is_taken else _NO, _POINT_PX))
                spots = viewport.to_screen(projection.on_plane(shown.points))
                painter.drawPoints([QPointF(*spot) for spot in spots.tolist()])
            if len(shown.outline):
                ring = viewport.to_screen(projection.on_plane(shown.outline)).tolist()
                _paint_outline(painter, ring, is_taken=shown.diagnostic.is_taken)
            _paint_mark(painter, QPointF(x, y), is_taken=shown.diagnostic.is_taken)

    def paint_words(
        self, painter: QPainter, picture: SectionPicture, viewport: PlaneViewport
    ) -> None:
        """Say what lines and marks are, and what came of the tests at the mark under the mouse."""
        found = picture.diagnostics
        if found is None:
            return
        diagnostics = _diagnostics_of(picture)
        entries = [(_SCANLINE if found.drives else _NO_SCANLINE, _Sign.LINE)]
        if picture.request.standing.is_along and found.drives:
            entries.clear()
        taken = {shown.diagnostic.is_taken for shown in diagnostics}
        entries += [(_TAKEN_POSITION, _Sign.TAKEN)] if True in taken else []
        entries += [(_LEFT_POSITION, _Sign.LEFT)] if False in taken else []
        if found.awaited:
            entries.append((_AWAITED.filled(tool=_name_of(found.awaited)), _Sign.NONE))
        words = [(text.in_language(self._language), sign) for text, sign in entries]
        if words:
            _paint_legend(painter, words)
        if self._hovered is not None and self._hovered in diagnostics:
            self._paint_tests(painter, self._hovered, viewport)

    def _paint_tests(
        self, painter: QPainter, shown: ShownDiagnostic, viewport: PlaneViewport
    ) -> None:
        language, diagnostic = self._language, shown.diagnostic
        name = _name_of(shown.tool)
        verdict = (_TAKEN if diagnostic.is_taken else _LEFT).in_language(language)
        title = f"{name.in_language(language)} · {verdict}"
        rows = [_words_of(outcome, language) for outcome in diagnostic.outcomes]
        metrics = QFontMetricsF(painter.font())
        names, values, limits = (
            max((metrics.horizontalAdvance(row[column]) for row in rows), default=0.0)
            for column in range(3)
        )
        high = metrics.height() + 3.0
        wide = max(
            _SAMPLE_PX + names + values + limits + 2 * _GAP_PX, metrics.horizontalAdvance(title)
        )
        left = max(viewport.width - wide - 3 * _MARGIN_PX, LEFT_PX)
        tall = (len(rows) + 1) * high + _MARGIN_PX
        top = max(min(_TOP_PX, viewport.height - BOTTOM_PX - tall), 2.0)
        painter.fillRect(QRectF(left, top, wide + 2 * _MARGIN_PX, tall), _PLATE)
        painter.setPen(_YES if diagnostic.is_taken else _NO)
        x, y = left + _MARGIN_PX, top + _MARGIN_PX / 2
        middle = int(Qt.AlignmentFlag.AlignVCenter)
        painter.drawText(QRectF(x, y, wide, high), middle, title)
        right = middle | int(Qt.AlignmentFlag.AlignRight)
        for row, outcome in zip(rows, diagnostic.outcomes, strict=True):
            y += high
            _paint_sign(painter, QPointF(x + 6.0, y + high / 2), is_met=outcome.is_met)
            painter.setPen(_WORDS)
            painter.drawText(QRectF(x + _SAMPLE_PX, y, names, high), middle, row[0])
            value = QRectF(x + _SAMPLE_PX + names + _GAP_PX, y, values, high)
            painter.drawText(value, right, row[1])
            painter.setPen(_FAINT)
            painter.drawText(
                value.translated(values + _GAP_PX, 0).adjusted(0, 0, wide, 0), middle, row[2]
            )


def _name_of(tool: str) -> Text:
    return TOOLS[tool].name if tool in TOOLS else Text.same(tool)


def _diagnostics_of(picture: SectionPicture | None) -> list[ShownDiagnostic]:
    found = None if picture is None else picture.diagnostics
    return [] if found is None else [shown for one in found.drives for shown in one.diagnostics]


def _words_of(outcome: DiagnosticTest, language: Language) -> tuple[str, str, str]:
    """Name, measured value and limit of a test as they are read."""
    if np.isnan(outcome.limit):  # a question that is answered by yes or no
        return outcome.name.in_language(language), "", ""
    limit = _LIMIT.filled(limit=_number(outcome.limit, outcome.unit)).in_language(language)
    return outcome.name.in_language(language), _number(outcome.value, outcome.unit), limit


def _number(value: float, unit: str) -> str:
    if not np.isfinite(value):
        return "–"
    decimals = {"m": 3, "°": 1, "s": 2}.get(unit, 2)
    words = f"{value:.0f}" if unit == "" and float(value).is_integer() else f"{value:.{decimals}f}"
    gap = "" if unit in ("", "°", "%") else " "
    return f"{words}{gap}{unit}".replace("-", "−")


class _Sign(Enum):
    """What stands before the words of the legend."""

    NONE = 0
    LINE = 1
    TAKEN = 2
    LEFT = 3


def _paint_legend(painter: QPainter, entries: Sequence[tuple[str, _Sign]]) -> None:
    metrics = QFontMetricsF(painter.font())
    high = metrics.height() + 2.0
    longest = max(metrics.horizontalAdvance(words) for words, _ in entries)
    wide = longest + _SAMPLE_PX + 3 * _MARGIN_PX
    plate = QRectF(LEFT_PX + 6.0, _TOP_PX, wide, len(entries) * high + 4.0)
    painter.fillRect(plate, _PLATE)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, on=True)
    for number, (words, sign) in enumerate(entries):
        middle = plate.top() + 2.0 + (number + 0.5) * high
        left = plate.left() + _MARGIN_PX
        if sign is _Sign.LINE:
            painter.setPen(QPen(_LINE, 1.5))
            painter.drawLine(QLineF(left, middle, left + _SAMPLE_PX, middle))
        elif sign is not _Sign.NONE:
            at = QPointF(left + _SAMPLE_PX / 2, middle)
            _paint_mark(painter, at, is_taken=sign is _Sign.TAKEN)
        painter.setPen(_WORDS)
        box = QRectF(left + _SAMPLE_PX + _MARGIN_PX, middle - high / 2, wide, high)
        painter.drawText(box, int(Qt.AlignmentFlag.AlignVCenter), words)


def _paint_mark(painter: QPainter, at: QPointF, *, is_taken: bool) -> None:
    """A filled disc where something was taken, an open one with a stroke where it was not."""
    colour = _YES if is_taken else _NO
    painter.setPen(QPen(_LINE_EDGE, 4.0))
    painter.setBrush(colour if is_taken else Qt.BrushStyle.NoBrush)
    painter.drawEllipse(at, _MARK_PX, _MARK_PX)
    painter.setPen(QPen(colour, 2.0))
    painter.drawEllipse(at, _MARK_PX, _MARK_PX)
    if not is_taken:
        reach = _MARK_PX * 0.7
        painter.drawLine(QLineF(at.x() - reach, at.y() + reach, at.x() + reach, at.y() - reach))
    painter.setBrush(Qt.BrushStyle.NoBrush)


def _paint_outline(painter: QPainter, ring: Sequence[Sequence[float]], *, is_taken: bool) -> None:
    """What a tool laid on the points: whole where it was taken, dashed where it was not."""
    polygon = QPolygonF([QPointF(x, y) for x, y in ring])
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(QPen(_LINE_EDGE, 4.0))
    painter.drawPolygon(polygon)
    line = Qt.PenStyle.SolidLine if is_taken else Qt.PenStyle.DashLine
    painter.setPen(QPen(_YES if is_taken else _NO, 2.0, line))
    painter.drawPolygon(polygon)


def _paint_sign(painter: QPainter, at: QPointF, *, is_met: bool) -> None:
    """A tick or a cross."""
    x, y = at.x(), at.y()
    painter.setPen(QPen(_YES if is_met else _NO, 2.0))
    if is_met:
        painter.drawPolyline([QPointF(x - 4, y), QPointF(x - 1, y + 4), QPointF(x + 5, y - 4)])
    else:
        painter.drawLine(QLineF(x - 4, y - 4, x + 4, y + 4))
        painter.drawLine(QLineF(x - 4, y + 4, x + 4, y - 4))
