"""DriveResults: drives that come, are completed or go, and what the window makes of it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import replace

from PySide6.QtCore import QObject, Signal

from app.document.import_words import imported_words, removed_words
from app.document.initial_view import InitialView, best_kind
from app.document.job_results import JobResultApplier
from app.document.label_steps import LabelSteps
from app.document.long_work import import_work
from app.jobs.jobs import JobLane
from processing.core.errors import UserError
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.image.attributes.tile_cache import TileCache
from processing.map.change import Change
from processing.project.additions import Additions, lacks_trajectory, take_over
from processing.project.drive_removal import removal_of
from processing.project.importing.drive_completion import carry_results_again
from processing.project.importing.import_request import ImportRequest
from processing.project.project import Project
from processing.project.store.open_drives import READ_AT_OPENING
from widgets.shared.shared_state import SharedState

_CARRYING = Text("Taking over labels", "ラベルの引き継ぎ")


class DriveResults(QObject):
    """Brings delivered files into a project, and lets the views follow.

    Parameters
    ----------
    adoption : JobResultApplier
    label_steps : LabelSteps
    tiles : TileCache
    shared : SharedState

    Signals
    -------
    told(text: Text), refused(error: UserError)
        As the document's.
    points_leaving()
        Points that somebody may have in the hand are gone or elsewhere in a moment.
    taken(drives: tuple[Drive, ...])
        Drives are new or others now.
    beside_found(offer: ImportRequest, drives: tuple[str, ...])
        These new drives have no trajectory, and one lies beside their files.
    """

    reported = Signal(object)
    refused = Signal(object)
    points_leaving = Signal()
    taken = Signal(object)
    beside_found = Signal(object, object)

    def __init__(
        self,
        adoption: JobResultApplier,
        label_steps: LabelSteps,
        tiles: TileCache,
        shared: SharedState,
        parent: QObject,
    ) -> None:
        super().__init__(parent)
        self._job_results = adoption
        self._label_steps = label_steps
        self._tiles = tiles
        self._shared = shared
        self.first_look = InitialView(shared.view_settings)

    def start(
        self,
        project: Project,
        request: ImportRequest,
        otherwise: Callable[[], None],
        only: Collection[str],
        *,
        replacing: Collection[str] = (),
    ) -> str:
        """Bring files in, in the background; gives the job's id.

        Parameters
        ----------
        otherwise : callable
            Called where nothing comes of it.
        only : collection of str
            As of :func:`processing.project.additions.bring_in`.
        replacing : collection of str
            Ids of drives that go when the new ones are there.
        """
        title, work = import_work(request, project, only)

        def take(brought: Additions) -> None:
            there = [drive.id for drive in project.drives if drive.id in replacing]
            self._take(project, replace(brought, replaced=tuple(there)))

        return self._job_results.start(project, title, work, take, otherwise=otherwise)

    def remove(
        self, project: Project, ids: Iterable[str], apply: Callable[[Text, Change], bool]
    ) -> bool:
        """Take drives out of the project as one step; says whether it could."""
        drives = [project.drive(id_) for id_ in ids]
        names = ", ".join(drive.info.name for drive in drives)
        try:
            self._label_steps.refuse_busy()
            change = removal_of(project, drives)
        except UserError as error:
            self.refused.emit(error)
            return False
        self.points_leaving.emit()
        if not apply(Text("Remove {names}", "{names} を除く").filled(names=names), change):
            return False
        self.reported.emit(removed_words(names))
        return True

    def follow(self, project: Project, ids: Iterable[str]) -> None:
        """Let all views show what drives there are now.

        Parameters
        ----------
        ids : iterable of str
            Drives that went, came back or are others.
        """
        others = set(ids)
        for id_ in others:
            self._tiles.drop(id_)
        if others:
            self._shared.selection.clear()
            self._shared.cursor.clear()
        self._show(project)
        self._shared.map_changes.drives_changed.emit()

    def follow_step(self, project: Project, change: Change) -> None:
        """Follow a step by which drives came, went or became others."""
        others = list(change.drive_ids)
        if change.files is not None:
            files = change.files
            others += [id_ for id_ in files.drives if READ_AT_OPENING & set(files.names_of(id_))]
        if others:
            self.follow(project, others)
            self.taken.emit(())

    def on_step_coming(self, change: Change) -> None:
        """A step is undone or done again in a moment."""
        if change.drive_ids:
            self.points_leaving.emit()

    def _show(self, project: Project) -> None:
        settings = self._shared.view_settings
        shown = next((one for one in project.drives if one.id == settings.drive_id), None)
        if shown is not None:
            if settings.image_kind not in shown.image_kinds:
                settings.show_image(shown.id, best_kind(shown, settings.image_kind))
        elif project.drives:
            self.first_look.show(project.drives)
        elif settings.drive_id:
            settings.show_image("", settings.image_kind)

    def _take(self, project: Project, brought: Additions) -> None:
        if brought.completed and self._has_to_wait(project, brought):
            return
        has_moved = any(one.places_before is not None for one in brought.completed)
        has_moved = has_moved or bool(brought.replaced and brought.folders)
        ids = {feature.id for feature in project.features.all()} if has_moved else set()
        if has_moved:
            self.points_leaving.emit()
        drives = take_over(project, brought)
        # Undo is of this step now: what was being taken back is another one.
        self._label_steps.note(Change())
        new = drives[: len(brought.folders)]
        others = drives[len(brought.folders) :]
        if drives:
            self.follow(project, [*(drive.id for drive in others), *brought.replaced])
        if has_moved:
            self._shared.map_changes.features_changed.emit(tuple(ids))
        self.taken.emit(drives)
        self.reported.emit(imported_words(drives, brought, project.crs))
        lacking = tuple(drive.id for drive in new if lacks_trajectory(drive))
        if brought.beside and lacking:
            self.beside_found.emit(ImportRequest((), brought.beside), lacking)

    def _has_to_wait(self, project: Project, brought: Additions) -> bool:
        """Labels that are being stored, or were set meanwhile, come first."""
        ids = {drive.id for drive in project.drives}
        is_known = all(one.id in ids for one in brought.completed)
        stale = is_known and any(not one.fits(project.drive(one.id)) for one in brought.completed)
        if not (self._label_steps.is_busy or stale):
            return False
        drives = {drive.id: drive for drive in project.drives}

        def carry(monitor: Monitor) -> Additions:
            completed = tuple(
                carry_results_again(one, drives[one.id], monitor) if one.id in drives else one
                for one in brought.completed
            )
            return replace(brought, completed=completed)

        def take(again: Additions) -> None:
            self._take(project, again)

        self._job_results.start(project, _CARRYING, carry, take, lane=JobLane.STEPS)
        return True
