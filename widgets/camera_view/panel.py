"""CameraPanel: the camera view with the line above it and the form of offsets below."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QVBoxLayout, QWidget

from processing.core.text import Language
from widgets.camera_view.camera_bar import CameraBar
from widgets.camera_view.offset_form import OffsetForm
from widgets.camera_view.view import CameraView
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState


class CameraPanel(QWidget):
    """What stands in the camera's dock.

    Signals
    -------
    offsets_save_requested(offsets: dict of str to CameraOffset)
        To be kept for all drives that have images of these cameras.

    Attributes
    ----------
    view : CameraView
    """

    offsets_save_requested = Signal(object)

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        parent: QWidget | None = None,
        *,
        language: Language = "en",
    ) -> None:
        super().__init__(parent)
        self.view = CameraView(source, shared, self, language=language)
        self._bar = CameraBar(self.view, self)
        self._form = OffsetForm(self.view, shared.cursor, language, self)
        self._form.hide()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self._bar)
        layout.addWidget(self.view, 1)
        layout.addWidget(self._form)
        self.setFocusProxy(self.view)
        self._bar.calibration_toggled.connect(self._on_bar_calibration_toggled)
        self._form.save_requested.connect(self.offsets_save_requested)

    @property
    def form(self) -> OffsetForm:
        """The form of offsets."""
        return self._form

    def show_calibration(self, wanted: bool) -> None:  # noqa: FBT001 - a slot of a checked action
        """Show the form of offsets, or hide it."""
        self._bar.check_calibration(wanted)

    def show_kept_offsets(self) -> None:
        """Offsets were kept or changed elsewhere: images and form show those that count now."""
        self._form.show_kept()

    def _on_bar_calibration_toggled(self, wanted: bool) -> None:  # noqa: FBT001 - Qt's signal
        self._form.setVisible(wanted)
        if wanted:
            self._form.begin()
        else:
            self._form.end()
