"""DrawingBar: what is drawn and how, what the tool expects next, and what is measured."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QLocale, QSize, Qt, Signal
from PySide6.QtGui import QFont, QIcon
from PySide6.QtWidgets import (
    QDoubleSpinBox,
    QHBoxLayout,
    QLabel,
    QToolButton,
    QWidget,
)

from processing.core.text import Language, Text
from processing.map.catalogue import FeatureKind
from processing.map.drafting.measuring import Measure
from widgets.feature_drawing.swatch import SWATCH_PX, swatch_of
from widgets.parts.class_chips import ClassChips
from widgets.parts.elided_label import ElidedLabel
from widgets.parts.literal_text import literal
from widgets.shared.shared_state import SharedState
from widgets.shared.snap_state import SNAP_NAMES, SnapMode

_FARTHEST_M = 999.0
_HIGHEST_M = 99.0
_MEASURING, _PAINTING = "measure", "paint-"
_NO_SNAP = Text("no snapping", "スナップなし")
_ON_PLANE = Text("working plane", "作業平面")
_SNAP = Text("Snap: {names}", "スナップ: {names}")
_NO_KIND = Text("What to draw…", "作図する種別…")
_DISTANCE = Text("Distance", "距離")
_AT_MOUSE = Text("at the mouse", "マウス位置")
_RISE = Text("Rise", "比高")


class DrawingBar(QWidget):
    """A line above the views, in step with the toolbox and the snap state.

    Parameters
    ----------
    shared : SharedState
    hints : mapping of str to Text
        What each tool expects, by the tool's name.
    language : Language

    Signals
    -------
    kind_wanted
        The button of the kind was pressed.
    snaps_wanted
        The words about snapping were pressed.
    entered
        Enter in a field: what is in the hand is to be done.
    distance_set(metres: float), rise_set(metres: float)
        The distance of parallel copies, 0 for the mouse's; how much higher they run.
    """

    kind_wanted = Signal()
    snaps_wanted = Signal()
    entered = Signal()
    distance_set = Signal(float)
    rise_set = Signal(float)

    def __init__(
        self,
        shared: SharedState,
        hints: Mapping[str, Text],
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._shared = shared
        self._hints = hints
        self._language: Language = language
        self._kind_name = _NO_KIND
        self._kind = QToolButton(self)
        self._kind.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self._kind.setIconSize(QSize(SWATCH_PX, SWATCH_PX))
        self._kind.setToolTip(self.tr("What is drawn: choose by name (Ctrl+K) or number key"))
        self._kind.clicked.connect(self.kind_wanted)
        self._classes = ClassChips(shared.labels, language, self)
        self._snaps = QToolButton(self)
        self._snaps.setAutoRaise(True)
        self._snaps.setToolTip(self.tr("What clicks snap to (Alt+1 to Alt+7)"))
        self._snaps.clicked.connect(self.snaps_wanted)
        self._words = ElidedLabel(self)
        self._distance_name = QLabel(_DISTANCE.in_language(language), self)
        self._distance = self._metres_field(
            0.0, self.tr("Distance of the parallel copy; 0: where the mouse is")
        )
        self._distance.setSpecialValueText(_AT_MOUSE.in_language(language))
        self._distance.valueChanged.connect(self.distance_set)
        self._rise_name = QLabel(_RISE.in_language(language), self)
        self._rise = self._metres_field(
            -_HIGHEST_M, self.tr("How much higher the copy runs: the upper edge of a curb")
        )
        self._rise.valueChanged.connect(self.rise_set)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(8, 0, 8, 4)
        layout.setSpacing(8)
        layout.addWidget(self._kind)
        layout.addWidget(self._classes)
        layout.addWidget(self._distance_name)
        layout.addWidget(self._distance)
        layout.addWidget(self._rise_name)
        layout.addWidget(self._rise)
        layout.addWidget(self._words, 1)
        layout.addWidget(self._snaps)
        # As high as with its fields, so that the views stay where they are when these come.
        self.setFixedHeight(self._distance.sizeHint().height() + 4)
        shared.snap.modes_changed.connect(self._show_snaps)
        shared.snap.plane_changed.connect(self._show_snaps)
        self.show_kind(None)
        self.show_tool("select")
        self._show_snaps()

    @property
    def words(self) -> str:
        """What the tool expects, or what is measured."""
        return self._words.text()

    @property
    def kind_name(self) -> str:
        """What the button says is drawn."""
        return self._kind_name.in_language(self._language)

    def choose_kind(self) -> None:
        """Ask for the list of kinds."""
        self.kind_wanted.emit()

    def show_kind(self, kind: FeatureKind | None) -> None:
        """Say what is drawn."""
        self._kind_name = _NO_KIND if kind is None else kind.name
        self._kind.setText(literal(self.kind_name))
        self._kind.setIcon(QIcon() if kind is None else swatch_of(kind.colour))

    def show_tool(self, name: str) -> None:
        """Say what a tool expects; only parallel copies have a distance, measures have no kind.

        Paint tools have classes in place of a kind, and snap to nothing.
        """
        self._tool = name
        is_painting = name.startswith(_PAINTING)
        self._kind.setVisible(not is_painting and not name.startswith(_MEASURING))
        self._classes.setVisible(is_painting)
        self._snaps.setVisible(not is_painting)
        is_parallel = name == "parallel"
        for part in (self._distance_name, self._distance, self._rise_name, self._rise):
            part.setVisible(is_parallel)
        hint = self._hints.get(name, Text("", ""))
        self._words.setText(hint.in_language(self._language))

    def show_measures(self, measures: tuple[Measure, ...]) -> None:
        """Say what is measured; nothing: what the tool expects."""
        if not measures:
            self.show_tool(self._tool)
            return
        self._words.setText("   ".join(self._write_measure(measure) for measure in measures))

    def _write_measure(self, measure: Measure) -> str:
        locale = QLocale()
        value = locale.toString(measure.value, "f", measure.decimals)
        return f"{measure.name.in_language(self._language)} {value} {measure.unit}".rstrip()

    def _metres_field(self, low_m: float, tip: str) -> QDoubleSpinBox:
        field = QDoubleSpinBox(self)
        field.setRange(low_m, _FARTHEST_M)
        field.setDecimals(3)
        field.setSingleStep(0.05)
        field.setSuffix(" m")
        field.setToolTip(tip)
        field.setKeyboardTracking(False)
        field.lineEdit().returnPressed.connect(self.entered)
        font = QFont(self.font())
        font.setFeature(QFont.Tag("tnum"), 1)
        field.setFont(font)
        return field

    def _show_snaps(self) -> None:
        snap = self._shared.snap
        names = [
            SNAP_NAMES[mode].in_language(self._language) for mode in SnapMode if mode in snap.modes
        ]
        if snap.plane is not None:
            names = [_ON_PLANE.in_language(self._language), *names]
        joined = ", ".join(names) if names else _NO_SNAP.in_language(self._language)
        self._snaps.setText(_SNAP.filled(names=joined).in_language(self._language))
