"""Document: what is open, and the only place from which the project is changed."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal

from app.document.drive_results import DriveResults
from app.document.job_results import JobResultApplier
from app.document.label_news import report_labels
from app.document.label_steps import LabelSteps
from app.document.long_work import exported_words, points_work, written_words
from app.document.preparation import Preparation
from app.document.run_results import RunResultApplier
from app.document.undo import UndoStack
from app.jobs.jobs import JobLane, JobQueue
from processing.core.errors import OutOfRange, UserError
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.image.attributes.tile_cache import TileCache
from processing.map.catalogue import Catalogue
from processing.map.catalogue_file import read_catalogue
from processing.map.change import Change
from processing.map.feature import Feature
from processing.operations.export import ExportRequest
from processing.operations.new_points import points_operation_on_drive
from processing.operations.project_export import WrittenFiles, export_of
from processing.operations.run import operation_on_drive
from processing.operations.runs.finished_runs import FinishedRun
from processing.operations.store import StoredRun, store_prepared, store_run
from processing.project.importing.importing import ImportRequest
from processing.project.photos import photo_of
from processing.project.project import Project
from processing.project.results.found_features import FoundFeatures
from processing.project.store.label_filing import are_many
from processing.project.store.runs import Run
from processing.project.template_store import TemplateStore
from processing.recording.drive import Drive
from processing.tools.tool import Tool
from resources import path_of
from widgets.shared.cursor import Cursor
from widgets.shared.map_changes import MapChanges
from widgets.shared.selection import Selection
from widgets.shared.shared_state import SharedState
from widgets.shared.sketch import Sketch
from widgets.shared.snap_state import SnapState
from widgets.shared.view_settings import ViewSettings

_MadeT = TypeVar("_MadeT")

PRINTING = Text("Print", "印刷")
"""What the job is called that makes sheets for a printer."""


class Document(QObject):
    """The open project and what all views share of it.

    Signals
    -------
    about_to_close, opened, closed
        A project is open for the last moment; was opened; was closed.
    catalogue_changed
        Another catalogue counts in the open project.
    refused(error: UserError)
        Something the user wanted can't be done; everything is as it was.
    reported(text: Text)
        Something was done that is worth a line.
    exported(written: WrittenFiles, folder: Path)
        The map was written to files.
    step_coming(change: Change)
        A step about drives or files is undone or done again in a moment.
    """

    about_to_close = Signal()
    opened = Signal()
    closed = Signal()
    catalogue_changed = Signal()
    refused = Signal(object)
    reported = Signal(object)
    exported = Signal(object, object)
    step_coming = Signal(object)

    def __init__(self, jobs: JobQueue, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.shared = SharedState(
            Cursor(self),
            Selection(self),
            MapChanges(self),
            ViewSettings(self),
            Sketch(self),
            SnapState(self),
        )
        self.undo_stack = UndoStack(self)
        self.tiles = TileCache()
        self.tiles.use(self.drive)
        self._project: Project | None = None
        self._bundled_catalogue = read_catalogue(path_of("catalogue/level500.toml"))
        self._job_results = JobResultApplier(jobs, self)
        self._job_results.refused.connect(self.refused)
        self.reported.connect(self._job_results.note_result)
        self._label_steps = LabelSteps(
            self._job_results, self.undo_stack, self._change_history, self
        )
        self._label_steps.step_coming.connect(self.step_coming)
        self._runs = RunResultApplier(
            self._job_results, self._label_steps, self._store_finished, self._store_prepared
        )
        self._label_steps.reported.connect(self.reported)
        self._label_steps.refused.connect(self.refused)
        self._label_steps.cancelled.connect(jobs.cancel)
        self.drive_results = DriveResults(
            self._job_results, self._label_steps, self.tiles, self.shared, self
        )
        self.drive_results.reported.connect(self.reported)
        self.drive_results.refused.connect(self.refused)
        self.drive_results.taken.connect(self._on_drives_taken)
        self.step_coming.connect(self.drive_results.on_step_coming)
        self._preparation = Preparation(self._prepare, jobs, self)

    # Reading: what views ask (MapSource).

    @property
    def project(self) -> Project | None:
        """The open project, or None."""
        return self._project

    def drives(self) -> tuple[Drive, ...]:
        """All drives; none when nothing is open."""
        return () if self._project is None else self._project.drives

    def drive(self, id: str) -> Drive:  # noqa: A002 - the word of the trade
        """One drive; KeyError when there is none of that id."""
        if self._project is None:
            raise KeyError(id)
        return self._project.drive(id)

    def origin(self) -> NDArray[np.float64]:
        """The (3,) local origin of drawing, m, project CRS."""
        return np.zeros(3) if self._project is None else self._project.origin

    def features(self) -> Iterable[Feature]:
        """All features."""
        return () if self._project is None else self._project.features.all()

    def feature(self, id: str) -> Feature | None:  # noqa: A002 - the word of the trade
        """One feature, or None."""
        return None if self._project is None else self._project.features.get(id)

    def photo(self, feature: Feature) -> Path | None:
        """The file of a feature's picture, or None."""
        return None if self._project is None else photo_of(feature, self._project.folder)

    def runs(self) -> tuple[Run, ...]:
        """The runs of tools, the first one first."""
        try:
            return () if self._project is None else self._project.runs.all()
        except UserError as error:
            self.refused.emit(error)
            return ()

    def templates(self) -> TemplateStore | None:
        """The project's templates; None when nothing is open."""
        return None if self._project is None else TemplateStore(self._project.settings)

    def catalogue(self) -> Catalogue:
        """The project's feature kinds, or the bundled ones when nothing is open."""
        return self._bundled_catalogue if self._project is None else self._project.catalogue

    def crs(self) -> str:
        """``EPSG:n``, or empty when unknown."""
        return "" if self._project is None else self._project.crs

    # Opening and closing.

    def open(self, folder: Path) -> bool:
        """Open a project in place of the one that is open; says whether it could."""
        return self._replace_by(lambda: Project.open(folder))

    def create(self, folder: Path, crs: str) -> bool:
        """Make a new, empty project and open it; says whether it could."""
        return self._replace_by(lambda: Project.create(folder, crs))

    def close(self) -> None:
        """Close the project; jobs on it go on without effect."""
        if self._project is None:
            return
        self.about_to_close.emit()
        self._label_steps.finish()
        self._preparation.give_up()
        self._job_results.give_up()
        self.shared.sketch.show(None)
        self.shared.snap.work_on(None)
        self.shared.selection.clear()
        self.shared.cursor.clear()
        for drive in self._project.drives:
            self.tiles.drop(drive.id)
        project, self._project = self._project, None
        self.undo_stack.use(None)
        project.close()
        self.shared.view_settings.show_image("", self.shared.view_settings.image_kind)
        self.shared.map_changes.drives_changed.emit()
        self.closed.emit()

    # Changing the map.

    def apply(self, label: Text, change: Change) -> bool:
        """Do a change as one undoable step; says whether it could.

        A change of something that has become something else meanwhile is refused: another window
        part or a job was quicker, and its work must not be lost. Labels of many points are
        seen when a job has stored them.
        """
        if self._project is not None and are_many(change.labels):
            self._label_steps.paint(self._project, label, change)
            return True
        if self._project is not None and not self._project.features.fits(change):
            self.refused.emit(refuse_changed())
            return False

        def push() -> Change:
            self.undo_stack.push(label, change)
            return change

        return self._change_history(push)

    def do_step(self, act: Callable[[Project], Change]) -> bool:
        """Have a function do a step of the open project; tells the views, says whether it could."""
        project = self._need_project()

        def noted() -> Change:
            change = act(project)
            self.undo_stack.note(change)
            return change

        return self._change_history(noted)

    def undo(self) -> bool:
        """Take the last step back; says whether there was one."""
        return self._project is not None and self._label_steps.move(self._project, -1)

    def redo(self) -> bool:
        """Do the step again that was undone; says whether there was one."""
        return self._project is not None and self._label_steps.move(self._project, 1)

    def set_reference_system(self, crs: str) -> bool:
        """Say what reference system the coordinates are in; says whether it could."""
        try:
            self._need_project().set_crs(crs)
        except UserError as error:
            self.refused.emit(error)
            return False
        self.shared.map_changes.drives_changed.emit()
        return True

    def adopt_catalogue(self, path: Path, *, keep_used: bool) -> bool:
        """Use an office's catalogue in the project; says whether it could."""
        try:
            self._need_project().adopt_catalogue(path, keep_used=keep_used)
        except UserError as error:
            self.refused.emit(error)
            return False
        self.catalogue_changed.emit()
        self.shared.map_changes.features_changed.emit(tuple(f.id for f in self.features()))
        reported = Text(
            "The catalogue has {count} kinds now.", "カタログは{count}種別になりました。"
        )
        self.reported.emit(reported.filled(count=len(self.catalogue())))
        return True

    def export_catalogue(self, path: Path) -> None:
        """Write the project's catalogue as a file to start an own one from."""
        try:
            self._need_project().export_catalogue(path)
        except UserError as error:
            self.refused.emit(error)
            return
        self.reported.emit(
            Text("Wrote {path}.", "{path} を書き出しました。").filled(path=path.name)
        )

    # Long work.

    def import_into_new(self, folder: Path, request: ImportRequest) -> str:
        """Import delivered files into a new project, which goes again if nothing comes of it.

        Returns
        -------
        str
            The job's id; empty when the project can't be made.
        """
        if not self.create(folder, request.crs):
            return ""
        project = self._need_project()
        return self.drive_results.start(project, request, lambda: self._drop_if_empty(project), ())

    def import_files(
        self,
        request: ImportRequest,
        only: Collection[str] = (),
        *,
        replacing: Collection[str] = (),
    ) -> str:
        """Import delivered files, or complete drives with them, in the background; gives the job.

        Parameters
        ----------
        only : collection of str
            Ids of drives that trajectories and images without points are for.
        replacing : collection of str
            Ids of drives that the new ones take the place of.
        """
        return self.drive_results.start(
            self._need_project(), request, lambda: None, only, replacing=replacing
        )

    def remove_drives(self, ids: Iterable[str]) -> bool:
        """Take drives out of the project as one undoable step; says whether it could."""
        return self.drive_results.remove(self._need_project(), ids, self.apply)

    def start_run(
        self, tool: str, drive_id: str, parameters: object, *, lane: JobLane = JobLane.ASKED
    ) -> str:
        """Run a tool on a drive in the background; gives the job's id."""
        project = self._need_project()
        operation = operation_on_drive(tool, parameters, project.folder, drive_id)
        return self._runs.start(project, operation, lane)

    def store_run(self, found: FoundFeatures) -> bool:
        """Put a run with what it found on the map as one undoable step; says whether it could."""
        return self._store_finished(FinishedRun(found=found))

    def run_in_background(
        self, work: Callable[[], object], take: Callable[[object | None], None]
    ) -> None:
        """Do a moment's work for the tool in the hand; it gets None where that failed."""
        self._job_results.start_at_hand(self._need_project(), work, take)

    def prepare_step(
        self,
        title: Text,
        work: Callable[[Monitor], _MadeT],
        act: Callable[[Project, _MadeT], Change],
        done: Callable[[_MadeT], None],
    ) -> str:
        """Have a job make what a step of the open project needs; gives the job's id.

        Parameters
        ----------
        work : callable
            Runs beside the window, and touches neither the project nor a widget.
        act : callable
            Does the step with what came of it.
        done : callable
            Called when that was done, also where it changed nothing.
        """
        project = self._need_project()

        def take(made: _MadeT) -> None:
            acted: list[_MadeT] = []

            def step(opened: Project) -> Change:
                change = act(opened, made)
                acted.append(made)
                return change

            self.do_step(step)
            for one in acted:
                done(one)

        return self._job_results.start(project, title, work, take)

    def export(self, request: ExportRequest) -> str:
        """Write the map to files in the background; gives the job's id, empty where it can't."""
        project, title = self._need_project(), Text("Export", "書き出し")
        try:
            work = export_of(project, request)
        except UserError as error:  # what papers say of the work can't be read
            self.refused.emit(error)
            return ""

        def take(written: WrittenFiles) -> None:
            self.reported.emit(exported_words(written, request.folder))
            self.exported.emit(written, request.folder)

        return self._job_results.start(project, title, work, take)

    def make_points(self, tool: str, drive_id: str, parameters: object, output: Path) -> str:
        """Have a tool write points of its own to a file in the background; gives the job's id."""
        project, drive = self._need_project(), self.drive(drive_id)
        operation = points_operation_on_drive(tool, parameters, drive, project, output)

        def take(written: Path) -> None:
            self.reported.emit(written_words(written))

        title, work = points_work(operation, drive)
        return self._job_results.start(project, title, work, take)

    def make_pages(
        self, request: ExportRequest, then: Callable[[], None], title: Text = PRINTING
    ) -> str:
        """Write sheets to be printed or shown in the background, then call; gives the job's id."""
        project = self._need_project()
        work = export_of(project, request)

        def take(written: WrittenFiles) -> None:
            for note in written.notes:
                self.reported.emit(note)
            then()

        return self._job_results.start(project, title, work, take)

    def _need_project(self) -> Project:
        if self._project is None:
            message = "no project is open"
            raise ValueError(message)
        return self._project

    def _drop_if_empty(self, project: Project) -> None:
        """Leave no empty project behind an import that failed."""
        if project is self._project and project.is_empty:
            self.close()
            Project.remove_new(project.folder)

    def _on_drives_taken(self) -> None:
        self.undo_stack.changed.emit()
        self._prepare_drives()

    def _prepare_drives(self) -> None:
        """Find in the background what attributes show, so that switching to them is quick."""
        self._preparation.begin(self.drives())

    def _prepare(self, tool: Tool, drive: Drive) -> str:
        return self.start_run(tool.id, drive.id, tool.parameters(), lane=JobLane.PREPARED)

    def _store_finished(self, done: FinishedRun) -> bool:
        """Put what a run gave into the project and tell the views; says whether the map changed."""
        stored: list[StoredRun] = []

        def act(project: Project) -> Change:
            stored.append(store_run(project, done))
            return stored[-1].change

        is_changed = self.do_step(act)
        # Told last: the review says what it loses by this step, which is the lesser news.
        for one in stored:
            if one.run is None:
                continue
            self.reported.emit(one.summary)
            if one.change.added:
                self.shared.map_changes.candidates_found.emit(one.run.tool, one.run.id)
        if done.found is not None and (done.found.change.labels or done.found.change.filed):
            self.drive_results.first_look.show_classes()
        return is_changed

    def _store_prepared(self, done: FinishedRun) -> None:
        try:
            store_prepared(self._need_project(), done)
        except UserError as error:
            self.refused.emit(error)
            return
        self._tell_columns(done.drive)

    def _tell_columns(self, drive: str) -> None:
        self.tiles.drop(drive)
        self.shared.map_changes.drive_columns_changed.emit(drive)

    def _change_history(self, act: Callable[[], Change | None]) -> bool:
        try:
            change = act()
        except UserError as error:
            self.refused.emit(error)
            return False
        if change is None or change.is_empty:
            return False
        removed = {feature.id for feature in change.removed}
        selection = self.shared.selection
        selection.choose_features(selection.features - removed)
        if change.feature_ids:
            self.shared.map_changes.features_changed.emit(change.feature_ids)
        labels = tuple((self.drive(one.drive), one) for one in change.labels)
        filed = () if change.filed is None else change.filed.counts
        report_labels(labels, filed, self.tiles, self.shared.map_changes)
        self._label_steps.note(change)
        self.drive_results.follow_step(self._need_project(), change)
        if change.files is not None:
            for drive in change.files.drives:
                self._tell_columns(drive)
            if change.files.names_of(""):
                self.shared.map_changes.volumes_changed.emit()
        return True

    def _replace_by(self, make: Callable[[], Project]) -> bool:
        try:
            project = make()
        except UserError as error:
            self.refused.emit(error)
            return False
        self.close()
        self._project = project
        self.undo_stack.use(project)
        self.drive_results.first_look.show(self.drives())
        self.opened.emit()
        self.shared.map_changes.drives_changed.emit()
        self.shared.map_changes.features_changed.emit(tuple(f.id for f in self.features()))
        self._prepare_drives()
        return True


def refuse_changed() -> UserError:
    """What a change is about has become something else."""
    return OutOfRange(
        Text(
            "The feature was changed while you edited it; it stays as it is now.",
            "編集中に地物が変更されたため、現在の状態のままにしました。",
        ),
        Text("the map", "地図"),
        Text("Do your edit again.", "もう一度編集してください。"),
    )
