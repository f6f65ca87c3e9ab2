"""VolumePanel: compare two grounds, look at what came of it, and give it out."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QHBoxLayout,
    QLabel,
    QMenu,
    QPushButton,
    QSizePolicy,
    QTabWidget,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from processing.core.text import Language, Text
from processing.project.volumes.volume import KeptVolume
from widgets.panels.volume.limits_box import LimitsBox
from widgets.panels.volume.side_box import side_words
from widgets.panels.volume.style_form import VolumeStyleForm
from widgets.panels.volume.volume_form import VolumeForm
from widgets.panels.volume.volume_table import VolumeTable
from widgets.parts.scrolled import make_scrollable
from widgets.shared.shared_state import SharedState

_FORM, _RESULT = range(2)


class VolumePanel(QWidget):
    """Three pages: the form, the chosen result with its exports, and how its map is shown.

    Parameters
    ----------
    shared : SharedState
    parameters : type
        Of the tool ``volume``.
    exports : sequence of (str, Text)
        Ids and names of what can be given out.
    language : Language

    Signals
    -------
    volume_chosen(id: str), removal_requested(id: str), export_requested(id: str)
        The last one names the export.

    Attributes
    ----------
    form : VolumeForm
    table : VolumeTable
    limits : LimitsBox
        Shown where a ground was compared with a design.
    """

    volume_chosen = Signal(str)
    removal_requested = Signal(str)
    export_requested = Signal(str)

    def __init__(
        self,
        shared: SharedState,
        parameters: type[Any],  # each tool has a dataclass of its own
        exports: Sequence[tuple[str, Text]],
        *,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._language: Language = language
        self.form = VolumeForm(parameters, language, self)
        self.table = VolumeTable(language, self)
        self._list = QComboBox(self)
        self._list.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self._list.setToolTip(self.tr("Volumes computed so far"))
        self._remove = QToolButton(self)
        self._remove.setText("✕")
        self._remove.setToolTip(self.tr("Remove this result"))
        self._export = QPushButton(self.tr("Export"), self)
        menu = QMenu(self._export)
        for id_, name in exports:
            action = menu.addAction(name.in_language(language))
            action.setObjectName(id_)
            action.triggered.connect(self._exporting(id_))
        self._export.setMenu(menu)
        self.limits = LimitsBox(language, self)
        self._look = VolumeStyleForm(shared.volume, self)
        self._nothing = QLabel(self.tr("No volume has been computed yet."), self)
        self._nothing.setWordWrap(True)
        self._pages = QTabWidget(self)
        self._lay_out()
        self._list.activated.connect(self._on_list_activated)
        self._remove.clicked.connect(self._on_remove_clicked)
        self.show_volumes((), "")

    def _lay_out(self) -> None:
        chosen = QHBoxLayout()
        chosen.setSpacing(4)
        chosen.addWidget(self._list, 1)
        chosen.addWidget(self._remove)
        numbers, look, result = QWidget(self), QWidget(self), QWidget(self)
        above, heat = QVBoxLayout(numbers), QVBoxLayout(look)
        above.addLayout(chosen)
        above.addWidget(self._nothing)
        above.addWidget(self.table)
        heat.addWidget(self._look)
        for column in (above, heat):
            column.setContentsMargins(8, 8, 8, 8)
            column.setSpacing(8)
            column.addStretch(1)
        below = QVBoxLayout()
        below.setContentsMargins(8, 4, 8, 8)
        below.setSpacing(4)
        below.addWidget(self.limits)
        below.addWidget(self._export)
        page = QVBoxLayout(result)
        page.setContentsMargins(0, 0, 0, 0)
        page.setSpacing(0)
        # Below what scrolls: it stays in sight however much is to be said.
        page.addWidget(make_scrollable(numbers), 1)
        page.addLayout(below)
        self._pages.setDocumentMode(True)
        self._pages.addTab(self.form, self.tr("Compare"))
        self._pages.addTab(result, self.tr("Result"))
        self._pages.addTab(make_scrollable(look), self.tr("Heat map"))
        whole = QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.addWidget(self._pages)

    @property
    def chosen(self) -> str:
        """Id of the result that is shown; empty without one."""
        return str(self._list.currentData() or "")

    @property
    def export_menu(self) -> QMenu:
        """What the button of exports offers."""
        return self._export.menu()

    def offer_exports(self, ids: Collection[str]) -> None:
        """Offer only these of the exports."""
        for action in self.export_menu.actions():
            action.setVisible(action.objectName() in ids)

    def show_volumes(self, volumes: Sequence[KeptVolume], chosen: str) -> None:
        """List results, the newest first, and show the numbers of one."""
        newest = tuple(reversed(volumes))
        is_other = chosen != self.chosen
        with QSignalBlocker(self._list):
            self._list.clear()
            for number, kept in enumerate(newest):
                self._list.addItem(self._name_of(kept), kept.id)
                self._list.setItemData(number, self._facts_of(kept), Qt.ItemDataRole.ToolTipRole)
            self._list.setCurrentIndex(self._list.findData(chosen))
        shown = next((kept for kept in newest if kept.id == chosen), None)
        if shown is not None:
            self.table.show_volume(shown)
        self._nothing.setVisible(not newest)
        for widget in (self._list, self._remove):
            widget.setVisible(bool(newest))
        for part in (self.table, self._export):
            part.setVisible(shown is not None)
        self.limits.setVisible(False)  # until it is said what was compared
        self._look.setEnabled(shown is not None)
        if is_other:
            self._pages.setCurrentIndex(_RESULT if shown is not None else _FORM)

    def _name_of(self, kept: KeptVolume) -> str:
        sides = kept.request.before, kept.request.after
        before, after = (side.name or side_words(side) for side in sides)  # a level has none
        return self.tr("{moment}  {before} → {after}").format(
            moment=_moment(kept), before=before, after=after
        )

    def _facts_of(self, kept: KeptVolume) -> str:
        return self.tr("{before} → {after}, computed {moment}").format(
            before=side_words(kept.request.before),
            after=side_words(kept.request.after),
            moment=_moment(kept),
        )

    def _exporting(self, id_: str) -> Any:  # a slot that forgets whether the action is checked
        def export() -> None:
            self.export_requested.emit(id_)

        return export

    def _on_list_activated(self) -> None:
        self.volume_chosen.emit(self.chosen)

    def _on_remove_clicked(self) -> None:
        if self.chosen:
            self.removal_requested.emit(self.chosen)


def _moment(kept: KeptVolume) -> str:
    return kept.made.astimezone().strftime("%Y-%m-%d %H:%M")
