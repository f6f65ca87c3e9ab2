"""Settings of one view among several: an image of its own, and the rest as all views have it."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QObject

from widgets.shared.view_settings import ViewSettings


class OwnSettings(QObject):
    """Keeps what doesn't belong to a single view in step with the shared settings.

    A view has its own drive, kind of image, attribute and sides; contrast, size of points, what is
    hidden, and whether the street goes up, follow the others.

    Parameters
    ----------
    shared : ViewSettings
        Of all views.

    Attributes
    ----------
    settings : ViewSettings
        Of the one view; begins as the shared ones are.
    """

    def __init__(self, shared: ViewSettings, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._shared = shared
        self.settings = ViewSettings(self)
        self.settings.show_image(shared.drive_id, shared.image_kind)
        self.settings.change_look(attribute=shared.look.attribute)
        self.settings.orient_image(shared.image_orientation)
        shared.look_changed.connect(self._follow)
        shared.image_orientation_changed.connect(self._on_shared_image_orientation_changed)
        shared.hidden_kinds_changed.connect(self._follow)
        shared.hidden_runs_changed.connect(self._follow)
        shared.shows_rejected_changed.connect(self._follow)
        self._follow()

    def _follow(self) -> None:
        shared, look = self._shared, self._shared.look
        self.settings.change_look(
            low_percent=look.low_percent,
            high_percent=look.high_percent,
            point_size_px=look.point_size_px,
            hides_noise=look.hides_noise,
        )
        self.settings.hide_kinds(shared.hidden_kinds)
        self.settings.hide_runs(shared.hidden_runs)
        self.settings.set_shows_rejected(shared.shows_rejected)

    def _on_shared_image_orientation_changed(self) -> None:
        is_vertical = self._shared.image_orientation.is_vertical
        self.settings.orient_image(
            replace(self.settings.image_orientation, is_vertical=is_vertical)
        )
