"""InitialView: what a project is shown as at first, so that no picture is black or empty."""

from __future__ import annotations

from collections.abc import Sequence

from processing.image.attributes.attributes import most_telling_attribute
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from widgets.shared.view_settings import PointStyle, ViewSettings


class InitialView:
    """Shows the first drive of a project, by what its points have.

    Parameters
    ----------
    settings : ViewSettings
    """

    def __init__(self, settings: ViewSettings) -> None:
        self._settings = settings
        # By what is shown: what was wanted, where a cloud had none of that.
        self._stands_for: dict[str, str] = {}

    def show(self, drives: Sequence[Drive]) -> None:
        """Show the first drive, unless one of them is shown already."""
        settings = self._settings
        if not drives or settings.drive_id in {drive.id for drive in drives}:
            return
        settings.show_image(drives[0].id, best_kind(drives[0], settings.image_kind))
        shown = settings.look.attribute
        wanted = self._stands_for.get(shown, shown)
        telling = most_telling_attribute(drives[0], wanted)
        self._stands_for = {} if telling == wanted else {telling: wanted}
        settings.change_look(attribute=telling)

    def show_classes(self) -> None:
        """Show what a tool just said of every point, unless something was chosen to be shown."""
        if self._settings.look.attribute == PointStyle().attribute:
            self._settings.change_look(attribute="class")


def best_kind(drive: Drive, wanted: ImageKind) -> ImageKind:
    """The kind of image that is wanted, or the drive's first one."""
    return wanted if wanted in drive.image_kinds else drive.image_kinds[0]
