"""OcclusionBox: asks what the classes of a flight looked at in a pulse, and tells it in words."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor, QPixmap
from PySide6.QtWidgets import QCheckBox, QGridLayout, QLabel, QVBoxLayout, QWidget
from shiboken6 import isValid

from processing.core.monitor import SilentMonitor
from processing.core.text import Language, Text
from processing.methods.classes.pulse_occlusion import PulseOcclusion, occluded_pulse
from processing.project.store.runs import Run
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive
from processing.scoring.points.six_classes import SIX
from processing.tools.waveform_classify import WAVEFORM_CLASSIFY
from widgets.feature_drawing.swatch import SWATCH_PX
from widgets.mouse_tools.painting.paint_tool import class_name
from widgets.mouse_tools.tracing import BackgroundRunner
from widgets.panels.waveform.pulse_plot import ALONE, TOGETHER
from widgets.shared.map_source import MapSource

_EXPLAINED = Text(
    "Hides 5 ns of the waveform at a time and asks again how likely the point’s class is. What is "
    "lost shows what the model looked at.",
    "波形を5 nsずつ隠して、点のクラスの確率を求め直します。確率が下がる所が、"
    "モデルの見ている所です。",
)
_NO_WAVEFORM = Text("There is no waveform here.", "ここには波形がありません。")
_NOT_RUN = Text(
    "This flight has no classes yet: run “{tool}”.",
    "このデータは未分類です。「{tool}」を実行してください。",
).filled(tool=WAVEFORM_CLASSIFY.name)
_BY_POINTS = Text(
    "This flight was classified from points alone: the model saw no waveform.",
    "このデータは点のみから分類されています。モデルは波形を使っていません。",
)
_NO_CLASS = Text(
    "This point has none of the six classes of flights.",
    "この点には、航空計測の6クラスが付いていません。",
)
_ASKING = Text("Asking the model …", "モデルに問い合わせています…")
_WHOLE = Text("{name}: {share} with the whole waveform", "{name}: {share}（波形全体）")
_ALONE = Text("a part of this pulse hidden: {change}", "このパルスの一部を隠すと {change}")
_TOGETHER = Text("in the pulses around, too: {change}", "周囲のパルスでも隠すと {change}")
_CHANGE = Text("{share} ({first:.0f}–{last:.0f} ns)", "{share}（{first:.0f}–{last:.0f} ns）")
_NONE = Text("no change", "変化なし")
_LINE_PX = 3
_LEAST = 0.01
"""Less is not told: a probability is written in whole percent."""


class AskedPoint(NamedTuple):
    """A point whose class the model is asked for."""

    drive: Drive
    point: int


class OcclusionBox(QWidget):
    """A switch, and below it how much of the class' probability hangs on the waveform.

    Parameters
    ----------
    source : MapSource
    in_background : BackgroundRunner
        Asks the model beside the window; one point at a time, the newest next.
    language : Language

    Signals
    -------
    found(occlusion: PulseOcclusion or None)
        What is to be drawn below the waveform; None while nothing is known.
    """

    found = Signal(object)

    def __init__(
        self,
        source: MapSource,
        in_background: BackgroundRunner,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._source, self._in_background = source, in_background
        self._language: Language = language
        self._asked: AskedPoint | None = None
        self._at_work: AskedPoint | None = None
        self.switch = QCheckBox(self.tr("What the model looked at"), self)
        self._whole = self._label()
        self._key = QWidget(self)
        self._alone, self._together = self._label(), self._label()
        key = QGridLayout(self._key)
        key.setContentsMargins(0, 0, 0, 0)
        key.setVerticalSpacing(1)
        key.setColumnStretch(1, 1)
        for row, (words, colour, height) in enumerate(
            ((self._alone, ALONE, SWATCH_PX), (self._together, TOGETHER, _LINE_PX))
        ):
            swatch = QLabel(self._key)
            picture = QPixmap(SWATCH_PX, height)
            picture.fill(QColor(colour))
            swatch.setPixmap(picture)
            swatch.setFixedHeight(words.fontMetrics().lineSpacing())
            key.addWidget(swatch, row, 0, Qt.AlignmentFlag.AlignTop)
            key.addWidget(words, row, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(4, 2, 4, 2)
        layout.setSpacing(1)
        for part in (self.switch, self._whole, self._key):
            layout.addWidget(part)
        self.switch.toggled.connect(self._on_switch_toggled)
        self.show_point(None)

    @property
    def is_shown(self) -> bool:
        """Whether it is to be seen, and can be: room is kept for it."""
        return self.switch.isChecked() and self.switch.isEnabled()

    def lines(self) -> tuple[str, ...]:
        """What is written below the switch, from top to bottom."""
        labels = (self._whole, self._alone, self._together)
        return tuple(one.text() for one in labels if one.isVisibleTo(self))

    def show_point(self, asked: AskedPoint | None) -> None:
        """Ask about another point, or the same one with another class; None without a waveform."""
        reason = _NO_WAVEFORM if asked is None else self._why_not(asked)
        self._asked = asked if reason is None else None
        self.switch.setEnabled(reason is None)
        self.switch.setToolTip((reason or _EXPLAINED).in_language(self._language))
        self._ask()

    def forget_work(self) -> None:
        """Other drives are open: what is being asked of those before is not waited for."""
        self._at_work = None

    def _on_switch_toggled(self, _: bool) -> None:  # noqa: FBT001 - Qt's signal
        self._ask()

    def _ask(self) -> None:
        self.found.emit(None)
        self._whole.setVisible(self.is_shown)
        self._key.hide()
        if not self.is_shown or self._asked is None:
            return
        self._whole.setText(_ASKING.in_language(self._language))
        if self._at_work is None:
            self._begin(self._asked)

    def _begin(self, asked: AskedPoint) -> None:
        run = self._last_run(asked.drive)
        if run is None:
            return
        self._at_work = asked
        drives = [one for one in self._source.drives() if one.id in run.drives and one.count]

        def work() -> PulseOcclusion | Text:
            return occluded_pulse(drives, asked.drive, asked.point, SilentMonitor())

        def take(found: object | None) -> None:
            # The window may have been built anew meanwhile, or the project closed and another open.
            if isValid(self) and self._at_work is asked:
                self._at_work = None
                self._take(asked, found)

        self._in_background(work, take)

    def _take(self, asked: AskedPoint, found: object | None) -> None:
        if not self.is_shown or self._asked is None:
            return
        if asked is not self._asked:
            self._begin(self._asked)
        elif isinstance(found, PulseOcclusion):
            self._tell(found)
            self.found.emit(found)
        else:  # why it failed the window tells
            words = found.in_language(self._language) if isinstance(found, Text) else ""
            self._whole.setText(words)

    def _tell(self, found: PulseOcclusion) -> None:
        whole = _WHOLE.filled(name=class_name(found.code), share=f"{found.share:.0%}")
        alone = _ALONE.filled(change=self._change(found, found.drops))
        together = _TOGETHER.filled(change=self._change(found, found.drops_together))
        labels = (self._whole, self._alone, self._together)
        for label, words in zip(labels, (whole, alone, together), strict=True):
            label.setText(words.in_language(self._language))
        self._key.show()

    def _label(self) -> QLabel:
        label = QLabel(self)
        label.setWordWrap(True)
        label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        return label

    def _change(self, found: PulseOcclusion, drops: NDArray[np.float32]) -> Text:
        at = int(np.abs(drops).argmax())
        if abs(drops[at]) < _LEAST:
            return _NONE
        first = float(found.starts_ns[at])
        share = f"{found.share - float(drops[at]):.0%}"
        return _CHANGE.filled(share=share, first=first, last=first + found.window_ns)

    def _why_not(self, asked: AskedPoint) -> Text | None:
        """Why the model can't be asked about a point with a waveform."""
        run = self._last_run(asked.drive)
        if run is None:
            return _NOT_RUN
        if not run.parameters.get("uses_waveforms", True):
            return _BY_POINTS
        code = int(class_columns(asked.drive.columns).codes_of(np.array([asked.point]))[0])
        return None if code in SIX else _NO_CLASS

    def _last_run(self, drive: Drive) -> Run | None:
        """The run that classified a drive last."""
        runs = reversed(self._source.runs())
        is_asked = (one for one in runs if one.tool == WAVEFORM_CLASSIFY.id)
        return next((one for one in is_asked if drive.id in one.drives), None)
