"""CameraBar: which image is shown, the others that see the place, and what clicks do."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QSizePolicy, QToolButton, QWidget

from widgets.camera_view.view import CameraView
from widgets.parts.icon_button import IconButton

_WIDEST_PX = 320
_MOST_ROOM = 1000


class CameraBar(QWidget):
    """The line above the camera image.

    Parameters
    ----------
    view : CameraView

    Signals
    -------
    calibration_toggled(bool)
        The form of the camera's offsets is wanted, or no more.
    """

    calibration_toggled = Signal(bool)

    def __init__(self, view: CameraView, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._view = view
        self._before = self._button("‹", self.tr("The image before in the list (Page Up or [)"))
        self._after = self._button("›", self.tr("The next image in the list (Page Down or ])"))
        self._images = QComboBox(self)
        self._images.setToolTip(self.tr("The images that see the place, best first"))
        # Long names of files don't make the dock wider: there is a list to read them in.
        shorter = QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
        self._images.setSizeAdjustPolicy(shorter)
        self._images.setMinimumContentsLength(12)
        self._images.setMaximumWidth(_WIDEST_PX)
        self._images.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        # Page up and down go through the images as well: the view keeps the keys.
        self._images.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._stereo = IconButton(
            "mdi6.binoculars",
            self.tr("Stereo"),
            self.tr("Measure a place by two images where points are missing"),
            self,
            is_switch=True,
        )
        self._calibration = IconButton(
            "mdi6.camera-control",
            self.tr("Calibration"),
            self.tr("Adjust how the camera sits on the vehicle"),
            self,
            is_switch=True,
        )
        self._lay_out()
        self._before.clicked.connect(self._on_before_clicked)
        self._after.clicked.connect(self._on_after_clicked)
        self._images.activated.connect(view.show_sighting)
        self._stereo.toggled.connect(view.set_stereo)
        self._calibration.toggled.connect(self.calibration_toggled)
        view.sightings_changed.connect(self._show)
        view.stereo_changed.connect(self._show)
        self._show()

    def check_calibration(self, wanted: bool) -> None:  # noqa: FBT001 - as a click on the button
        """Ask for the form of offsets, or for its end."""
        self._calibration.setChecked(wanted)

    def _lay_out(self) -> None:
        layout = QHBoxLayout(self)
        layout.setContentsMargins(4, 0, 4, 4)
        layout.setSpacing(4)
        layout.addWidget(self._before)
        layout.addWidget(self._images, _MOST_ROOM)
        layout.addWidget(self._after)
        layout.addStretch(1)
        layout.addWidget(self._stereo)
        layout.addWidget(self._calibration)

    def _button(self, text: str, tip: str) -> QToolButton:
        button = QToolButton(self)
        button.setText(text)
        button.setToolTip(tip)
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        return button

    def _show(self) -> None:
        showing = self._view.showing
        count = len(showing.sightings)
        plain = self.tr("{number}/{count}  {name} · {distance} m")
        hidden = self.tr("{number}/{count}  {name} · {distance} m (hidden)")
        words = [
            (hidden if one.is_hidden else plain).format(
                number=i + 1,
                count=count,
                name=one.image.path.stem,
                distance=f"{one.distance_m:.0f}",
            )
            for i, one in enumerate(showing.sightings)
        ]
        if words != [self._images.itemText(i) for i in range(self._images.count())]:
            with QSignalBlocker(self._images):
                self._images.clear()
                self._images.addItems(words)
        with QSignalBlocker(self._images):
            self._images.setCurrentIndex(showing.index)
        has_image = showing.taken is not None
        is_other = showing.index < 0 and has_image
        self._images.setPlaceholderText(
            showing.taken.image.path.stem if showing.taken and is_other else self.tr("No image")
        )
        self._images.setEnabled(count > 0)
        self._before.setEnabled(count > 1)
        self._after.setEnabled(count > 1)
        for button in (self._stereo, self._calibration):
            button.setEnabled(has_image or button.isChecked())
        with QSignalBlocker(self._stereo):
            self._stereo.setChecked(self._view.is_stereo)

    def _on_before_clicked(self) -> None:
        self._view.step(-1)

    def _on_after_clicked(self) -> None:
        self._view.step(1)
