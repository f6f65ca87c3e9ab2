"""WorkDetailsForm: who does which work for whom, as papers say it."""

from __future__ import annotations

from dataclasses import asdict

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QLabel, QLineEdit, QVBoxLayout, QWidget

from processing.core.errors import OutOfRange
from processing.core.text import Language
from processing.project.work_details import WorkDetails, details_of
from widgets.panels.processing.parameter_form import ParameterForm
from widgets.parts.plain_buttons import remove_icons

_WIDTH_PX = 460
_NAME = "work"


class WorkDetailsForm(QDialog):
    """A form beside the window; the window stays usable while it is open.

    Parameters
    ----------
    details : WorkDetails
        As they are now.
    project_name : str
        What papers call the work that has no name.
    language : Language

    Signals
    -------
    details_given(details: WorkDetails)
        To be kept; whoever could keep them closes the form.
    """

    details_given = Signal(object)

    def __init__(
        self,
        details: WorkDetails,
        project_name: str,
        language: Language,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._language: Language = language
        self.setWindowTitle(self.tr("Work details"))
        hint = QLabel(
            self.tr("What reports and forms say of the work. What is empty is left blank."), self
        )
        hint.setWordWrap(True)
        self._form = ParameterForm(WorkDetails, language, self)
        self._form.set_values(asdict(details))
        name = self._form.field(_NAME)
        if isinstance(name, QLineEdit):
            name.setPlaceholderText(project_name)
        self._trouble = QLabel(self)
        self._trouble.setWordWrap(True)
        kinds = QDialogButtonBox.StandardButton
        buttons = QDialogButtonBox(kinds.Ok | kinds.Cancel, self)
        remove_icons(buttons)
        buttons.accepted.connect(self._on_buttons_accepted)
        buttons.rejected.connect(self.close)
        layout = QVBoxLayout(self)
        for part in (hint, self._form, self._trouble):
            layout.addWidget(part)
        layout.addStretch(1)
        layout.addWidget(buttons)
        self.resize(_WIDTH_PX, self.sizeHint().height())

    def _on_buttons_accepted(self) -> None:
        try:
            given = details_of(asdict(self._form.value()))
        except OutOfRange as error:
            self._trouble.setText(error.line(self._language))
            return
        self.details_given.emit(given)
