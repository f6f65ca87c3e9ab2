"""ImageViewSettings: boxes to choose drive, kind, attribute and direction of an image view."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QComboBox,
    QHBoxLayout,
    QMenu,
    QSizePolicy,
    QStyle,
    QStyleOptionComboBox,
    QToolButton,
    QWidget,
)

from processing.core.text import Language
from processing.image.attributes.attributes import ATTRIBUTES, available, most_telling_attribute
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from widgets.pictures.image_kind_list import ImageKindList
from widgets.shared.image_orientation import ImageOrientation
from widgets.shared.map_changes import MapChanges
from widgets.shared.map_source import MapSource
from widgets.shared.orientation_menu import fill_orientation_menu
from widgets.shared.view_settings import ViewSettings

_LEAST_BOX_PX, _LEAST_DRIVE_PX = 48, 96
"""Names of drives begin alike in many projects: less of them is cut off."""

_INNER_PX = 1
"""Between a box's field and its words, on either side."""

_ARROWS = {(False, False): "→", (False, True): "←", (True, False): "↑", (True, True): "↓"}


class ImageViewSettings(QWidget):
    """Shows and sets what one image view shows.

    Parameters
    ----------
    source : MapSource
    changes : MapChanges
    settings : ViewSettings
        Of that view.
    """

    def __init__(
        self,
        source: MapSource,
        changes: MapChanges,
        settings: ViewSettings,
        parent: QWidget | None = None,
        *,
        language: Language,
    ) -> None:
        super().__init__(parent)
        self._source = source
        self._settings = settings
        self._language: Language = language
        self._may_shrink = False
        self._drive = _ElidedBox(self)
        self._kind = _ElidedBox(self)
        self._attribute = _ElidedBox(self)
        for box in (self._drive, self._kind, self._attribute):
            box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        ImageKindList(self._kind, language)
        self._orientation = QToolButton(self)
        self._orientation.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self._orientation.setToolTip(
            self.tr("Direction of travel in the image; exchange its sides")
        )
        self._menu = QMenu(self._orientation)
        self._menu.aboutToShow.connect(self._on_menu_about_to_show)
        self._orientation.setMenu(self._menu)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(8)
        for widget in (self._drive, self._kind, self._attribute, self._orientation):
            layout.addWidget(widget)
        self._drive.activated.connect(self._on_drive_activated)
        self._kind.activated.connect(self._on_kind_activated)
        self._attribute.activated.connect(self._on_attribute_activated)
        changes.drives_changed.connect(self._show)
        changes.drive_columns_changed.connect(self._show)
        settings.image_changed.connect(self._show)
        settings.look_changed.connect(self._show)
        settings.image_orientation_changed.connect(self._show)
        self._show()

    def let_shrink(self) -> None:
        """Let the boxes become narrower than their words where there is no room."""
        for box in (self._drive, self._kind, self._attribute):
            box.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
            box.setMinimumWidth(_LEAST_BOX_PX)
        self._may_shrink = True
        self._show()

    @property
    def drive(self) -> Drive | None:
        """The drive that is shown; None when there is none."""
        drives = {drive.id: drive for drive in self._source.drives()}
        return drives.get(self._settings.drive_id)

    def _show(self) -> None:
        settings, drive = self._settings, self.drive
        drives = [(one.info.name, one.id) for one in self._source.drives()]
        _fill(self._drive, drives, settings.drive_id)
        self._drive.setToolTip(drive.info.name if drive else "")
        if self._may_shrink:
            self._drive.setMinimumWidth(min(self._drive.sizeHint().width(), _LEAST_DRIVE_PX))
        kinds = drive.image_kinds if drive else ()
        _fill(
            self._kind,
            [(kind.title.in_language(self._language), kind.value) for kind in kinds],
            settings.image_kind.value,
        )
        self._kind.setToolTip(settings.image_kind.explanation.in_language(self._language))
        names = available(drive) if drive else ()
        _fill(
            self._attribute,
            [(ATTRIBUTES[name].title.in_language(self._language), name) for name in names],
            most_telling_attribute(drive, settings.look.attribute) if drive else "",
        )
        orientation = (
            settings.image_orientation if settings.image_kind.follows_path else ImageOrientation()
        )
        arrow = _ARROWS[orientation.is_vertical, orientation.is_reversed_along]
        # The spaces keep clear of the mark that tells of a menu.
        self._orientation.setText(
            f"{arrow} ⇋  " if orientation.is_mirrored_across else f"{arrow}  "
        )
        self._orientation.setEnabled(settings.image_kind.follows_path)

    def _on_menu_about_to_show(self) -> None:
        self._menu.clear()
        fill_orientation_menu(self._menu, self._settings)

    def _on_drive_activated(self) -> None:
        drive = self._source.drive(str(self._drive.currentData()))
        kind = self._settings.image_kind
        kinds = drive.image_kinds
        self._settings.show_image(drive.id, kind if kind in kinds else kinds[0])

    def _on_kind_activated(self) -> None:
        kind = ImageKind(str(self._kind.currentData()))
        self._settings.show_image(self._settings.drive_id, kind)

    def _on_attribute_activated(self) -> None:
        self._settings.change_look(attribute=str(self._attribute.currentData()))


class _ElidedBox(QComboBox):
    """A box whose words end in dots where they don't fit; Qt would cut a letter in two."""

    def initStyleOption(self, option: QStyleOptionComboBox) -> None:  # noqa: N802 - Qt's name
        """Give what is drawn the words that fit."""
        super().initStyleOption(option)
        style = QStyle.ComplexControl.CC_ComboBox, QStyle.SubControl.SC_ComboBoxEditField
        room = self.style().subControlRect(style[0], option, style[1], self).width()
        words = self.fontMetrics().elidedText(
            option.currentText, Qt.TextElideMode.ElideRight, room - 2 * _INNER_PX
        )
        option.currentText = words


def _fill(box: QComboBox, entries: list[tuple[str, str]], current: str) -> None:
    shown = [(box.itemText(i), str(box.itemData(i))) for i in range(box.count())]
    if shown != entries:
        box.clear()
        for title, value in entries:
            box.addItem(title, value)
    index = box.findData(current)
    if index >= 0:
        box.setCurrentIndex(index)
