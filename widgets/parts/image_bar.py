"""ImageBar: which drive, kind of image and attribute are shown, and with what contrast."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QSpinBox, QToolButton, QWidget

from processing.image.attributes import ATTRIBUTES, available
from processing.image.kinds import ImageKind
from processing.text import Language
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState


class ImageBar(QWidget):
    """The line above the image; what it sets is shared by all views."""

    one_to_one_requested = Signal()
    everything_requested = Signal()

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._settings = shared.view_settings
        self._language = language
        self._drive = QComboBox(self)
        self._kind = QComboBox(self)
        self._attribute = QComboBox(self)
        self._low = self._percent(self.tr("Darker end of the contrast, percentile"))
        self._high = self._percent(self.tr("Brighter end of the contrast, percentile"))
        for box in (self._drive, self._kind, self._attribute):
            box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        self._lay_out()
        self._drive.activated.connect(self._on_drive_activated)
        self._kind.activated.connect(self._on_kind_activated)
        self._attribute.activated.connect(self._on_attribute_activated)
        self._low.valueChanged.connect(self._on_contrast_changed)
        self._high.valueChanged.connect(self._on_contrast_changed)
        shared.map_changes.drives_changed.connect(self._show)
        shared.map_changes.drive_columns_changed.connect(self._show)
        self._settings.image_changed.connect(self._show)
        self._settings.look_changed.connect(self._show)
        self._show()

    def _lay_out(self) -> None:
        whole = QToolButton(self)
        whole.setText(self.tr("Whole"))
        whole.setToolTip(self.tr("Show the whole recording (Home)"))
        whole.clicked.connect(self.everything_requested)
        one = QToolButton(self)
        one.setText("1:1")
        one.setToolTip(self.tr("One pixel of the image on one of the screen"))
        one.clicked.connect(self.one_to_one_requested)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(8, 0, 8, 0)
        layout.setSpacing(8)
        layout.addWidget(self._drive)
        layout.addWidget(self._kind)
        layout.addWidget(self._attribute)
        layout.addWidget(QLabel(self.tr("Contrast"), self))
        layout.addWidget(self._low)
        layout.addWidget(self._high)
        layout.addStretch(1)
        layout.addWidget(whole)
        layout.addWidget(one)

    def _percent(self, tip: str) -> QSpinBox:
        box = QSpinBox(self)
        box.setRange(0, 100)
        box.setSuffix(" %")
        box.setToolTip(tip)
        box.setKeyboardTracking(False)
        return box

    def _show(self) -> None:
        settings, look = self._settings, self._settings.look
        drives = {drive.id: drive for drive in self._source.drives()}
        drive = drives.get(settings.drive_id)
        _fill(self._drive, [(d.info.name, d.id) for d in drives.values()], settings.drive_id)
        kinds = drive.image_kinds if drive else ()
        _fill(
            self._kind,
            [(kind.title.spoken(self._language), kind.value) for kind in kinds],
            settings.image_kind.value,
        )
        names = available(drive) if drive else ()
        _fill(
            self._attribute,
            [(ATTRIBUTES[name].title.spoken(self._language), name) for name in names],
            look.attribute,
        )
        for box, value in ((self._low, look.low_percent), (self._high, look.high_percent)):
            with QSignalBlocker(box):  # the model changed, not the user
                box.setValue(round(value))
        self.setEnabled(drive is not None)

    def _on_drive_activated(self) -> None:
        drive = self._source.drive(str(self._drive.currentData()))
        kind = self._settings.image_kind
        kinds = drive.image_kinds
        self._settings.show_image(drive.id, kind if kind in kinds else kinds[0])

    def _on_kind_activated(self) -> None:
        kind = ImageKind(str(self._kind.currentData()))
        self._settings.show_image(self._settings.drive_id, kind)

    def _on_attribute_activated(self) -> None:
        self._settings.change_look(attribute=str(self._attribute.currentData()))

    def _on_contrast_changed(self) -> None:
        low, high = self._low.value(), self._high.value()
        if low < high:
            self._settings.change_look(low_percent=float(low), high_percent=float(high))


def _fill(box: QComboBox, entries: list[tuple[str, str]], current: str) -> None:
    shown = [(box.itemText(i), str(box.itemData(i))) for i in range(box.count())]
    if shown != entries:
        box.clear()
        for title, value in entries:
            box.addItem(title, value)
    index = box.findData(current)
    if index >= 0:
        box.setCurrentIndex(index)
