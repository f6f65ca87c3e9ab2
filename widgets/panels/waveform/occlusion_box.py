"""OcclusionBox: asks what a model of classes looked at in a pulse, and tells it in words."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor, QPixmap
from PySide6.QtWidgets import QCheckBox, QComboBox, QGridLayout, QLabel, QVBoxLayout, QWidget
from shiboken6 import isValid

from processing.core.monitor import SilentMonitor
from processing.core.text import Language, Text
from processing.methods.classes.pulse_occlusion import PulseOcclusion, occluded_pulse
from processing.methods.waveforms.pulse_grad_cam import PulseGradCam, grad_cam_of_pulse
from processing.project.store.runs import Run
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive
from processing.scoring.points.six_classes import SIX
from processing.tools.waveform_classify import WAVEFORM_CLASSIFY
from widgets.feature_drawing.swatch import SWATCH_PX
from widgets.mouse_tools.painting.paint_tool import class_name
from widgets.mouse_tools.tracing import BackgroundRunner
from widgets.panels.waveform.pulse_plot import ALONE, SEEN, TOGETHER
from widgets.shared.map_source import MapSource

_EXPLAINED = Text(
    "Hides 5 ns of the waveform at a time and asks again how likely the point’s class is. What is "
    "lost shows what the model looked at.",
    "波形を5 nsずつ隠して、点のクラスの確率を求め直します。確率が下がる所が、"
    "モデルの見ている所です。",
)
_EXPLAINED_GRAD_CAM = Text(
    "Shows where in this waveform a small network, which sees it alone, finds the point’s class. "
    "It is not the model that classifies.",
    "波形だけを見る小さなネットワークが、点のクラスを波形のどこに見いだしたかを示します。"
    "分類に使うモデルとは別のものです。",
)
_OCCLUSION = Text("Occlusion", "オクルージョン")
_GRAD_CAM = Text("Grad-CAM of the local network", "局所ネットワークのGrad-CAM")
_BY_NETWORK = Text(
    "{name}: {share} by the local network, which is not the model that classifies",
    "{name}: {share}（局所ネットワーク。分類に使うモデルとは別）",
)
_LIKELIEST = Text("; likeliest {name}, {share}", "。最も高いのは{name} {share}")
_SEEN = Text("where this waveform speaks for it", "波形がこのクラスを示すところ")
_NOWHERE = Text("nothing in this waveform speaks for it", "このクラスを示すところはありません")
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
    """A switch and a choice, and below what a class hangs on in the waveform.

    Asked is either the model that classifies, with parts of the waveform hidden, or the published
    local network, by Grad-CAM.

    Parameters
    ----------
    source : MapSource
    in_background : BackgroundRunner
        Asks the model beside the window; one point at a time, the newest next.
    language : Language

    Signals
    -------
    found(looked_at: PulseOcclusion, PulseGradCam or None)
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
        self._point: AskedPoint | None = None
        self._asked: AskedPoint | None = None
        self._at_work: AskedPoint | None = None
        self.switch = QCheckBox(self.tr("What the model looked at"), self)
        self.method = QComboBox(self)
        self.method.addItems([one.in_language(self._language) for one in (_OCCLUSION, _GRAD_CAM)])
        self.method.setSizeAdjustPolicy(
            QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
        )
        self._whole = self._label()
        self._keys = QGridLayout()
        self._keys.setVerticalSpacing(1)
        self._keys.setHorizontalSpacing(5)
        self._keys.setColumnStretch(1, 1)
        self._alone, self._alone_key = self._key(ALONE, SWATCH_PX)
        self._together, self._together_key = self._key(TOGETHER, _LINE_PX)
        self._seen, self._seen_key = self._key(SEEN, SWATCH_PX)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(4, 2, 4, 2)
        layout.setSpacing(1)
        for part in (self.switch, self.method, self._whole):
            layout.addWidget(part)
        layout.addLayout(self._keys)
        self.method.currentIndexChanged.connect(self._on_method_chosen)
        self.switch.toggled.connect(self._on_switch_toggled)
        self.show_point(None)

    @property
    def is_shown(self) -> bool:
        """Whether it is to be seen, and can be: room is kept for it."""
        return self.switch.isChecked() and self.switch.isEnabled()

    def lines(self) -> tuple[str, ...]:
        """What is written below the switch, from top to bottom."""
        labels = (self._whole, self._alone, self._together, self._seen)
        return tuple(one.text() for one in labels if one.isVisibleTo(self))

    def show_point(self, asked: AskedPoint | None) -> None:
        """Ask about another point, or the same one with another class; None without a waveform."""
        self._point = asked
        reason = _NO_WAVEFORM if asked is None else self._why_not(asked)
        # Another question even about the same point: the answer to the one before isn't taken.
        self._asked = AskedPoint(*asked) if asked is not None and reason is None else None
        explained = _EXPLAINED_GRAD_CAM if self._asks_network else _EXPLAINED
        self.switch.setEnabled(reason is None)
        self.switch.setToolTip((reason or explained).in_language(self._language))
        self.method.setEnabled(asked is not None)
        self._ask()

    def forget_work(self) -> None:
        """Other drives are open: what is being asked of those before is not waited for."""
        self._at_work = None

    @property
    def _asks_network(self) -> bool:
        return self.method.currentIndex() == 1

    def _on_method_chosen(self, _: int) -> None:
        self.show_point(self._point)

    def _on_switch_toggled(self, _: bool) -> None:  # noqa: FBT001 - Qt's signal
        self._ask()

    def _ask(self) -> None:
        self.found.emit(None)
        self._whole.setVisible(self.is_shown)
        self._show_keys()
        if not self.is_shown or self._asked is None:
            return
        self._whole.setText(_ASKING.in_language(self._language))
        if self._at_work is None:
            self._begin(self._asked)

    def _begin(self, asked: AskedPoint) -> None:
        work = self._question(asked)
        if work is None:
            return
        self._at_work = asked

        def take(found: object | None) -> None:
            # The window may have been built anew meanwhile, or the project closed and another open.
            if isValid(self) and self._at_work is asked:
                self._at_work = None
                self._take(asked, found)

        self._in_background(work, take)

    def _question(
        self, asked: AskedPoint
    ) -> Callable[[], PulseOcclusion | PulseGradCam | Text] | None:
        """What is done beside the window; None where no model can be asked any more."""
        if self._asks_network:
            return lambda: grad_cam_of_pulse(asked.drive, asked.point)
        run = self._last_run(asked.drive)
        if run is None:
            return None
        drives = [one for one in self._source.drives() if one.id in run.drives and one.count]
        return lambda: occluded_pulse(drives, asked.drive, asked.point, SilentMonitor())

    def _take(self, asked: AskedPoint, found: object | None) -> None:
        if not self.is_shown or self._asked is None:
            return
        if asked is not self._asked:
            self._begin(self._asked)
        elif isinstance(found, PulseOcclusion):
            self._tell(found)
            self.found.emit(found)
        elif isinstance(found, PulseGradCam):
            self._tell_seen(found)
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
        self._show_keys(self._alone_key, self._together_key)

    def _tell_seen(self, found: PulseGradCam) -> None:
        words = _BY_NETWORK.filled(name=class_name(found.code), share=f"{found.share:.0%}")
        told = words.in_language(self._language)
        if found.likeliest != found.code:
            name, share = class_name(found.likeliest), f"{found.likeliest_share:.0%}"
            told += _LIKELIEST.filled(name=name, share=share).in_language(self._language)
        self._whole.setText(told)
        seen = _SEEN if found.seen.any() else _NOWHERE
        self._seen.setText(seen.in_language(self._language))
        self._show_keys(self._seen_key)

    def _show_keys(self, *shown: QWidget) -> None:
        rows = {self._alone_key: self._alone, self._together_key: self._together}
        for key, words in {**rows, self._seen_key: self._seen}.items():
            key.setVisible(key in shown)
            words.setVisible(key in shown)

    def _key(self, colour: str, height: int) -> tuple[QLabel, QLabel]:
        """Words, and the swatch beside them."""
        words, swatch = self._label(), QLabel(self)
        picture = QPixmap(SWATCH_PX, height)
        picture.fill(QColor(colour))
        swatch.setPixmap(picture)
        swatch.setFixedHeight(words.fontMetrics().lineSpacing())
        row = self._keys.rowCount()
        self._keys.addWidget(swatch, row, 0, Qt.AlignmentFlag.AlignTop)
        self._keys.addWidget(words, row, 1)
        return words, swatch

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
        if self._asks_network:
            return None
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
