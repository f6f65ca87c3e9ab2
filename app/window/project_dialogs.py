"""ProjectDialogs: one dialog of a kind, and none that outlives the project it was opened for."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from PySide6.QtCore import QObject, Qt
from PySide6.QtWidgets import QDialog, QWidget

from app.window.window_parts import WindowParts
from processing.core.text import Language
from processing.project.project import Project
from widgets.dialogs.program_dialog import ProgramDialog

Form = TypeVar("Form", bound=QDialog)


class ProjectDialogs(QObject):
    """Shows the forms of the open project, and closes all dialogs of the window with it.

    A dialog needs to do nothing for that: whatever has the window for an ancestor is closed as its
    own button for leaving does it, questions and file dialogs too, which then give no answer.

    Parameters
    ----------
    parts : WindowParts
    """

    def __init__(self, parts: WindowParts) -> None:
        super().__init__(parts.window)
        self._parts = parts
        self._made_for: dict[type[QDialog], tuple[Project | None, Language]] = {}
        parts.document.about_to_close.connect(self._on_document_about_to_close)

    def show(self, kind: type[Form], make: Callable[[], Form]) -> Form:
        """Show a form beside the window; the one that is open already is raised instead.

        Parameters
        ----------
        make : callable
            Makes the form, a child of the window; it is deleted when it is closed.

        Returns
        -------
        QDialog
            What is shown now.
        """
        made_for = (self._parts.document.project, self._parts.language)
        for form in self._parts.window.findChildren(kind):
            if form.isVisible() and self._made_for.get(kind) == made_for:
                form.setWindowState(form.windowState() & ~Qt.WindowState.WindowMinimized)
                form.raise_()
                form.activateWindow()
                return form
            # It speaks of what was open before, or in another language.
            form.close()
        self._made_for[kind] = made_for
        form = make()
        form.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        form.show()
        return form

    def _on_document_about_to_close(self) -> None:
        for dialog in self._parts.window.findChildren(QDialog):
            if dialog.isVisible() and not _is_of_the_program(dialog):
                dialog.close()


def _is_of_the_program(dialog: QDialog) -> bool:
    widget: QWidget | None = dialog
    while widget is not None and not isinstance(widget, ProgramDialog):
        widget = widget.parentWidget()
    return widget is not None
