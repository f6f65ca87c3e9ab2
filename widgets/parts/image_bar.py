"""ImageBar: which drive, kind of image and attribute are shown, and with what contrast."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QSpinBox, QToolButton, QWidget

from processing.core.text import Language
from widgets.pictures.image_view_settings import ImageViewSettings
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState


class ImageBar(QWidget):
    """The line above the image; what it sets is shared by all views.

    Signals
    -------
    one_to_one_requested, everything_requested
        Of the image.
    another_requested
        One more image is to be shown beside.
    """

    one_to_one_requested = Signal()
    everything_requested = Signal()
    another_requested = Signal()

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._settings = shared.view_settings
        self._choice = ImageViewSettings(
            source, shared.map_changes, self._settings, self, language=language
        )
        self._choice.let_shrink()  # a toolbar hides all of it where it finds no room
        self._low = self._percent(self.tr("Darker end of the contrast, percentile"))
        self._high = self._percent(self.tr("Brighter end of the contrast, percentile"))
        self._another = self._button("+", self.tr("Show another image beside this one"))
        self._lay_out()
        self._low.valueChanged.connect(self._on_contrast_changed)
        self._high.valueChanged.connect(self._on_contrast_changed)
        self._another.clicked.connect(self.another_requested)
        shared.map_changes.drives_changed.connect(self._show)
        self._settings.image_changed.connect(self._show)
        self._settings.look_changed.connect(self._show)
        self._show()

    def allow_another(self, is_allowed: bool) -> None:  # noqa: FBT001 - a slot of a signal
        """Offer one more image, or don't."""
        self._another.setEnabled(is_allowed)

    def _lay_out(self) -> None:
        whole = self._button(self.tr("Whole"), self.tr("Show the whole recording (Home)"))
        whole.clicked.connect(self.everything_requested)
        one = self._button("1:1", self.tr("One pixel of the image on one of the screen"))
        one.clicked.connect(self.one_to_one_requested)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(8, 0, 8, 0)
        layout.setSpacing(8)
        layout.addWidget(self._choice)
        layout.addWidget(QLabel(self.tr("Contrast"), self))
        layout.addWidget(self._low)
        layout.addWidget(self._high)
        layout.addStretch(1)
        layout.addWidget(whole)
        layout.addWidget(one)
        layout.addWidget(self._another)

    def _button(self, text: str, tip: str) -> QToolButton:
        button = QToolButton(self)
        button.setText(text)
        button.setToolTip(tip)
        return button

    def _percent(self, tip: str) -> QSpinBox:
        box = QSpinBox(self)
        box.setRange(0, 100)
        box.setSuffix(" %")
        box.setToolTip(tip)
        box.setKeyboardTracking(False)
        return box

    def _show(self) -> None:
        look = self._settings.look
        for box, value in ((self._low, look.low_percent), (self._high, look.high_percent)):
            with QSignalBlocker(box):  # the model changed, not the user
                box.setValue(round(value))
        self.setEnabled(self._choice.drive is not None)

    def _on_contrast_changed(self) -> None:
        low, high = self._low.value(), self._high.value()
        if low < high:
            self._settings.change_look(low_percent=float(low), high_percent=float(high))
