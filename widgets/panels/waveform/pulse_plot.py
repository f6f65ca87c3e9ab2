"""A waveform painted: counts and volts over time, and where along the ray that is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFontMetrics, QPainter, QPaintEvent, QPalette, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget
from typing_extensions import override

from processing.methods.classes.pulse_occlusion import PulseOcclusion
from processing.methods.waveforms.pulse_grad_cam import PulseGradCam
from processing.recording.shown_pulse import ShownPulse

_NICE = (1.0, 2.0, 5.0)
ALONE, TOGETHER = "#d55e00", "#009e73"
"""Colours of what hangs on this pulse, and on it together with those around: both can be read on
light and dark, and told apart by the colour-blind (Okabe & Ito)."""

SEEN = "#cc79a7"
"""Colour of where the local network saw a class."""

_BAND, _BAND_SHARE, _APART = 2.6, 0.36, 0.3
"""Most height of the band below the waveform in lines of text, its most share of what there is for
both, and the gap between them in lines."""

_BAND_ENDS = 0.1, 0.25, 0.5, 1.0
"""Probabilities that the band reaches up to, and down to."""

_UNSEEN = 0.01
_ABOVE = 1.12
"""The highest peak keeps clear of the returns' numbers over the field."""


@dataclass(frozen=True)
class PulseWords:
    """What stands at the axes, in the user's language."""

    counts: str
    volts: str
    time: str
    metres: str
    baseline: str


@dataclass(frozen=True)
class _Axes:
    """How times and counts become pixels of a field."""

    field: QRectF
    time_ns: float
    low: float
    high: float
    band: QRectF | None = None

    @property
    def bottom(self) -> float:
        """Where the scale of time stands."""
        return self.field.bottom() if self.band is None else self.band.bottom()

    def x(self, time_ns: float) -> float:
        return self.field.left() + self.field.width() * time_ns / self.time_ns

    def y(self, counts: float) -> float:
        share = (counts - self.low) / (self.high - self.low)
        return self.field.bottom() - self.field.height() * share


class PulsePlot(QWidget):
    """Shows one pulse in the window's colours: samples, baseline, and a line at each return."""

    def __init__(self, words: PulseWords, parent: QWidget) -> None:
        super().__init__(parent)
        self._words = words
        self._pulse: ShownPulse | None = None
        self._looked_at: PulseOcclusion | PulseGradCam | None = None
        self._has_band = False
        self.setMinimumSize(200, 140)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    @property
    def occlusion(self) -> PulseOcclusion | None:
        """What is drawn in the band below the waveform, where that is what was lost."""
        found = self._looked_at
        return found if isinstance(found, PulseOcclusion) else None

    @property
    def grad_cam(self) -> PulseGradCam | None:
        """What is drawn there, where that is what the local network saw."""
        found = self._looked_at
        return found if isinstance(found, PulseGradCam) else None

    @property
    def pulse(self) -> ShownPulse | None:
        """What it shows."""
        return self._pulse

    def show_pulse(self, pulse: ShownPulse | None) -> None:
        """Show a pulse; None: nothing."""
        self._pulse = pulse
        self.update()

    def show_looked_at(
        self, found: PulseOcclusion | PulseGradCam | None, *, has_room: bool
    ) -> None:
        """Show in a band what the class hangs on; its room may be kept while nothing is known."""
        self._looked_at, self._has_band = found, has_room
        self.update()

    def use_words(self, words: PulseWords) -> None:
        """Write other words at the axes."""
        self._words = words
        self.update()

    @override
    def sizeHint(self) -> QSize:
        return QSize(360, 240)

    @override
    def paintEvent(self, event: QPaintEvent) -> None:
        with QPainter(self) as painter:
            painter.fillRect(self.rect(), self.palette().color(QPalette.ColorRole.Base))
            if self._pulse is None:
                return
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            axes = self._axes(self._pulse, painter.fontMetrics())
            if axes.field.width() < 40 or axes.field.height() < 40:
                return
            self._paint_scales(painter, self._pulse, axes)
            self._paint_samples(painter, self._pulse, axes)
            self._paint_returns(painter, self._pulse, axes)
            if axes.band is not None:
                self._paint_band(painter, axes, axes.band)

    def _axes(self, pulse: ShownPulse, metrics: QFontMetrics) -> _Axes:
        line = metrics.height()
        side = metrics.horizontalAdvance("00000") + line
        field = QRectF(self.rect()).adjusted(side, 3.4 * line, -side, -2.4 * line)
        band = None
        if self._has_band:
            height = min(_BAND * line, _BAND_SHARE * field.height())
            band = QRectF(field.left(), field.bottom() - height, field.width(), height)
            field.setBottom(band.top() - _APART * line)
        low = min(0.0, float(pulse.counts.min()))
        high = max(low + 1.0, float(pulse.counts.max()))
        span = (pulse.counts.size - 1) * pulse.descriptor.interval_ns
        return _Axes(field, max(span, 1e-3), low, low + (high - low) * _ABOVE, band)

    def _paint_scales(self, painter: QPainter, pulse: ShownPulse, axes: _Axes) -> None:
        line, field, words = painter.fontMetrics().height(), axes.field, self._words
        faint = QPen(self._colour(QPalette.ColorRole.Midlight), 1)
        ink = self._colour(QPalette.ColorRole.Text)
        for value in nice_steps(axes.low, axes.high, field.height() / (2.2 * line)):
            y = axes.y(value)
            painter.setPen(faint)
            painter.drawLine(QPointF(field.left(), y), QPointF(field.right(), y))
            painter.setPen(ink)
            left = QRectF(line, y - line / 2, field.left() - 1.3 * line, line)
            painter.drawText(left, int(Qt.AlignmentFlag.AlignRight), f"{value:g}")
        gain, offset = pulse.descriptor.gain, pulse.descriptor.offset
        if gain != 0:
            one, other = offset + gain * axes.low, offset + gain * axes.high
            most = field.height() / (2.2 * line)
            for volts in nice_steps(min(one, other), max(one, other), most):
                y = axes.y((volts - offset) / gain)
                right = QRectF(field.right() + 0.3 * line, y - line / 2, 4 * line, line)
                painter.drawText(right, int(Qt.AlignmentFlag.AlignLeft), f"{volts:g}")
            painter.drawLine(field.topRight(), field.bottomRight())
            self._write_upright(painter, words.volts, self.width() - line)
        self._write_upright(painter, words.counts, 0.0)
        per_label = 5.0 * line
        for time in nice_steps(0.0, axes.time_ns, field.width() / per_label):
            x = axes.x(time)
            painter.setPen(faint)
            painter.drawLine(QPointF(x, field.top()), QPointF(x, axes.bottom))
            painter.setPen(ink)
            below = QRectF(x - per_label / 2, axes.bottom + 0.1 * line, per_label, line)
            painter.drawText(below, int(Qt.AlignmentFlag.AlignHCenter), f"{time:g}")
        below = QRectF(0, axes.bottom + 1.1 * line, self.width(), 1.2 * line)
        painter.drawText(below, int(Qt.AlignmentFlag.AlignHCenter), words.time)
        if np.isfinite(pulse.metres_in_ns):
            self._paint_metres(painter, pulse, axes)

    def _paint_metres(self, painter: QPainter, pulse: ShownPulse, axes: _Axes) -> None:
        """Above the field: how far along the ray; from the sensor where its place is known."""
        line, field, per_label = painter.fontMetrics().height(), axes.field, 6.0
        first = pulse.range_m if np.isfinite(pulse.range_m) else 0.0
        last = first + axes.time_ns * pulse.metres_in_ns
        for metres in nice_steps(first, last, field.width() / (per_label * line)):
            x = axes.x((metres - first) / pulse.metres_in_ns)
            above = QRectF(x - per_label * line / 2, 1.15 * line, per_label * line, line)
            painter.drawText(above, int(Qt.AlignmentFlag.AlignHCenter), f"{metres:g}")
            painter.drawLine(QPointF(x, 2.15 * line), QPointF(x, 2.35 * line))
        painter.drawLine(QPointF(field.left(), 2.35 * line), QPointF(field.right(), 2.35 * line))
        top = QRectF(0, 0.1 * line, self.width(), line)
        painter.drawText(top, int(Qt.AlignmentFlag.AlignHCenter), self._words.metres)

    def _paint_samples(self, painter: QPainter, pulse: ShownPulse, axes: _Axes) -> None:
        times = np.arange(pulse.counts.size) * pulse.descriptor.interval_ns
        places = [
            QPointF(axes.x(time), axes.y(count))
            for time, count in zip(times.tolist(), pulse.counts.tolist(), strict=True)
        ]
        line = painter.fontMetrics().height()
        base = float(pulse.shapes.baseline[pulse.chosen])
        if np.isfinite(base):
            y = axes.y(base)
            painter.setPen(QPen(self._colour(QPalette.ColorRole.PlaceholderText), 1.2, _DASHES))
            painter.drawLine(QPointF(axes.field.left(), y), QPointF(axes.field.right(), y))
            words = self._words.baseline.format(value=f"{base:g}")
            box = QRectF(axes.field.right() - 12 * line, y - 1.1 * line, 12 * line, line)
            painter.drawText(box, int(Qt.AlignmentFlag.AlignRight), words)
        painter.setPen(QPen(self._colour(QPalette.ColorRole.Link), 1.6))
        painter.drawPolyline(QPolygonF(places))
        painter.setBrush(self._colour(QPalette.ColorRole.Link))
        radius = 1.8 if len(places) * 4 < axes.field.width() else 0.0
        for place in places if radius else ():
            painter.drawEllipse(place, radius, radius)

    def _paint_returns(self, painter: QPainter, pulse: ShownPulse, axes: _Axes) -> None:
        line = painter.fontMetrics().height()
        for number, place in enumerate(pulse.places_ns.tolist()):
            is_chosen = number == pulse.chosen
            colour = self._colour(
                QPalette.ColorRole.Highlight if is_chosen else QPalette.ColorRole.Text
            )
            painter.setPen(
                QPen(colour, 2.0 if is_chosen else 1.0, _PLAIN if is_chosen else _DASHES)
            )
            x = axes.x(min(max(place, 0.0), axes.time_ns))
            painter.drawLine(QPointF(x, axes.field.top()), QPointF(x, axes.field.bottom()))
            box = QRectF(x - 2 * line, axes.field.top() - line, 4 * line, line)
            painter.drawText(box, int(Qt.AlignmentFlag.AlignHCenter), str(number + 1))

    def _paint_band(self, painter: QPainter, axes: _Axes, band: QRectF) -> None:
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(self._colour(QPalette.ColorRole.Midlight), 1))
        painter.drawRect(band)
        found = self._looked_at
        if isinstance(found, PulseOcclusion):
            self._paint_occlusion(painter, found, axes, band)
        elif found is not None and found.times_ns.size:
            self._paint_grad_cam(painter, found, axes, band)

    def _paint_grad_cam(
        self, painter: QPainter, found: PulseGradCam, axes: _Axes, band: QRectF
    ) -> None:
        """How much each time speaks for the class, of the greatest."""
        places = [
            QPointF(axes.x(time), band.bottom() - band.height() * value)
            for time, value in zip(found.times_ns.tolist(), found.seen.tolist(), strict=True)
        ]
        fill = QColor(SEEN)
        fill.setAlphaF(0.45)
        painter.setBrush(fill)
        painter.setPen(Qt.PenStyle.NoPen)
        ends = [QPointF(places[-1].x(), band.bottom()), QPointF(places[0].x(), band.bottom())]
        painter.drawPolygon(QPolygonF([*places, *ends]))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(QColor(SEEN), 1.6))
        painter.drawPolyline(QPolygonF(places))

    def _paint_occlusion(
        self, painter: QPainter, found: PulseOcclusion, axes: _Axes, band: QRectF
    ) -> None:
        """How much likelier the class is with each window hidden: less so where it is looked at."""
        line = painter.fontMetrics().height()
        changes = -np.stack([found.drops, found.drops_together])
        low, high = -_end_of(-float(changes.min())), 0.0
        if changes.max() > _UNSEEN:
            high = _end_of(float(changes.max()))

        def y(change: float) -> float:
            return band.bottom() - band.height() * (change - low) / (high - low)

        painter.setPen(QPen(self._colour(QPalette.ColorRole.PlaceholderText), 1.2, _DASHES))
        painter.drawLine(QPointF(band.left(), y(0.0)), QPointF(band.right(), y(0.0)))
        places = [axes.x(time) for time in found.middles_ns.tolist()]
        alone, around = (
            [QPointF(x, y(value)) for x, value in zip(places, one.tolist(), strict=True)]
            for one in changes
        )
        fill = QColor(ALONE)
        fill.setAlphaF(0.45)
        painter.setBrush(fill)
        painter.setPen(Qt.PenStyle.NoPen)
        ends = [QPointF(places[-1], y(0.0)), QPointF(places[0], y(0.0))]
        painter.drawPolygon(QPolygonF([*alone, *ends]))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for curve, colour in ((alone, ALONE), (around, TOGETHER)):
            painter.setPen(QPen(QColor(colour), 1.6))
            painter.drawPolyline(QPolygonF(curve))
        # Inside, at the end, where a waveform seldom has an echo: beside it stand other numbers.
        painter.setPen(self._colour(QPalette.ColorRole.Text))
        for value, top in ((low, band.bottom() - line), (high, band.top())):
            box = QRectF(band.right() - 6 * line, top, 5.8 * line, line)
            words = f"{value:+.0%}".replace("-", "−")
            painter.drawText(box, int(Qt.AlignmentFlag.AlignRight), words if value else "")

    def _write_upright(self, painter: QPainter, words: str, left: float) -> None:
        line = painter.fontMetrics().height()
        painter.save()
        painter.translate(left, self.height() / 2)
        painter.rotate(-90)
        box = QRectF(-self.height() / 2, 0, self.height(), line)
        painter.drawText(box, int(Qt.AlignmentFlag.AlignHCenter), words)
        painter.restore()

    def _colour(self, role: QPalette.ColorRole) -> QColor:
        return self.palette().color(role)


_DASHES, _PLAIN = Qt.PenStyle.DashLine, Qt.PenStyle.SolidLine


def _end_of(most: float) -> float:
    """How far the band reaches."""
    return next((end for end in _BAND_ENDS if end >= most), 1.0)


def nice_steps(low: float, high: float, most: float) -> Sequence[float]:
    """Round numbers between two ends, about so many at most."""
    if not (np.isfinite([low, high]).all() and high > low):
        return ()
    raw = (high - low) / max(most, 1.0)
    decade = 10.0 ** np.floor(np.log10(raw))
    step = next((nice * decade for nice in _NICE if nice * decade >= raw), 10 * decade)
    numbers = np.arange(np.ceil(low / step), np.floor(high / step) + 1) * step
    return [round(number, 10) + 0.0 for number in numbers.tolist()]
