"""ViewMemory: which drives are shown where, remembered with the project."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress

from PySide6.QtCore import QObject, QTimer

from app.document.document import Document
from processing.core.errors import UserError
from processing.project.store.project_settings import JsonValue
from processing.recording.kinds import ImageKind
from widgets.image_view.panes import ShownImage
from widgets.image_view.side_by_side import ImageViews
from widgets.shared.image_orientation import ImageOrientation

_NAME = "views"
_HIDES_NOISE = "hides_noise"
_AFTER_MS = 2_000
_ORIENTATIONS = ("is_vertical", "is_mirrored_across", "is_reversed_along")


class ViewMemory(QObject):
    """Keeps the image's drive, the images beside it and what is hidden for the next opening.

    Parameters
    ----------
    document : Document
    images : ImageViews
    """

    def __init__(
        self, document: Document, images: ImageViews, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._document = document
        self._images = images
        # Who looks through many drives doesn't wait for the disk at each.
        self._later = QTimer(self, singleShot=True, interval=_AFTER_MS)
        self._later.timeout.connect(self._keep)
        settings = document.shared.view_settings
        for changed in (
            settings.image_changed,
            settings.hidden_drives_changed,
            settings.look_changed,
            images.images_changed,
        ):
            changed.connect(self._later.start)
        document.opened.connect(self._on_document_opened)
        document.about_to_close.connect(self._on_document_about_to_close)

    def _on_document_opened(self) -> None:
        project = self._document.project
        stored = None if project is None else project.settings.get(_NAME)
        reported: dict[str, JsonValue] = stored if isinstance(stored, dict) else {}
        settings, drives = self._document.shared.view_settings, self._document.drives()
        kinds = {drive.id: drive.image_kinds for drive in drives}
        hidden = reported.get("hidden")
        settings.hide_drives(
            frozenset(map(str, hidden if isinstance(hidden, list) else [])) & set(kinds)
        )
        settings.change_look(hides_noise=reported.get(_HIDES_NOISE) is True)
        shown = _read_shown_image(reported)
        if shown is not None and shown.kind in kinds.get(shown.drive_id, ()):
            settings.show_image(shown.drive_id, shown.kind)
        beside = reported.get("beside")
        images = [_read_shown_image(one) for one in (beside if isinstance(beside, list) else [])]
        self._images.arrange(
            tuple(one for one in images if one and one.kind in kinds.get(one.drive_id, ()))
        )

    def _on_document_about_to_close(self) -> None:
        self._keep()
        settings = self._document.shared.view_settings
        settings.hide_drives(frozenset())
        settings.change_look(hides_noise=False)
        self._later.stop()

    def _keep(self) -> None:
        self._later.stop()
        project, settings = self._document.project, self._document.shared.view_settings
        if project is None or not settings.drive_id:
            return
        orientation = settings.image_orientation
        main = ShownImage(
            settings.drive_id, settings.image_kind, settings.look.attribute, orientation
        )
        hidden: Sequence[JsonValue] = sorted(settings.hidden_drives)
        reported: dict[str, JsonValue] = {
            **_report_image(main),
            "hidden": list(hidden),
            _HIDES_NOISE: settings.look.hides_noise,
            "beside": [_report_image(one) for one in self._images.images],
        }
        if reported != project.settings.get(_NAME):
            # What is looked at is no work: a full disk keeps nobody from closing.
            with suppress(UserError):
                project.settings.put(_NAME, reported)


def _report_image(shown: ShownImage) -> dict[str, JsonValue]:
    return {
        "drive": shown.drive_id,
        "kind": shown.kind.value,
        "attribute": shown.attribute,
        **{name: bool(getattr(shown.orientation, name)) for name in _ORIENTATIONS},
    }


def _read_shown_image(reported: JsonValue) -> ShownImage | None:
    if not isinstance(reported, dict):
        return None
    kinds = {kind.value: kind for kind in ImageKind}
    kind = kinds.get(str(reported.get("kind")))
    if kind is None:
        return None
    orientation = ImageOrientation(*(reported.get(name) is True for name in _ORIENTATIONS))
    return ShownImage(str(reported.get("drive")), kind, str(reported.get("attribute")), orientation)
