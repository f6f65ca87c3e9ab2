"""ImageClicks: clicks into an image that measure by two images, or that name a pixel."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QPainter

from processing.core.errors import Unsuitable
from processing.core.text import Text
from widgets.camera_view.camera_marks import paint_line_of_sight, paint_marked
from widgets.camera_view.image_selector import ImageSelector
from widgets.camera_view.projection import CameraProjection
from widgets.camera_view.stereo_measurement import StereoMeasurement
from widgets.feature_drawing.screen_marks import paint_note
from widgets.plane_view.viewport import PlaneViewport
from widgets.shared.cursor import PickedPosition
from widgets.shared.sketch import Note

ClickedPixel = tuple[float, float]


class ImageClicks(QObject):
    """Takes the left button from the mouse tool while stereo or pairs are wanted.

    Parameters
    ----------
    showing : ImageSelector

    Signals
    -------
    changed
        Something else is to be painted, or another image is shown.
    measured(place: Place)
        Two images gave a place.
    pixel_pointed(image: CameraImage, pixel: tuple of float)
        A pixel was clicked for a pair; the image as delivered.
    reported(text: Text)
        A line for the status bar.

    Attributes
    ----------
    stereo : StereoMeasurement or None
        While clicks measure by two images.
    points_pixels : bool
        While clicks name pixels.
    """

    changed = Signal()
    measured = Signal(object)
    pixel_pointed = Signal(object, object)
    reported = Signal(object)

    def __init__(self, showing: ImageSelector, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._showing = showing
        self._note: Note | None = None
        self.stereo: StereoMeasurement | None = None
        self.points_pixels = False

    @property
    def takes_clicks(self) -> bool:
        """Whether the left button is meant for this."""
        return self.points_pixels or self.stereo is not None

    def begin_stereo(self) -> None:
        """The next two clicks measure."""
        self.stereo, self._note = StereoMeasurement(), None

    def end_stereo(self) -> None:
        """Clicks are the mouse tool's again."""
        self.stereo, self._note = None, None

    def step_back(self) -> bool:
        """Forget the first click; says whether there was one."""
        if self.stereo is None or self.stereo.marked is None:
            return False
        self.stereo.drop()
        return True

    def click(self, spot: ClickedPixel) -> None:
        """The left button went down at a pixel."""
        taken = self._showing.taken
        if taken is None:
            return
        if self.points_pixels:
            self.pixel_pointed.emit(taken.delivered, spot)
        elif self.stereo is not None:
            marked = self.stereo.marked
            if marked is None or marked.number == self._showing.number:
                self._mark(self.stereo, spot)
            else:
                self._measure(self.stereo, spot)
            self.changed.emit()

    def remark(self) -> str:
        """What to do next; empty when nothing is under way."""
        if self.points_pixels:
            return self.tr("Click a thing here, then the same one in another view.")
        if self.stereo is None:
            return ""
        if self.stereo.marked is None:
            return self.tr("Stereo: click the thing in this image.")
        if self.stereo.marked.number == self._showing.number:
            return self.tr("Stereo: go to another image that shows the thing.")
        return self.tr("Stereo: click the same thing on the line. Escape begins again.")

    def paint(
        self, painter: QPainter, viewport: PlaneViewport, projection: CameraProjection
    ) -> None:
        """The first click or its line of sight, and the error of what was measured last."""
        if self.stereo is None:
            return
        marked, number = self.stereo.marked, self._showing.number
        line = self.stereo.line_in(self._showing.images.choice, number)
        if line is not None:
            paint_line_of_sight(painter, viewport.to_screen(line))
        if marked is not None and marked.number == number:
            paint_marked(painter, viewport.to_screen(np.array(marked.pixel)))
        if self._note is not None:
            x, y = viewport.to_screen(projection.to_plane(np.array([self._note.xyz])))[0].tolist()
            if np.isfinite(x) and np.isfinite(y):
                paint_note(painter, (x, y), self._note)

    def _mark(self, stereo: StereoMeasurement, spot: ClickedPixel) -> None:
        stereo.mark(self._showing.number, spot)
        self._note = None
        depth = self._showing.depth
        seen = None if depth is None else depth.quick_point_at(spot)
        near = None if seen is None else np.array(seen.xyz)
        partner = stereo.partner(self._showing.images.choice, near)
        if partner is None:
            self.reported.emit(_NO_PARTNER)
        else:
            self._showing.walk_to(partner)

    def _measure(self, stereo: StereoMeasurement, spot: ClickedPixel) -> None:
        try:
            found = stereo.position(self._showing.images.choice, self._showing.number, spot)
        except Unsuitable as error:
            self.reported.emit(error.what)
            return
        if found is not None:
            easting, northing, height = found.xyz.tolist()
            position = PickedPosition((easting, northing, height), is_occluded=True)
            stereo.drop()
            self._note = Note(position.xyz, f"±{found.error_m:.2f} m")
            self.reported.emit(_MEASURED.filled(error=found.error_m, gap=found.gap_m))
            self.measured.emit(position)


_NO_PARTNER = Text(
    "No other image sees this place from far enough aside.",
    "十分に離れた位置からこの場所を写した画像がほかにありません。",
)
_MEASURED = Text(
    "Stereo: ±{error:.2f} m; the lines of sight pass each other by {gap:.2f} m.",
    "ステレオ計測: ±{error:.2f} m（視線の離れ {gap:.2f} m）",
)
