"""TruthEvaluations: truths of points, and how good runs and settings are by them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from datetime import UTC, datetime
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from app.classes.error_map_columns import ErrorMapColumns
from app.classes.truth_work import StudyOptions, study_work, truth_by_hand_work, truth_file_work
from app.document.document import Document
from app.document.job_results import JobResultApplier
from app.jobs.jobs import JobLane, JobQueue
from processing.core.errors import Unsuitable, UserError
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.image.search.clip import Clip
from processing.project.evaluation.class_evaluation import ClassEvaluation, evaluate_classes
from processing.project.evaluation.parameter_study import ParameterStudy
from processing.project.evaluation.study_store import KeptStudy, StudyStore, new_study_id
from processing.project.evaluation.truth_making import CheckedPoints, MadeTruth
from processing.project.evaluation.truth_store import Truth, TruthStore, has_truth, new_truth_id
from processing.project.project import Project
from processing.recording.drive import Drive
from processing.recording.recorded_together import recorded_together

_MADE = Text("Truth of {points} points: {name}", "{points}点の正解を登録しました: {name}")
_JUDGING = Text("Evaluation", "評価")


class TruthEvaluations(QObject):
    """Truths, evaluations and studies of the open project.

    Parameters
    ----------
    document : Document
    jobs : JobQueue

    Signals
    -------
    truths_changed, studies_changed
        There are others now; also when a project was opened or closed.
    judged(truth: str, evaluations: tuple[ClassEvaluation, ...])
        What :meth:`judge` asked for.
    truth_made(truth: Truth), study_made(kept: KeptStudy)
        A new one.
    """

    truths_changed = Signal()
    studies_changed = Signal()
    judged = Signal(str, object)
    truth_made = Signal(object)
    study_made = Signal(object)

    def __init__(self, document: Document, jobs: JobQueue, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._jobs = jobs
        self._job_results = JobResultApplier(jobs, self)
        self._job_results.refused.connect(document.refused)
        self._picture = ErrorMapColumns(document, self._job_results, self)
        self._counted: tuple[str, tuple[ClassEvaluation, ...]] = ("", ())
        self._evaluations = ""
        document.about_to_close.connect(self._job_results.give_up)
        document.opened.connect(self._on_document_opened)
        document.closed.connect(self._tell_all)

    # What there is.

    def truths(self) -> tuple[Truth, ...]:
        """The truths of the open project."""
        project = self._document.project
        return () if project is None else TruthStore(project.settings).all()

    def studies(self) -> tuple[KeptStudy, ...]:
        """The studies of the open project, the first one first."""
        project = self._document.project
        return () if project is None else StudyStore(project.settings).all()

    # Truths.

    def make_truth(self, checked: CheckedPoints, clip: Clip | None) -> str:
        """Let the classes as they stand now be a truth; gives the job's id.

        It is about the drive shown and those recorded together with it, as a run is.

        Parameters
        ----------
        clip : Clip or None
            What the 3D view shows, for ``CheckedPoints.CLIP``.
        """
        project, drives = self._open(), self._shown_drives()
        if project is None or not drives:
            return ""
        clip = clip if checked is CheckedPoints.CLIP else None
        is_painted = checked is CheckedPoints.PAINTED
        into = project.temporary_folder()
        work = truth_by_hand_work(drives, into, clip=clip, only_painted=is_painted)
        return self._start_truth(project, _NAMES[checked].filled(drive=_name_of(drives)), work)

    def load_truth(self, path: Path) -> str:
        """Take the truth of a delivered file from a file; gives the job's id."""
        project = self._open()
        if project is None:
            return ""
        work = truth_file_work(self._document.drives(), path, project.temporary_folder())
        return self._start_truth(project, Text.same(path.name), work)

    def remove_truth(self, id_: str) -> None:
        """Forget a truth for good."""
        self._change(lambda project: self._forget_truth(project, id_), self.truths_changed.emit)

    def remove_study(self, id_: str) -> None:
        """Forget a study for good."""
        self._change(
            lambda project: StudyStore(project.settings).remove(id_), self.studies_changed.emit
        )

    # Judging.

    def judge(self, truth: str) -> None:
        """Count all runs by a truth in the background; `judged` tells what came of it."""
        project = self._open()
        if project is None or TruthStore(project.settings).get(truth) is None:
            self.judged.emit(truth, ())
            return
        runs, drives = self._document.runs(), self._document.drives()
        counted = self._counted[1] if self._counted[0] == truth else ()

        def work(monitor: Monitor) -> tuple[ClassEvaluation, ...]:
            return evaluate_classes(runs, drives, truth, monitor, counted=counted)

        def take(found: tuple[ClassEvaluation, ...]) -> None:
            self._counted = truth, found
            self.judged.emit(truth, found)

        # What was asked for before would be out of date.
        self._jobs.cancel(self._evaluations)
        # Nobody waits for it, but for the numbers: it is no entry in the list of jobs.
        self._evaluations = self._job_results.start(
            project, _JUDGING, work, take, lane=JobLane.INTERACTIVE
        )

    def show_points(self, truth: str, evaluation: ClassEvaluation) -> str:
        """Colour the points by what was right and wrong, in all views; gives the job's id."""
        project = self._open()
        if project is None:
            return ""
        return self._picture.show(project, truth, evaluation)

    def study(self, request: StudyOptions) -> str:
        """Go through values of parameters where a truth is about what is shown; the job's id."""
        project, shown = self._open(), self._shown_drives()
        truth = None if project is None else TruthStore(project.settings).get(request.truth)
        if project is None or not shown or truth is None:
            return ""
        drives = tuple(drive for drive in shown if has_truth(drive, truth.id))
        if not drives:
            self._document.refused.emit(_other_drive(shown[0], truth))
            return ""
        beside = tuple(other for other in self._document.drives() if other not in drives)
        title, work = study_work(request, drives, beside, project.temporary_folder())

        def take(study: ParameterStudy) -> None:
            kept = KeptStudy(
                new_study_id(),
                study,
                truth.name,
                _name_of(drives).en,
                request.is_part,
                datetime.now(UTC),
            )
            StudyStore(project.settings).add(kept)
            self.studies_changed.emit()
            self.study_made.emit(kept)

        return self._job_results.start(project, title, work, take)

    def _start_truth(
        self, project: Project, name: Text, work: Callable[[Monitor], MadeTruth]
    ) -> str:
        def take(made: MadeTruth) -> None:
            moment = datetime.now(UTC)
            truth = Truth(new_truth_id(), name, dict(made.known), moment)
            store = TruthStore(project.settings)
            store.add(truth, made.folders, self._document.drive)
            self.truths_changed.emit()
            self.truth_made.emit(truth)
            self._document.reported.emit(_MADE.filled(points=f"{truth.points:,}", name=name))

        title = Text("Truth: {name}", "正解: {name}").filled(name=name)
        return self._job_results.start(project, title, work, take)

    def _forget_truth(self, project: Project, id_: str) -> None:
        TruthStore(project.settings).remove(id_, self._document.drive)

    def _change(self, act: Callable[[Project], None], tell: Callable[[], None]) -> None:
        project = self._open()
        if project is None:
            return
        try:
            act(project)
        except UserError as error:
            self._document.refused.emit(error)
        tell()

    def _open(self) -> Project | None:
        return self._document.project

    def _shown_drives(self) -> tuple[Drive, ...]:
        """The drive shown, and those recorded together with it."""
        id_ = self._document.shared.view_settings.drive_id
        if not id_:
            return ()
        shown = self._document.drive(id_)
        beside = [other for other in self._document.drives() if other is not shown]
        return recorded_together(shown, beside)

    def _on_document_opened(self) -> None:
        project = self._open()
        if project is not None:
            TruthStore(project.settings).remove_unlisted(project.drives)
        self._tell_all()

    def _tell_all(self) -> None:
        self.truths_changed.emit()
        self.studies_changed.emit()


_NAMES = {
    CheckedPoints.WHOLE: Text("{drive}: all checked", "{drive}: 全体を確認"),
    CheckedPoints.CLIP: Text("{drive}: a part checked", "{drive}: 一部を確認"),
    CheckedPoints.PAINTED: Text("{drive}: painted points", "{drive}: 手動ラベル"),
}


def _name_of(drives: Sequence[Drive]) -> Text:
    first, more = drives[0].info.name, len(drives) - 1
    if not more:
        return Text.same(first)
    return Text("{first} and {more} more", "{first} ほか{more}件").filled(first=first, more=more)


def _other_drive(drive: Drive, truth: Truth) -> UserError:
    return Unsuitable(
        Text(
            "The truth “{name}” is not about this drive.",
            "正解「{name}」はこの走行データのものではありません。",
        ).filled(name=truth.name),
        Text.same(drive.info.name),
        Text(
            "Show a drive of the truth, or choose another truth.",
            "正解のある走行データを表示するか、別の正解を選んでください。",
        ),
    )
