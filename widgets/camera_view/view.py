"""CameraView: the image that sees the cursor best, with the map drawn into it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QCloseEvent, QKeyEvent, QMouseEvent, QPainter
from PySide6.QtWidgets import QMenu, QWidget
from typing_extensions import override

from processing.cameras.depth import SeenPoint
from processing.core.text import Language
from processing.map.feature import PointReference
from processing.recording.camera_images.calibration import CameraOffset
from widgets.camera_view.camera_marks import paint_remarks
from widgets.camera_view.image_clicks import ImageClicks
from widgets.camera_view.image_loader import ImageLoader
from widgets.camera_view.image_selector import ImageSelector
from widgets.camera_view.projection import CameraProjection
from widgets.camera_view.taken_images import TakenImages
from widgets.mouse_tools.mouse_tool import Hit
from widgets.plane_view.view import PlaneView
from widgets.plane_view.viewport import PlaneViewport
from widgets.shared.cursor import PickedPosition
from widgets.shared.map_source import MapSource
from widgets.shared.shared_state import SharedState

_LIKE_WHOLE = 1.02
_NEARER = 2.5

_KEY_STEPS = {Qt.Key.Key_PageUp: -1, Qt.Key.Key_PageDown: 1}


class CameraView(PlaneView):
    """Shows one camera image; a click in it goes to the measured point that it shows.

    Signals
    -------
    image_changed(name: str)
        Another image is shown; empty: none.
    sightings_changed
        Other images see the place looked at, another is shown, or more is known of them.
    fields_of_view_changed(polygons: list of (n, 2) float64, best: int)
        What the images that see the place see of the plan; which of them is shown, −1: none.
    pixel_pointed(image: CameraImage, pixel: tuple of float)
        A pixel was clicked while pixels are wanted; the image as delivered.
    stereo_changed
        Measuring by two images was begun or ended.
    reported(text: Text)
        A line for the status bar.

    Attributes
    ----------
    showing : ImageSelector
        Which image is shown, of those that see the place.
    clicks : ImageClicks
        Stereo, and pixels for pairs.
    """

    image_changed = Signal(str)
    sightings_changed = Signal()
    fields_of_view_changed = Signal(object, int)
    pixel_pointed = Signal(object, object)
    stereo_changed = Signal()
    reported = Signal(object)

    FILLED = 1.0

    def __init__(
        self,
        source: MapSource,
        shared: SharedState,
        parent: QWidget | None = None,
        *,
        language: Language = "en",
    ) -> None:
        super().__init__(source, shared, parent, language=language)
        self._tried: Mapping[str, CameraOffset] = {}
        self._projection: CameraProjection | None = None
        self._name = ""
        self._whole_scale = 0.0
        self._is_told_sharp = False
        self._fades_hidden = True
        self._found: tuple[CameraProjection, tuple[float, float], SeenPoint | None] | None = None
        self._image_loader = ImageLoader(self)
        self.showing = ImageSelector(self._image_loader)
        self.clicks = ImageClicks(self.showing, self)
        self.clicks.changed.connect(self._show)
        self.clicks.measured.connect(self._on_clicks_measured)
        self.clicks.pixel_pointed.connect(self.pixel_pointed)
        self.clicks.reported.connect(self.reported)
        self._image_loader.developed.connect(self._on_image_loader_developed)
        shared.cursor.moved.connect(self._on_cursor_clicked)
        shared.map_changes.drives_changed.connect(self.read_images)
        self.read_images()

    # What is shown.

    @property
    def is_sharp(self) -> bool:
        """Whether the shown image is there with all that can be known about it."""
        taken = self.showing.taken
        if taken is None:
            return False
        is_known = self.showing.depth is not None or self._image_loader.blindness(taken.image)
        return self.showing.photo is not None and bool(is_known)

    def read_images(self) -> None:
        """Take over the images of all drives, as they are kept now."""
        self._image_loader.forget_troubles()
        self.showing.use(TakenImages(tuple(self._source.drives()), self._tried))
        self.showing.look_at(self._shared.cursor.position)
        self._show()

    def try_offsets(self, tried: Mapping[str, CameraOffset]) -> None:
        """Show images with these offsets, by camera, without keeping them; empty: as kept."""
        self._tried = dict(tried)
        self.showing.use(TakenImages(tuple(self._source.drives()), self._tried))
        self.showing.stay(self.showing.position)
        self._show()

    def show_position(self, position: PickedPosition) -> None:
        """Show the image that sees a place best, the place in the middle.

        An image that was shown whole is enlarged: what is looked at fills the window then.
        """
        self.showing.look_at(position)
        self._show()
        if self.projection() is not None and self._is_like_whole:
            self.zoom_by(_NEARER)
        self.center_on(position)

    def prepare(self, positions: Sequence[PickedPosition]) -> None:
        """Have the images ready that show these places best; the first ones first."""
        self.showing.prepare(tuple(positions))

    def step(self, by: int) -> None:
        """The next or the previous of the images that see the place."""
        count = len(self.showing.sightings)
        if count:
            self.show_sighting((self.showing.index + by) % count)

    def show_sighting(self, index: int) -> None:
        """One of the images that see the place."""
        self.showing.walk_to(self.showing.sightings[index].number)
        self._show()

    # Stereo and pairs.

    @property
    def is_stereo(self) -> bool:
        """Whether clicks measure by two images."""
        return self.clicks.stereo is not None

    def set_stereo(self, wanted: bool) -> None:  # noqa: FBT001 - a slot of a checked button
        """Let clicks measure by two images, or find measured points again."""
        if wanted != self.is_stereo:
            if wanted:
                self.clicks.begin_stereo()
            else:
                self.clicks.end_stereo()
            self.stereo_changed.emit()
            self.update()

    def point_pixels(self, wanted: bool) -> None:  # noqa: FBT001 - a slot of a checked button
        """Let clicks give pixels for pairs, or find measured points again."""
        self.clicks.points_pixels = wanted
        self.update()

    # What PlaneView asks.

    @override
    def projection(self) -> CameraProjection | None:
        taken = self.showing.taken
        if taken is None:
            return None
        depth = self.showing.depth if self._fades_hidden else None
        if (
            self._projection is None
            or self._projection.image != taken.image
            or self._projection.depth is not depth
        ):
            self._projection = CameraProjection(taken.image, depth)
        return self._projection

    @override
    def words(self) -> str:
        images, position = self.showing.images, self.showing.position
        if not images.images:
            return self.tr(
                "There are no camera images. Add the list of a drive's images (File ▸ Add camera "
                "images)."
            )
        if images.remark is not None:
            return images.remark.in_language(self._language)
        if position is None:
            return self.tr("Click a place in another view to see it in the camera images.")
        trouble = self.showing.trouble
        if trouble is not None:
            return trouble.line(self._language).replace(" | ", "\n")
        number, distance = images.choice.nearest_m(np.array(position.xyz))
        return self.tr(
            "No image sees this place. The nearest one, {name}, was taken {distance} m away."
        ).format(name=images.images[number].image.path.name, distance=f"{distance:,.0f}")

    @override
    def extent(self) -> QRectF | None:
        taken = self.showing.taken
        if taken is None:
            return None
        return QRectF(-0.5, -0.5, taken.image.width_px, taken.image.height_px)

    @override
    def paint_ground(self, painter: QPainter, viewport: PlaneViewport) -> None:
        photo = self.showing.photo
        if photo is not None:
            photo.paint(painter, viewport)

    @override
    def paint_frame(self, painter: QPainter, viewport: PlaneViewport) -> None:
        projection = self.projection()
        if projection is not None:
            self.clicks.paint(painter, viewport, projection)
            paint_remarks(painter, QRectF(self.rect()), self._remarks())

    @override
    def position_at(
        self, position: tuple[float, float], reach: float, *, exact: bool
    ) -> PickedPosition | None:
        projection = self.projection()
        depth = self.showing.depth
        if projection is None or depth is None:
            return None
        if not exact:
            found = depth.quick_point_at(position)
        elif self._found is not None and self._found[:2] == (projection, position):
            # A click asks twice, at press and release.
            found = self._found[2]
        else:
            found = depth.point_at(position, reach)
            self._found = projection, position, found
        return (
            None
            if found is None
            else PickedPosition(found.xyz, PointReference(found.drive, found.point))
        )

    @override
    def on_cursor_moved(self, position: PickedPosition) -> None:
        before = self.showing.number
        self.showing.look_at(position)
        self._show()
        if self.showing.number == before:
            super().on_cursor_moved(position)

    @override
    def view_menu(self) -> QMenu:
        menu = super().view_menu()
        menu.addSeparator()
        fades = menu.addAction(self.tr("Fade what is hidden in the image"))
        fades.setCheckable(True)
        fades.setChecked(self._fades_hidden)
        fades.toggled.connect(self._set_fades_hidden)
        return menu

    # Events.

    @override
    def keyPressEvent(self, event: QKeyEvent) -> None:
        step = _KEY_STEPS.get(Qt.Key(event.key()))
        if step is not None:
            self.step(step)
        elif event.key() == Qt.Key.Key_Escape and self.clicks.step_back():
            self.update()
        else:
            super().keyPressEvent(event)

    @override
    def mousePressEvent(self, event: QMouseEvent) -> None:
        is_left = event.button() == Qt.MouseButton.LeftButton
        is_own = is_left and not self._mouse.pans_with(event.button()) and self.clicks.takes_clicks
        if is_own:
            position = event.position()
            self.clicks.click(self.viewport.to_plane(position.x(), position.y()))
        else:
            super().mousePressEvent(event)

    @override
    def close(self) -> bool:
        """Stop what is read beside the window; may be called again."""
        self._image_loader.close()
        return super().close()

    @override
    def closeEvent(self, event: QCloseEvent) -> None:
        self._image_loader.close()
        super().closeEvent(event)

    # What others tell.

    def _on_image_loader_developed(self) -> None:
        was_sharp = self._is_told_sharp
        self.showing.refresh()
        self._show()
        self.set_ground_stale()
        self._is_told_sharp = self.is_sharp
        if self._is_told_sharp and not was_sharp:
            self.sharpened.emit()

    def _on_cursor_clicked(self, position: PickedPosition) -> None:
        # Who clicks into an image goes on looking at it.
        if self._mouse.is_clicking:
            self.showing.stay(position)
            self._report()

    def _on_clicks_measured(self, position: PickedPosition) -> None:
        gesture = self._mouse.gesture
        self._mouse.is_clicking = True
        try:
            if gesture.tool is None:
                self._shared.cursor.move_to(position)
            else:
                # Without reach and line of sight nothing draws it elsewhere.
                gesture.tool.press(Hit(position))
                gesture.tool.release(Hit(position))
        finally:
            self._mouse.is_clicking = False

    def _set_fades_hidden(self, wanted: bool) -> None:  # noqa: FBT001 - a slot of a checked action
        self._fades_hidden = wanted
        self.set_ground_stale()

    # What is done in more than one place.

    def _show(self) -> None:
        """The image that is to be shown is shown, as large as the one before or whole."""
        taken = self.showing.taken
        name = "" if taken is None else taken.image.path.name
        if name != self._name:
            was_whole = not self._name or self._is_like_whole
            self._name = name
            self._is_told_sharp = False
            self.set_ground_stale()
            if taken is not None:
                self._whole_scale = self._scale_of_whole()
                position = self.showing.position
                if was_whole or position is None:
                    self.show_everything()
                else:
                    self.center_on(position)
            self.image_changed.emit(name)
        self._report()
        self.update()

    @property
    def _is_like_whole(self) -> bool:
        return self.viewport.scale <= self._whole_scale * _LIKE_WHOLE

    def _report(self) -> None:
        self.sightings_changed.emit()
        self.fields_of_view_changed.emit(*self.showing.fields_of_view())

    def _scale_of_whole(self) -> float:
        extent = self.extent()
        return 0.0 if extent is None else self.viewport.filled_by(extent, self.FILLED).scale

    def _remarks(self) -> list[str]:
        """What the user should know about the image shown, a line each."""
        lines = []
        photo = self.showing.photo
        if photo is None:
            lines.append(self.tr("Reading {name} …").format(name=self._name))
        elif photo.note is not None:
            lines.append(photo.note.in_language(self._language))
        if self.showing.is_hidden:
            lines.append(self.tr("Something hides the place in this image."))
        lines.append(self.clicks.remark())
        return [line for line in lines if line]
