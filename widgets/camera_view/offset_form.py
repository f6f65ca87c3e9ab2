"""OffsetForm: how a camera sits differently from how it was delivered, by hand or by points."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from processing.core.errors import Unsuitable
from processing.core.text import Language
from processing.recording.camera_images.calibration import (
    NO_OFFSET,
    CameraOffset,
    PixelPair,
    estimate_offset,
    residuals_px,
)
from processing.recording.camera_images.image_list import CameraImage, ImageList
from processing.recording.camera_images.image_remarks import outside_trajectory
from widgets.camera_view.taken_images import TakenImage
from widgets.camera_view.view import CameraView
from widgets.parts.number_field import NumberField
from widgets.shared.cursor import Cursor, PickedPosition

_TURN_DEG, _TURN_STEP_DEG = 45.0, 0.05
_SHIFT_M, _SHIFT_STEP_M = 20.0, 0.01
_TIME_S, _TIME_STEP_S = 60.0, 0.005


class OffsetForm(QWidget):
    """Changes show in the image at once; they are kept by Save.

    Parameters
    ----------
    view : CameraView
        Shows what is tried out, and gives the pixels of pairs.
    cursor : Cursor
        Gives their true places.

    Signals
    -------
    save_requested(offsets: dict of str to CameraOffset)
        By camera; those of other cameras stay as they are.
    """

    save_requested = Signal(object)

    def __init__(
        self, view: CameraView, cursor: Cursor, language: Language, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._view = view
        self._language = language
        self._camera = ""
        self._tried: dict[str, CameraOffset] = {}
        self._pixel: tuple[CameraImage, tuple[float, float]] | None = None
        self._pairs: dict[str, list[PixelPair]] = {}
        self._title = QLabel(self)
        self._facts = QLabel(self)
        self._facts.setWordWrap(True)
        self._fields = self._made_fields()
        self._points = QPushButton(self.tr("From points"), self)
        self._points.setCheckable(True)
        self._points.setToolTip(
            self.tr("Click a thing in the image, then the same thing in another view; repeat.")
        )
        self._drop = QPushButton(self.tr("Drop last pair"), self)
        self._estimate = QPushButton(self.tr("Estimate"), self)
        self._reset = QPushButton(self.tr("As delivered"), self)
        self._save = QPushButton(self.tr("Save"), self)
        self._lay_out()
        self._connect(cursor)
        self._show()

    @property
    def pairs(self) -> tuple[PixelPair, ...]:
        """The pairs of the camera at hand."""
        return tuple(self._pairs.get(self._camera, ()))

    def end(self) -> None:
        """Show images as they are kept; what was not saved is dropped, pairs stay."""
        self._points.setChecked(False)
        self._pixel = None
        self._tried = {}
        self._view.try_offsets({})

    def show_kept(self) -> None:
        """What was to be saved is kept now: nothing is tried out any more."""
        self._tried = {}
        self._view.try_offsets({})
        self._show()

    def begin(self) -> None:
        """Show the offset of the camera at hand."""
        self._show()

    def _made_fields(self) -> dict[str, NumberField]:
        turns = (_TURN_DEG, _TURN_STEP_DEG, "°")
        shifts = (_SHIFT_M, _SHIFT_STEP_M, "m")
        times = (_TIME_S, _TIME_STEP_S, "s")
        groups = {
            "roll_deg": turns,
            "pitch_deg": turns,
            "yaw_deg": turns,
            "right_m": shifts,
            "up_m": shifts,
            "forward_m": shifts,
            "time_s": times,
        }
        fields = {}
        for name, (limit, step, unit) in groups.items():
            field = NumberField(-limit, limit, unit=unit, decimals=3, parent=self)
            field.setSingleStep(step)
            field.valueChanged.connect(self._on_fields_changed)
            fields[name] = field
        return fields

    def _lay_out(self) -> None:
        names = {
            "roll_deg": self.tr("Roll"),
            "pitch_deg": self.tr("Pitch"),
            "yaw_deg": self.tr("Yaw"),
            "right_m": self.tr("Right"),
            "up_m": self.tr("Up"),
            "forward_m": self.tr("Forward"),
            "time_s": self.tr("Time"),
        }
        grid = QGridLayout()
        grid.setHorizontalSpacing(8)
        grid.setVerticalSpacing(4)
        for i, (name, title) in enumerate(names.items()):
            row, column = i % 3 if i < 6 else 0, 2 * (i // 3)
            grid.addWidget(QLabel(title, self), row, column)
            grid.addWidget(self._fields[name], row, column + 1)
        grid.setColumnStretch(6, 1)
        buttons = QHBoxLayout()
        buttons.setSpacing(4)
        for button in (self._points, self._drop, self._estimate):
            buttons.addWidget(button)
        buttons.addStretch(1)
        for button in (self._reset, self._save):
            buttons.addWidget(button)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 4, 8, 8)
        layout.setSpacing(4)
        layout.addWidget(self._title)
        layout.addLayout(grid)
        layout.addWidget(self._facts)
        layout.addLayout(buttons)

    def _connect(self, cursor: Cursor) -> None:
        self._points.toggled.connect(self._view.point_pixels)
        self._drop.clicked.connect(self._on_drop_clicked)
        self._estimate.clicked.connect(self._on_estimate_clicked)
        self._reset.clicked.connect(self._on_reset_clicked)
        self._save.clicked.connect(self._on_save_clicked)
        self._view.image_changed.connect(self._show)
        self._view.pixel_pointed.connect(self._on_view_pixel_pointed)
        cursor.moved.connect(self._on_cursor_moved)

    def _keep_offset(self, taken: TakenImage) -> CameraOffset:
        return taken.drive.camera_offsets.get(taken.camera, NO_OFFSET)

    def _offset(self) -> CameraOffset:
        return CameraOffset(**{name: field.value() for name, field in self._fields.items()})

    def _show(self) -> None:
        """The camera of the image that is shown, and what is tried out for it."""
        taken = self._view.showing.taken
        self.setEnabled(taken is not None)
        if taken is None:
            self._title.setText("")
            return
        self._camera = taken.camera
        self._title.setText(
            self.tr("Camera “{name}”: added to what was delivered").format(name=taken.camera)
        )
        offset = self._tried.get(taken.camera, self._keep_offset(taken))
        for name, field in self._fields.items():
            with QSignalBlocker(field):
                field.setValue(getattr(offset, name))
        self._fields["time_s"].setEnabled(taken.drive.trajectory is not None)
        self._show_facts(taken)

    def _show_facts(self, taken: TakenImage) -> None:
        pairs, trajectory = self.pairs, taken.drive.trajectory
        words = []
        if self._pixel is not None:
            words.append(self.tr("Now click the same thing in another view."))
        elif self._points.isChecked() and not pairs:
            words.append(self.tr("Click a thing in the image."))
        if pairs:
            off = residuals_px(pairs, self._offset(), trajectory)
            words.append(
                self.tr("%n pair(s), off by {each} px", None, len(pairs)).format(
                    each=" · ".join(f"{value:.1f}" for value in off)
                )
            )
        self._drop.setEnabled(bool(pairs) or self._pixel is not None)
        self._estimate.setEnabled(bool(pairs))
        offset = self._offset()
        covered = outside_trajectory(taken.drive.delivered_images or ImageList(()), trajectory)
        if offset.time_s and covered is not None:
            words.append(covered.in_language(self._language))
        self._facts.setText("   ".join(words))
        self._facts.setVisible(bool(words))
        self._reset.setEnabled(not offset.is_zero)
        self._save.setEnabled(bool(self._tried) and self._tried != self._all_kept(self._tried))

    def _all_kept(self, cameras: Mapping[str, CameraOffset]) -> dict[str, CameraOffset]:
        kept: dict[str, CameraOffset] = {}
        for drive in self._view.showing.images.drives:
            kept.update(drive.camera_offsets)
        return {camera: kept.get(camera, NO_OFFSET) for camera in cameras}

    def _try(self, offset: CameraOffset) -> None:
        self._tried[self._camera] = offset
        self._view.try_offsets(self._tried)
        self._show()

    def _on_fields_changed(self) -> None:
        if self._camera:
            self._try(self._offset())

    def _on_reset_clicked(self) -> None:
        self._try(NO_OFFSET)

    def _on_save_clicked(self) -> None:
        self.save_requested.emit(dict(self._tried))
        self._show()

    def _on_view_pixel_pointed(self, image: CameraImage, pixel: tuple[float, float]) -> None:
        self._pixel = image, pixel
        self._show()

    def _on_cursor_moved(self, position: PickedPosition) -> None:
        if self._pixel is None or not self._points.isChecked() or position.is_occluded:
            return
        image, pixel = self._pixel
        self._pixel = None
        self._pairs.setdefault(self._camera, []).append(PixelPair(image, pixel, position.xyz))
        self._show()

    def _on_drop_clicked(self) -> None:
        if self._pixel is not None:
            self._pixel = None
        elif self.pairs:
            self._pairs[self._camera].pop()
        self._show()

    def _on_estimate_clicked(self) -> None:
        taken = self._view.showing.taken
        if taken is None:
            return
        try:
            found = estimate_offset(
                self.pairs, taken.drive.trajectory, time_s=self._fields["time_s"].value()
            )
        except Unsuitable as error:
            self._facts.setText(error.line(self._language).replace(" | ", "  "))
            self._facts.setVisible(True)
            return
        rounded = {
            name: round(value, 3) for name, value in dataclasses.asdict(found.offset).items()
        }
        self._try(CameraOffset(**rounded))
