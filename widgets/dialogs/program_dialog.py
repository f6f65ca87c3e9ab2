"""ProgramDialog: what acts on no project, so that it stays open when one is closed."""

from __future__ import annotations

from PySide6.QtWidgets import QDialog


class ProgramDialog(QDialog):
    """A dialog of the program itself; it stays with what it has opened when a project is closed."""
