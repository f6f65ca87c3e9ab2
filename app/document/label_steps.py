"""LabelSteps: steps that label many points; a job makes them, and the map takes them over at once.

Whatever is drawn, painted and taken back meanwhile is done as ever: a step that arrives leaves
points to who painted them since, and to undo labels is given up where the map has moved on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial

from PySide6.QtCore import QObject, Signal

from app.document.job_results import JobResultApplier
from app.document.undo import UndoStack
from app.jobs.jobs import JobLane
from processing.core.errors import InUse, UserError
from processing.core.monitor import Monitor
from processing.core.owned_files import remove_folder
from processing.core.text import Text
from processing.map.change import Change
from processing.map.filed_labels import FiledLabels
from processing.map.label_change import LabelChange
from processing.project.project import Project
from processing.project.store.database_errors import changed_elsewhere
from processing.project.store.label_filing import (
    Relabel,
    drop_repainted,
    labels_as_change,
    make_columns,
    rebase_labels,
    relabelled_by_hand,
)

_STORING = Text("Storing: {label}", "保存: {label}")
_UNDO, _REDO = (
    Text("Undo: {label}", "元に戻す: {label}"),
    Text("Redo: {label}", "やり直す: {label}"),
)
_BUSY = Text("Still at it: {label}", "処理中です: {label}")
_GIVEN_UP = Text(
    "The map was changed meanwhile, so this was given up: {label}",
    "途中で地図が変更されたため中止しました: {label}",
)
_TAKEN_BACK = Text("Taken back: {label}", "取り消しました: {label}")

ChangeListener = Callable[[Callable[[], Change | None]], bool]


@dataclass
class LabelStep:
    """A step under way.

    Attributes
    ----------
    relabel : callable
        What its codes change where other labels of many points came first.
    request : Change or None
        What was painted; None for a run.
    missed : list of Change
        What became of the map since its columns were begun.
    """

    project: Project
    label: Text
    relabel: Relabel = relabelled_by_hand
    request: Change | None = None
    missed: list[Change] = field(default_factory=list)
    job: str = ""


class LabelSteps(QObject):
    """Steps of the open project that label more points than an instant is enough for.

    Parameters
    ----------
    adoption : JobResultApplier
    undo_stack : UndoStack
    changed : callable
        Does a change and tells everybody; says whether it could.

    Signals
    -------
    told(text: Text), refused(error: UserError), cancelled(job: str)
        As the document's; a job is to be cancelled.
    step_coming(change: Change)
        As the document's.
    """

    reported = Signal(object)
    refused = Signal(object)
    cancelled = Signal(str)
    step_coming = Signal(object)

    def __init__(
        self,
        adoption: JobResultApplier,
        undo_stack: UndoStack,
        changed: ChangeListener,
        parent: QObject,
    ) -> None:
        super().__init__(parent)
        self._job_results = adoption
        self._undo_stack = undo_stack
        self._changed = changed
        self._steps: list[LabelStep] = []
        self._move: LabelStep | None = None

    @property
    def is_busy(self) -> bool:
        """Whether labels of many points are being stored, or a step about them moved."""
        return self._move is not None or any(one.job for one in self._steps)

    def refuse_busy(self) -> None:
        """Refuse what has to wait until labels are stored.

        Raises
        ------
        InUse
        """
        if self.is_busy:
            raise InUse(
                Text("Labels are still being stored.", "ラベルを保存中です。"),
                Text("the map", "地図"),
                Text("Try again in a moment.", "しばらくしてからもう一度実行してください。"),
            )

    def begin(self, project: Project, label: Text, relabel: Relabel) -> LabelStep:
        """A run begins that may label many points; :meth:`arrive` or :meth:`drop` ends it."""
        step = LabelStep(project, label, relabel)
        self._steps.append(step)
        return step

    def drop(self, step: LabelStep, change: Change | None = None) -> None:
        """Nothing comes of a step."""
        self._steps = [one for one in self._steps if one is not step]
        if change is not None and change.filed is not None:
            remove_folder(change.filed.folder)

    def arrive(self, step: LabelStep, change: Change, take: Callable[[Change], object]) -> None:
        """What a step's job made goes on the map once it has caught up with what was painted."""
        if not any(one is step for one in self._steps):
            self.drop(step, change)  # it was taken back while its end was on its way
            return
        filed = change.filed
        if filed is None or not step.missed:
            self.drop(step)
            take(change)
            return
        missed = tuple(step.missed)
        step.missed.clear()
        drives = {drive.id: drive for drive in step.project.drives}
        painted = _labels_in(missed)
        relabel = step.relabel if any(each.filed for each in missed) else None

        def work(monitor: Monitor) -> Change:
            found = drop_repainted(filed, painted, drives.__getitem__, monitor, relabel=relabel)
            return replace(change, filed=found)

        step.job = self._job_results.start(
            step.project,
            _STORING.filled(label=step.label),
            work,
            lambda found: self.arrive(step, found, take),
            lane=JobLane.STEPS,
            otherwise=lambda: self.drop(step, change),
        )

    def paint(self, project: Project, label: Text, change: Change) -> None:
        """Do what somebody painted on many points."""
        step = LabelStep(project, label, request=change)
        self._steps.append(step)
        folder, drives = project.label_folder(), {drive.id: drive for drive in project.drives}

        def work(monitor: Monitor) -> Change:
            found = labels_as_change(change.labels, folder, drives.__getitem__, monitor)
            return replace(change, labels=found.labels, filed=found.filed)

        def take(found: Change) -> None:
            self._changed(lambda: self._push_change(label, found))

        step.job = self._job_results.start(
            project,
            label,
            work,
            lambda found: self.arrive(step, found, take),
            lane=JobLane.STEPS,
            otherwise=lambda: self.drop(step),
        )

    def move(self, project: Project, by: int) -> bool:
        """Undo (−1) or redo (1); says whether there is something."""
        painted = [one for one in self._steps if one.request is not None]
        if by < 0 and painted:
            self.drop(painted[-1])
            self.cancelled.emit(painted[-1].job)
            self.reported.emit(_TAKEN_BACK.filled(label=painted[-1].label))
            return True
        if self._move is not None:
            self.reported.emit(_BUSY.filled(label=self._move.label))
            return False
        try:
            filed = project.features.coming_labels(by)
            moved = project.history.coming_move(by)
        except UserError as error:
            self.refused.emit(error)
            return False
        act = self._undo_stack.undo if by < 0 else self._undo_stack.redo
        if filed is None:
            if moved is not None:
                self.step_coming.emit(moved)
            return self._changed(act)
        self._begin_move(project, filed, by)
        return True

    def note(self, change: Change) -> None:
        """The map was changed."""
        for step in self._steps:
            if change.labels or change.filed is not None:
                step.missed.append(change)
        if self._move is not None:
            self._move.missed.append(change)
            self.cancelled.emit(self._move.job)

    def finish(self) -> None:
        """The project is closed: what was painted is stored now, what is moved stays as it is."""
        for step in [one for one in self._steps if one.request is not None]:
            self.drop(step)
            request = step.request or Change()
            labels = rebase_labels(request.labels, _labels_in(step.missed), step.project.drive)
            rest = replace(request, labels=labels)
            self._changed(partial(self._push_change, step.label, rest))
        self._steps.clear()
        self._move = None

    def _begin_move(self, project: Project, filed: FiledLabels, by: int) -> None:
        stack = self._undo_stack
        words, label = (_UNDO, stack.undo_label) if by < 0 else (_REDO, stack.redo_label)
        step = LabelStep(project, words.filled(label=label or Text("", "")))
        drives = {drive.id: drive for drive in project.drives}

        def work(monitor: Monitor) -> bool:
            return make_columns(filed, drives.__getitem__, monitor)

        def take(fits: bool) -> None:  # noqa: FBT001 - a job's result
            if step.missed:
                self._end_move(step, filed)
                return
            self._move = None
            if not fits:
                self.refused.emit(changed_elsewhere(filed.folder, ", ".join(filed.counts)))
                return
            act = stack.undo if by < 0 else stack.redo
            self._changed(lambda: act(are_columns_made=True))

        self._move = step
        step.job = self._job_results.start(
            project,
            step.label,
            work,
            take,
            lane=JobLane.STEPS,
            otherwise=lambda: self._end_move(step, filed),
        )

    def _end_move(self, step: LabelStep, filed: FiledLabels) -> None:
        if self._move is step:
            self._move = None
        for id_ in filed.counts:
            with suppress(OSError):
                filed.column_file(id_).unlink(missing_ok=True)
        if step.missed:
            self.reported.emit(_GIVEN_UP.filled(label=step.label))

    def _push_change(self, label: Text, change: Change) -> Change:
        self._undo_stack.push(label, change)
        return change


def _labels_in(changes: Sequence[Change]) -> tuple[LabelChange, ...]:
    return tuple(one for each in changes for one in each.labels)
