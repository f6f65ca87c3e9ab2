"""WindowChange: another language while the program runs. New widgets round the same document.

Project, jobs, the tool in the hand and what it is drawing go on; what was looked at is looked at
again.
"""

from __future__ import annotations

import gc
from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QObject, Qt, QTimer
from PySide6.QtWidgets import QApplication

from app.settings.translation import Translation
from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.text import Language
from processing.project.volumes.volume import ChosenSide
from widgets.image_view.orientation.viewport import Viewport
from widgets.image_view.panes import ShownImage
from widgets.plane_view.viewport import PlaneViewport
from widgets.scene_view.clipping import ClipChoice
from widgets.scene_view.rendering.camera import SceneCamera
from widgets.scene_view.view import SceneView

_LAID_OUT_MS = 50


@dataclass(frozen=True)
class _Seen:
    """What a window shows that its document doesn't know."""

    viewport: Viewport | None
    camera: SceneCamera
    is_shaded: bool
    clip: ClipChoice
    images: tuple[ShownImage, ...]
    are_locked: bool
    map_part: PlaneViewport | None
    tool: str
    parameters: object
    compared: tuple[ChosenSide | None, ChosenSide | None]
    volume_parameters: object
    asks_model: bool
    asked_model: int
    error: UserError | None
    has_focus: bool

    @staticmethod
    def of(parts: WindowParts) -> _Seen:
        image, panel = parts.image_view, parts.processing_panel
        form, cloud = panel.form, parts.scene_view.cloud
        volume = parts.volume_panel.form
        focused = QApplication.focusWidget()
        return _Seen(
            viewport=None if image.picture is None else image.viewport,
            camera=parts.scene_view.camera,
            is_shaded=cloud is None or cloud.is_shading_wanted,
            clip=parts.scene_view.clipping.choice,
            images=tuple(parts.image_views.images),
            are_locked=parts.image_views.is_locked,
            map_part=None if parts.map_view.projection() is None else parts.map_view.viewport,
            tool=panel.tool,
            parameters=None if form is None else form.value(),
            compared=volume.sides,
            volume_parameters=volume.parameters.value(),
            asks_model=parts.pulse_panel.occlusion_box.switch.isChecked(),
            asked_model=parts.pulse_panel.occlusion_box.method.currentIndex(),
            error=parts.message_bar.error,
            has_focus=focused in (*parts.image_views.views, parts.scene_view.picture),
        )

    def show_again(self, parts: WindowParts) -> None:
        parts.image_views.arrange(self.images)
        parts.image_views.lock(self.are_locked)
        parts.scene_view.clipping.choose(self.clip)
        if self.map_part is not None:
            parts.map_view.set_viewport(self.map_part)
        if self.viewport is not None:
            parts.image_view.look_through(self.viewport)
            parts.scene_view.look_from(self.camera)
        if not self.is_shaded:
            self._unshade(parts.scene_view)
        panel = parts.processing_panel
        if self.tool:
            panel.show_tool(self.tool)
        if panel.form is not None and self.parameters is not None:
            panel.form.set_values(vars(self.parameters))
        volume = parts.volume_panel.form
        volume.choose_sides(*self.compared)
        volume.parameters.set_values(vars(self.volume_parameters))
        parts.pulse_panel.occlusion_box.method.setCurrentIndex(self.asked_model)
        parts.pulse_panel.occlusion_box.switch.setChecked(self.asks_model)
        if self.error is not None:
            parts.message_bar.show_error(self.error)
        if self.has_focus:
            parts.image_view.setFocus()

    @staticmethod
    def _unshade(view: SceneView) -> None:
        """Turn the shading off once there is a picture that could be shaded."""

        def unshade() -> None:
            view.set_shading(is_on=False)

        view.sharpened.connect(unshade, Qt.ConnectionType.SingleShotConnection)


class WindowChange(QObject):
    """Builds the window anew in another language.

    Parameters
    ----------
    parts : WindowParts
        The parts of the window; new ones are put into it.
    translation : Translation
    make : callable
        Makes the new parts in the language that is translated into then.
    furnish : callable
        Puts the parts into their window and connects them.
    """

    def __init__(
        self,
        parts: WindowParts,
        translation: Translation,
        make: Callable[[Language], WindowParts],
        furnish: Callable[[], None],
    ) -> None:
        super().__init__(parts.window)
        self._parts = parts
        self._translation = translation
        self._make = make
        self._furnish = furnish
        self._wanted = parts.language
        # What was clicked to get here is deleted too, so it must have returned before.
        self._change = QTimer(self, singleShot=True)
        self._change.timeout.connect(self._on_change_timeout)
        self._tidy = QTimer(self, singleShot=True, interval=_LAID_OUT_MS)
        self._tidy.timeout.connect(self._on_tidy_timeout)

    def speak(self, language: Language) -> None:
        """Change to a language, as soon as what is going on now is done, and keep it so."""
        self._wanted = language
        self._parts.settings.choose_language(language)
        self._change.start()

    def _on_change_timeout(self) -> None:
        parts = self._parts
        if self._wanted == parts.language:
            return
        seen = _Seen.of(parts)
        parts.window.setUpdatesEnabled(False)
        parts.toolbox.use_views(())
        parts.close_views()
        # Loaders hold on to the old views until they have told them of their tiles.
        parts.document.tiles.tell_nobody()
        self._translation.speak(self._wanted)
        parts.replace_by(self._make(self._wanted))
        self._furnish()
        seen.show_again(parts)
        self._tidy.start()

    def _on_tidy_timeout(self) -> None:
        self._parts.window.setUpdatesEnabled(True)  # all stands where it stood
        # The old views hold pictures of many megabytes in circles of references. They are let go
        # here, since a collection in another thread would delete Qt's objects from there.
        gc.collect()
