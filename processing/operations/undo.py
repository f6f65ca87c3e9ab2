"""Taking the last step of a project back: a run, its acceptance, an edit; any of them once more."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.operations.inputs import opened_project

_UNDONE = Text("Undone: {label}", "元に戻しました: {label}")
_NOTHING = Text("There is nothing to undo.", "元に戻す操作はありません。")


@dataclass(frozen=True)
class UndoOperation:
    """The last step of a project, to be taken back.

    Attributes
    ----------
    project : Path
    """

    project: Path


@dataclass(frozen=True)
class UndoneStep:
    """The step that was taken back.

    Attributes
    ----------
    label : Text or None
        What the undo menu calls it; None where there was none.
    """

    label: Text | None

    @property
    def words(self) -> tuple[Text, ...]:
        """One line."""
        return (_NOTHING if self.label is None else _UNDONE.filled(label=self.label),)


def undo_step(operation: UndoOperation, monitor: Monitor) -> UndoneStep:
    """Take the last step back; it can be done again in the window.

    Raises
    ------
    MissingInput, BadFile, InUse, NoSpace, Cancelled
        The project is as it was.
    """
    with opened_project(operation.project, writing=True) as project:
        monitor.check()
        label = project.history.undo_label
        return UndoneStep(None if project.features.undo() is None else label)
