"""ExistingMapForm: a map that was delivered before, and what is to become of it."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QLabel, QVBoxLayout, QWidget

from processing.core.errors import OutOfRange
from processing.core.text import Language
from processing.map.renewal.existing_map import ExistingMap
from widgets.panels.processing.parameter_form import ParameterForm
from widgets.parts.plain_buttons import remove_icons

_WIDTH_PX = 520


class ExistingMapForm(QDialog):
    """A form beside the window; the window stays usable while it is open.

    Parameters
    ----------
    language : Language

    Signals
    -------
    map_given(given: ExistingMap)
    """

    map_given = Signal(object)

    def __init__(self, language: Language, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._language: Language = language
        self.setWindowTitle(self.tr("Existing map"))
        hint = QLabel(
            self.tr(
                "Compares a map that was delivered before with what is accepted and drawn, kind by"
                " kind in plan, or takes its features in."
            ),
            self,
        )
        hint.setWordWrap(True)
        self.form = ParameterForm(ExistingMap, language, self)
        self._trouble = QLabel(self)
        self._trouble.setWordWrap(True)
        kinds = QDialogButtonBox.StandardButton
        buttons = QDialogButtonBox(kinds.Ok | kinds.Cancel, self)
        remove_icons(buttons)
        self.ok_button = buttons.button(kinds.Ok)
        buttons.accepted.connect(self._on_buttons_accepted)
        buttons.rejected.connect(self.close)
        self.form.changed.connect(self._on_form_changed)
        layout = QVBoxLayout(self)
        for part in (hint, self.form, self._trouble):
            layout.addWidget(part)
        layout.addStretch(1)
        layout.addWidget(buttons)
        self.resize(_WIDTH_PX, self.sizeHint().height())
        self._on_form_changed()

    def _given(self) -> ExistingMap | None:
        try:
            given: ExistingMap = self.form.value()
        except OutOfRange as error:
            self._trouble.setText(error.line(self._language))
            return None
        self._trouble.clear()
        return given

    def _on_form_changed(self) -> None:
        given = self._given()
        self.ok_button.setEnabled(given is not None and bool(given.file))

    def _on_buttons_accepted(self) -> None:
        given = self._given()
        if given is not None:
            self.map_given.emit(given)
            self.close()
