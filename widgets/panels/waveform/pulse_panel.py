"""PulsePanel: the waveform behind the point that the cursor is on, with the returns on it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent, QShowEvent
from PySide6.QtWidgets import QBoxLayout, QLabel, QVBoxLayout, QWidget
from typing_extensions import override

from processing.core.errors import UserError
from processing.core.text import Language, Text
from processing.methods.classes.pulse_occlusion import PulseOcclusion
from processing.methods.waveforms.pulse_grad_cam import PulseGradCam
from processing.recording.shown_pulse import ShownPulse, pulse_behind
from widgets.mouse_tools.tracing import BackgroundRunner
from widgets.panels.waveform.occlusion_box import AskedPoint, OcclusionBox
from widgets.panels.waveform.pulse_plot import PulsePlot, PulseWords
from widgets.parts.scrolled import make_scrollable
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_CLICK = Text(
    "Click a measured point to see its waveform.", "計測点をクリックすると波形を表示します。"
)
_COUNTS = Text("Counts", "カウント値")
_VOLTS = Text("Volts", "電圧 (V)")
_TIME = Text("Time from the first sample (ns)", "先頭サンプルからの時間 (ns)")
_ALONG = Text("Along the ray from the first sample (m)", "照射方向の距離・先頭サンプルから (m)")
_RANGE = Text("Range from the sensor (m)", "センサからの距離 (m)")
_BASELINE = Text("baseline {value}", "ベースライン {value}")
_PULSE = Text(
    "Pulse {number:,} of {count:,} · return {this} of {all} · {samples} samples of {bits} bits, "
    "{interval:g} ns apart",
    "パルス {number:,}／{count:,} · リターン {this}／{all} · {bits}ビット×{samples}サンプル、"
    "{interval:g} ns間隔",
)
_RETURN = Text(
    "{this}: height {height:.3f} m · {place:.2f} ns · amplitude {amplitude} · width {width} ns · "
    "energy {energy} · rise {rise} ns",
    "{this}: 高さ {height:.3f} m · {place:.2f} ns · 振幅 {amplitude} · 幅 {width} ns · "
    "エネルギー {energy} · 立ち上がり {rise} ns",
)
_NOT_KNOWN = "–"
_PLOT_SHARE = 3
_WIDE = 1.5
"""So much wider than high, a panel has its facts beside the plot."""


class PulsePanel(QWidget):
    """Follows the cursor while it can be seen.

    Parameters
    ----------
    source : MapSource
    shared : SharedState
    in_background : BackgroundRunner
        Asks the model of a class what it looked at.
    language : Language
    """

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        in_background: BackgroundRunner,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._source, self._cursor, self._language = source, shared.cursor, language
        self._is_stale = True
        self._message = QLabel(self)
        self._message.setWordWrap(True)
        self._message.setAlignment(Qt.AlignmentFlag.AlignTop)
        self._message.setMargin(8)
        self._facts = QLabel(self)
        self._facts.setWordWrap(True)
        self._facts.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._facts.setAlignment(Qt.AlignmentFlag.AlignTop)
        self._facts.setMargin(4)
        self._scroll = make_scrollable(self._facts)
        self._scroll.setMinimumHeight(0)
        self._scroll.hide()
        self.occlusion_box = OcclusionBox(source, in_background, language, self)
        self.plot = PulsePlot(self._words(_ALONG), self)
        beside = QVBoxLayout()
        beside.setSpacing(0)
        beside.addWidget(self.occlusion_box)
        beside.addWidget(self._scroll, 1)
        beside.addStretch(0)
        self._layout = QBoxLayout(QBoxLayout.Direction.LeftToRight, self)
        self._layout.setContentsMargins(0, 0, 0, 0)
        self._layout.setSpacing(0)
        self._layout.addWidget(self._message, _PLOT_SHARE)
        self._layout.addWidget(self.plot, _PLOT_SHARE)
        self._layout.addLayout(beside, 1)
        self.occlusion_box.found.connect(self._on_occlusion_box_found)
        shared.cursor.moved.connect(self._on_cursor_moved)
        shared.map_changes.drives_changed.connect(self._on_map_drives_changed)
        shared.map_changes.labels_changed.connect(self._on_map_labels_changed)
        self._show_message(_CLICK)

    @override
    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if self._is_stale:
            self._show_point()

    @override
    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        # Below the image there is room beside the plot, at the side of the window below it.
        is_wide = self.width() > _WIDE * self.height()
        direction = QBoxLayout.Direction
        self._layout.setDirection(direction.LeftToRight if is_wide else direction.TopToBottom)

    def lines(self) -> tuple[str, ...]:
        """All that is written, from top to bottom."""
        shown = self._facts if self.plot.pulse is not None else self._message
        return tuple(shown.text().split("\n"))

    def _on_cursor_moved(self, _: PickedPosition) -> None:
        self._show_point_if_seen()

    def _on_map_drives_changed(self) -> None:
        self.occlusion_box.forget_work()
        self._show_point_if_seen()

    def _on_map_labels_changed(self, drive: str, points: NDArray[np.int64]) -> None:
        position = self._cursor.position
        if position is None or position.measured is None or position.measured.drive != drive:
            return
        if not points.size or position.measured.point in points:
            self._show_point_if_seen()

    def _on_occlusion_box_found(self, found: PulseOcclusion | PulseGradCam | None) -> None:
        self.plot.show_looked_at(found, has_room=self.occlusion_box.is_shown)

    def _show_point_if_seen(self) -> None:
        self._is_stale = True
        if self.isVisible():
            self._show_point()

    def _show_point(self) -> None:
        self._is_stale = False
        position = self._cursor.position
        if position is None or position.measured is None:
            self._show_message(_CLICK)
            return
        try:
            drive = self._source.drive(position.measured.drive)
            found = pulse_behind(drive, position.measured.point)
        except KeyError:  # the drive is gone, and the cursor is still where it was
            self._show_message(_CLICK)
            return
        except UserError as error:
            self._show_message(Text(error.line("en"), error.line("ja")))
            return
        if isinstance(found, Text):
            self._show_message(found)
        else:
            self._show_pulse(found)
            self.occlusion_box.show_point(AskedPoint(drive, position.measured.point))

    def _show_message(self, text: Text) -> None:
        self._message.setText(text.in_language(self._language))
        self._message.show()
        self.plot.show_pulse(None)
        self.plot.hide()
        self._scroll.hide()
        self.occlusion_box.show_point(None)

    def _show_pulse(self, pulse: ShownPulse) -> None:
        self._message.hide()
        self.plot.use_words(self._words(_RANGE if np.isfinite(pulse.range_m) else _ALONG))
        self.plot.show_pulse(pulse)
        self.plot.show()
        lines = [self._pulse_line(pulse)]
        lines += [self._return_line(pulse, number) for number in range(pulse.points.size)]
        self._facts.setText("\n".join(lines))
        self._scroll.show()

    def _pulse_line(self, pulse: ShownPulse) -> str:
        one = pulse.descriptor
        return _PULSE.filled(
            number=pulse.number + 1,
            count=pulse.count,
            this=pulse.chosen + 1,
            all=pulse.points.size,
            samples=one.samples,
            bits=one.bits,
            interval=one.interval_ns,
        ).in_language(self._language)

    def _return_line(self, pulse: ShownPulse, number: int) -> str:
        shapes = pulse.shapes
        return _RETURN.filled(
            this=number + 1,
            height=float(pulse.heights[number]),
            place=float(pulse.places_ns[number]),
            amplitude=_number(shapes.amplitude[number], 1),
            width=_number(shapes.width_ns[number], 2),
            energy=_number(shapes.energy[number], 0),
            rise=_number(shapes.rise_ns[number], 2),
        ).in_language(self._language)

    def _words(self, metres: Text) -> PulseWords:
        texts = (_COUNTS, _VOLTS, _TIME, metres, _BASELINE)
        return PulseWords(*(text.in_language(self._language) for text in texts))


def _number(value: float, decimals: int) -> str:
    return f"{value:,.{decimals}f}" if np.isfinite(value) else _NOT_KNOWN
