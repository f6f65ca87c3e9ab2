"""UndoStack: undo and redo over the history that the project keeps on disk."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from processing.core.text import Text
from processing.map.change import Change
from processing.project.project import Project


class UndoStack(QObject):
    """Applies changes to the open project and takes them back.

    Raises, from every method that writes, what the project's store raises: the project is then as
    it was.
    """

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._project: Project | None = None

    @property
    def undo_label(self) -> Text | None:
        """What undo would take back; None when nothing can be."""
        return None if self._project is None else self._project.history.undo_label

    @property
    def redo_label(self) -> Text | None:
        """What redo would do again; None when nothing can be."""
        return None if self._project is None else self._project.history.redo_label

    def use(self, project: Project | None) -> None:
        """Work on a project's history from now on."""
        self._project = project
        self.changed.emit()

    def push(self, label: Text, change: Change) -> None:
        """Apply a change and remember it."""
        if self._project is not None and not change.is_empty:
            self._project.features.apply(label, change)
            self.changed.emit()

    def note(self, change: Change) -> None:
        """A change was applied to the project, and remembered there."""
        if not change.is_empty:
            self.changed.emit()

    def undo(self, *, are_columns_made: bool = False) -> Change | None:
        """Take the last change back; gives what was applied to do so.

        Parameters
        ----------
        are_columns_made : bool
            As of :meth:`processing.project.store.feature_store.FeatureStore.undo`.
        """
        if self._project is None:
            return None
        return self._move_change(self._project.features.undo(are_columns_made=are_columns_made))

    def redo(self, *, are_columns_made: bool = False) -> Change | None:
        """Do again what was undone; gives what was applied; parameters as :meth:`undo`."""
        if self._project is None:
            return None
        return self._move_change(self._project.features.redo(are_columns_made=are_columns_made))

    def _move_change(self, change: Change | None) -> Change | None:
        if change is not None:
            self.changed.emit()
        return change
