"""AttributeNotices: says in a line where a drive is shown by something else than was chosen."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from app.document.document import Document
from processing.core.text import Text
from processing.image.attributes.attributes import ATTRIBUTES, most_telling_attribute


class AttributeNotices(QObject):
    """Tells which drives lack what points are to be coloured by.

    Parameters
    ----------
    document : Document

    Signals
    -------
    reported(text: Text)
    """

    reported = Signal(object)

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._reported: tuple[str, tuple[str, ...]] = ("", ())
        settings, changes = document.shared.view_settings, document.shared.map_changes
        for changed in (settings.look_changed, changes.drives_changed):
            changed.connect(self._report)
        settings.image_changed.connect(self._on_settings_image_changed)

    def _on_settings_image_changed(self) -> None:
        if self._document.shared.view_settings.drive_id in self._reported[1]:
            self._reported = ("", ())
        self._report()

    def _report(self) -> None:
        wanted = self._document.shared.view_settings.look.attribute
        shown = {drive: most_telling_attribute(drive, wanted) for drive in self._document.drives()}
        lacking = {drive: one for drive, one in shown.items() if one != wanted}
        news = wanted, tuple(drive.id for drive in lacking)
        if news == self._reported:
            return
        self._reported = news
        if lacking:
            titles = dict.fromkeys(ATTRIBUTES[one].title for one in lacking.values())
            self.reported.emit(
                Text(
                    "{drives}: no “{wanted}”; shown by “{shown}”.",
                    "{drives}には「{wanted}」がないため、「{shown}」で表示しています。",
                ).filled(
                    drives=", ".join(drive.info.name for drive in lacking),
                    wanted=ATTRIBUTES[wanted].title,
                    shown=next(iter(titles)),
                )
            )
